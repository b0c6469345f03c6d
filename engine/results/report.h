// A result as JSON, CSV and a table.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "results/result.h"

namespace shadowbench::results {

// Increased when a key of result.json changes its name or meaning.
inline constexpr int result_schema_version = 1;

// One line for each note of the file readers, indented: at most 5, then how many more there are and where to see them.
std::string notes_text(const std::vector<std::string>& notes, const std::string& indent);

// All measurements, as result.json. Values that depend on the clock are in objects under the key "times"; without
// these, two results of one scenario on one machine are equal. Numbers that do not exist or are not finite are null.
// "notes" is there only if there are some.
nlohmann::ordered_json to_json(const Result& result);

// Adds the load and the job of Slurm, as far as they are known, to an object of times.
void add_state_to(nlohmann::ordered_json& out, const RunTimes& times);

// The inverse of to_json(), and the only place that reads measurements from a result.json: to_json(from_json(j)) == j
// for every j that to_json() wrote. Also reads results that earlier programs wrote under this schema version, and
// portable baselines (portable.h): what they lack keeps its default. Throws Error{bad_input} for a value that is
// missing, of another type or out of range; its place is `origin`, then the JSON pointer of the value.
Result from_json(const nlohmann::json& json, const std::string& origin);

// Removes every "times" object, at any depth.
void strip_times(nlohmann::ordered_json& result);

// A header line, then one row per cell, separated by commas and quoted as in RFC 4180. A number that does not exist is
// an empty field.
std::string to_csv(const Result& result);

// A table for people: the notes of the file readers, then for each variant and light, what was captured and how
// accurate the truth is, then one line per cell.
std::string to_table(const Result& result);

}  // namespace shadowbench::results
