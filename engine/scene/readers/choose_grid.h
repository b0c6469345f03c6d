// Which of a .vdb file's grids is meant.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "scene/readers/files.h"

namespace shadowbench::scene {

// Between a name that occurs more than once, or none, and its number in a unique name.
inline constexpr char vdb_suffix = '\x1e';
inline constexpr const char* usual_grid = "density";
inline constexpr std::string_view vdb_float_tree = "Tree_float_5_4_3";

struct VdbGridName {
    std::string name, unique_name;  // unique_name: name, or name, vdb_suffix and a number
    std::string type;               // without "_HalfFloat"
};

// As people read it: "density", "density[1]" where several have that name, "(no name)".
std::string shown(const VdbGridName& grid);

// The index of the grid that is meant: see GridChoice. Throws Error{bad_input} with the file as place, and the names of
// all grids, for a choice that fits none, or several.
std::size_t choose_grid(const std::filesystem::path& file, std::span<const VdbGridName> grids,
                        const GridChoice& choice);

// What File::readGrid (OpenVDB 10) must be asked for to find this grid and no other; nothing
// where no name is sure to.
std::optional<std::string> library_name(std::span<const VdbGridName> grids, std::size_t grid);

// The grid in which File::readGrid looks for the tree that others share under this unique name; grids.size(): none, or
// one that has another name.
std::size_t library_parent(std::span<const VdbGridName> grids, const std::string& unique_name);

}  // namespace shadowbench::scene
