// Finds scenarios and their data.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scene/scenario.h"

namespace shadowbench::service {

// ./scenarios, then the folders of $SHADOWBENCH_SCENARIOS (separated by colons), then the scenarios installed with the
// program: ../share/shadowbench/scenarios from the folder of its executable, where that is a folder.
std::vector<std::filesystem::path> scenario_folders();

// `name` is the path of a file, or what scene::find_scenario() finds in the scenario folders: every name that `list`
// prints. Throws Error{no_such_file}.
std::filesystem::path find_scenario(const std::string& name);

// The scenarios that a name means: one, or every *.json directly in a folder, sorted by name. A folder is looked for
// like a file, and after files. Throws Error{no_such_file}, also for a folder without scenarios.
struct FoundScenarios {
    std::vector<std::filesystem::path> files;
    bool folder = false;
};
FoundScenarios find_scenarios(const std::string& name);

// The folders in which a scenario's data is looked for: those given, $SHADOWBENCH_DATA (separated by colons), the
// scenario's own folder and its data/, scenarios/data. Throws Error{no_such_file} when a given folder does not exist.
scene::SearchPath data_path(const std::vector<std::string>& given, const std::filesystem::path& scenario);

}  // namespace shadowbench::service
