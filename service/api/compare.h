// Compares two results as `shadowbench compare` does.
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace shadowbench::service {

// The JSON of `shadowbench compare --json` for two results that `run` wrote. Throws Error{bad_input}, place "/baseline"
// or
// "/current", for JSON that is not a result.
nlohmann::ordered_json compare_results(const nlohmann::json& baseline, const nlohmann::json& current);

}  // namespace shadowbench::service
