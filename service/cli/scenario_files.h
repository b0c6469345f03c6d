// Where scenarios and their data are looked for.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scene/scenario.h"

namespace shadowbench::service {

// ./scenarios, then the folders of $SHADOWBENCH_SCENARIOS (separated by colons), then the scenarios installed with the
// program: ../share/shadowbench/scenarios from the folder of its executable, where that is a folder.
std::vector<std::filesystem::path> scenario_folders();

// The folder papers/ of the first scenario folder that has one. Throws Error{no_such_file}.
std::filesystem::path paper_scenarios();

// A path to a file, or the name of one in the scenario folders, with or without ".json". Throws Error{no_such_file}.
std::filesystem::path find_scenario(const std::string& name);

// What a name stands for: one scenario, or the *.json directly in a folder, by name. Folders are looked for like files,
// and after them. Throws Error{no_such_file}, also for a folder without scenarios.
struct FoundScenarios {
    std::vector<std::filesystem::path> files;
    bool folder = false;
};
FoundScenarios find_scenarios(const std::string& name);

// The folders given, $SHADOWBENCH_DATA (separated by colons), the scenario's own folder and its data/, scenarios/data.
// Throws Error{no_such_file} when one of those given is not there.
scene::SearchPath data_path(const std::vector<std::string>& given, const std::filesystem::path& scenario);

}  // namespace shadowbench::service
