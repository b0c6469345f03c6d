// Finds scenarios by name. What lists names and what looks them up agree: every name that is listed finds its scenario.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace shadowbench::scene {

struct NamedScenario {
    std::string name;     // finds `file`: see find_scenario()
    std::string purpose;  // as the scenario states it
    std::filesystem::path file;
    std::string fault;  // why the file cannot be read; empty if it can
};

// The scenarios in these folders, by folder and then by path: every *.json at any depth, except in folders named
// "data". Each has the name that it gives itself, if this name finds its file, or else its path in its folder without
// ".json". A file that neither finds, since an earlier folder has both, is left out. Folders that do not exist are
// empty.
std::vector<NamedScenario> list_scenarios(std::span<const std::filesystem::path> folders);

// The file that a name means, or an empty path: a path in one of the folders, with or without ".json", or the name that
// a scenario gives itself. The first folder that has either counts. In a folder, a path counts before a name, and of
// several scenarios of one name the first by path.
std::filesystem::path find_scenario(std::span<const std::filesystem::path> folders, const std::string& name);

}  // namespace shadowbench::scene
