// A result as JSON, CSV and a table.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "results/result.h"

namespace shadowbench::results {

// Grows when a name or meaning in result.json changes.
inline constexpr int result_schema_version = 1;

// Everything measured. All that depends on the clock stands in objects under the key "times"; without them, results of
// one scenario on one machine are equal. Numbers that do not exist (or are not finite) are null.
nlohmann::ordered_json to_json(const Result& result);

// The way back, and the only place that reads measures from a result.json: to_json(from_json(j)) == j for what
// to_json() wrote. Also reads what earlier programs wrote under this schema version, and baselines for any machine
// (portable.h): what they lack keeps its default. Throws Error{bad_input}, place: `origin`, then the JSON pointer of
// what is missing, of another type or out of range.
Result from_json(const nlohmann::json& json, const std::string& origin);

// Removes every "times" object, at any depth.
void strip_times(nlohmann::ordered_json& result);

// One row a cell, with a header line; separated by commas, quoted as RFC 4180 says. A number that does not exist is an
// empty field.
std::string to_csv(const Result& result);

// For people: for each variant and light what was captured and how good the truth is, then a line a cell.
std::string to_table(const Result& result);

}  // namespace shadowbench::results
