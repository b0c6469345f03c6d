// The data files of a scenario: a line each, for results and for people who check a scenario, and their size.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "scene/scenario.h"

namespace shadowbench::scene {

// For each file that a scenario names: its place, its name, and the counts, range of values and box of what it gave:
// "/scene/objects/0/file: smoke.vdb: 111 x 222 x 112 voxels, density 0 to 5.7; box [0, 0, 0] to [1, 2, 1]". `scene` is
// that of load_scenario(document). Printable.
std::vector<std::string> file_lines(const nlohmann::json& document, const Scene& scene);

// The bytes of all files that a valid scenario names, each as often as it is named. Files that have gone count as
// empty.
std::uint64_t file_bytes(const nlohmann::json& document, const SearchPath& path);

}  // namespace shadowbench::scene
