#pragma once

#include <nlohmann/json_fwd.hpp>

namespace shadowbench::service {

// Two results as `run` wrote them -> the JSON of `shadowbench compare --json`. Throws Error{bad_input}.
nlohmann::ordered_json compare_results(const nlohmann::json& baseline, const nlohmann::json& current);

}  // namespace shadowbench::service
