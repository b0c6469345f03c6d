// Many results as series: one for each measure of each cell, ordered by the start of the runs, and their drifts.
#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json_fwd.hpp>

namespace shadowbench::compare {

struct HistoryOptions {
    std::size_t last = 10;  // number of latest results in which to look for a drift
    double effect = 0.05;   // smallest drift of a time that counts
};

// Reads a file, or all result and kernel files below a folder; each file is a run.
//   {"cells": [{"title", "measures": [{"name", "unit", "points": [{"run", "commit", "value", "low", "high"}],
//                                      "drift": null | {"from", "to", "ratio", "since"}}]}],
//    "runs": [{"started", "commit", "file"}]}
// "run" is the time at which the run started. Times are medians over the floor, or plain ones if there is no floor;
// "low" and "high" are their 95 % bootstrap interval, null for other measures. Values that do not exist are null. A
// drift is a line that the last results follow (metrics/drift.h): its values at both ends, and `ratio`, to / from (null
// if from is 0). Only results that can be compared with the latest count: those of its scenario, technique version and,
// for times, machine. Throws as read() does.
nlohmann::ordered_json history_json(const std::filesystem::path& path, const HistoryOptions& options);

// One line for each drift, then the numbers of results, cells and measures.
std::string history_text(const nlohmann::ordered_json& history);

}  // namespace shadowbench::compare
