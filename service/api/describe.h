// What there is: techniques, scenarios.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace shadowbench::service {

// JSON of /v1/scenarios: every *.json in these folders that reads as a scenario, by name. Folders named data are left
// out.
std::string read_scenarios(const std::vector<std::filesystem::path>& folders);

}  // namespace shadowbench::service
