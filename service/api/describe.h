// The answers that describe this server: its techniques, scenarios, schema and state.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace shadowbench::service {

// The JSON of /v1/scenarios: every *.json at any depth of these folders that is a scenario, sorted by name. Folders
// named "data" are skipped. Of scenarios with the same name the one in the first folder counts.
std::string read_scenarios(const std::vector<std::filesystem::path>& folders);

}  // namespace shadowbench::service
