// The answers that describe this server: its techniques, scenarios, schema and state.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace shadowbench::service {

// The JSON of /v1/scenarios: what scene::list_scenarios() lists of these folders under the name that the scenario gives
// itself, sorted by name.
std::string read_scenarios(const std::vector<std::filesystem::path>& folders);

}  // namespace shadowbench::service
