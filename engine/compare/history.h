// Many results -> one series a measure of each cell, in the order they were started, and what drifts.
#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json_fwd.hpp>

namespace shadowbench::compare {

struct HistoryOptions {
    std::size_t last = 10;  // results that a drift is looked for in
    double effect = 0.05;   // of times: less is no drift
};

// Of a file, or all result and kernel files below a folder; each file is a run.
//   {"cells": [{"title", "measures": [{"name", "unit", "points": [{"run", "commit", "value", "low", "high"}],
//                                      "drift": null | {"from", "to", "ratio", "since"}}]}],
//    "runs": [{"started", "commit", "file"}]}
// "run" is when it was started. Times are medians over the floor where there is one, with low and high their 95 %
// bootstrap interval; those of other measures are null, as are values that do not exist. A drift is a line that the
// last results follow (metrics/drift.h), values at both ends of it, `ratio` to / from (null where from is 0). Only
// results that compare with the latest count: of its scenario, technique version and, for times, machine. Throws as
// read() does.
nlohmann::ordered_json history_json(const std::filesystem::path& path, const HistoryOptions& options);

// What drifts, a line each, and how much was looked at.
std::string history_text(const nlohmann::ordered_json& history);

}  // namespace shadowbench::compare
