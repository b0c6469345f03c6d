// An exploration as JSON, so that another error can be asked of it later without measuring.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "recommend/exploration.h"

namespace shadowbench::recommend {

nlohmann::ordered_json to_json(const Exploration& exploration);

// Throws Error{bad_input}, place: `where` and the JSON pointer from there, for what to_json() cannot have written.
Exploration exploration_from_json(const nlohmann::json& recommendation, const std::string& where);

// The setting of a point in the words of a scenario: {"rays": {...}, "techniques": [{...}]}. A family that needs no
// light rays sets none.
nlohmann::ordered_json scenario_part(const Family& family, const Point& point);

}  // namespace shadowbench::recommend
