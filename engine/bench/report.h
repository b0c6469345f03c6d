// A result as JSON, CSV and a table.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "bench/result.h"

namespace shadowbench::bench {

// Grows when a name or meaning in result.json changes.
inline constexpr int result_schema_version = 1;

// Everything measured. All that depends on the clock stands in objects under the key "times"; without them, results of
// one scenario on one machine are equal. Numbers that do not exist (or are not finite) are null.
nlohmann::ordered_json to_json(const Result& result);

// The way back: what to_json() wrote, as a result that can be shown or judged again. The layout's tiles, which it does
// not hold, stay as a MapLayout has them; promises come from the registry, of a technique that is not there the
// defaults. Throws Error{bad_input}, place: JSON pointer of what is missing or of another type.
Result from_json(const nlohmann::ordered_json& json);

// Removes every "times" object, at any depth.
void strip_times(nlohmann::ordered_json& result);

// One row a cell, with a header line; separated by commas, quoted as RFC 4180 says. A number that does not exist is an
// empty field.
std::string to_csv(const Result& result);

// For people: for each variant and light what was captured and how good the truth is, then a line a cell.
std::string to_table(const Result& result);

}  // namespace shadowbench::bench
