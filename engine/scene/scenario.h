// Scenario JSON -> Scenario. scenario.schema.json beside this file (draft-07) defines and documents the format.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "base/error.h"
#include "scene/parse_json.h"
#include "scene/scene.h"

namespace shadowbench::scene {

// The folders in which relative file names of a scenario are looked up, in order.
struct SearchPath {
    std::vector<std::filesystem::path> folders;
    // For scenarios from strangers, which may name only files in these folders. Absolute names, names with "..", and
    // links that lead out of their folder are refused, and no message shows the folders.
    bool confined = false;

    SearchPath() = default;
    SearchPath(std::initializer_list<std::filesystem::path> list) : folders(list) {}
    static SearchPath confined_to(std::vector<std::filesystem::path> folders);
};

// Finds `name` in the path. Throws Error{no_such_file} that lists the folders it looked in; for a confined path,
// Error{bad_input} if the name is refused.
std::filesystem::path find_file(const SearchPath& path, const std::string& name, const std::string& where);

// The schema of the source tree, without the parameters of techniques (bench adds those from the registry).
const nlohmann::json& scenario_schema();

// Up to `most` faults that a draft-07 schema finds in `document`: each an Error{bad_input} with the JSON pointer of its
// place; "/" if the document is not even an object.
std::vector<base::Error> schema_faults(const nlohmann::json& document, const nlohmann::json& schema, std::size_t most);

// Throws the first of these faults.
void check_schema(const nlohmann::json& document, const nlohmann::json& schema);

// Called before each object of a scene, or its deep image, is loaded, and after the last: how many are, and of how
// many. An exception from it ends the loading.
using LoadWatch = std::function<void(std::size_t done, std::size_t total)>;

// Checks the document against the schema, reads its files, makes its procedural objects and returns the values. Throws
// Error: bad_input (pointer), no_such_file, io. An empty scene, or one whose files hold nothing, is bad input.
Scenario load_scenario(const nlohmann::json& document, const SearchPath& path, const LoadWatch& watch = {});

// The names of the lights with maps that load_scenario makes from a valid document.
std::vector<std::string> light_names(const nlohmann::json& document);

// The width of the lookups of the light with this name in a valid document: its softness, or that of the receivers.
FilterWidth lookup_width(const nlohmann::json& document, const std::string& light);

// Refuses light rays that would march through the scene's volumes for days. load_scenario calls it; a caller that
// changes the settings of a loaded scene must call it again. Throws Error{bad_input}.
void check_marching(const Scenario& scenario);

}  // namespace shadowbench::scene
