// Chooses one of the grids of a .vdb file.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "scene/read_notes.h"
#include "scene/readers/files.h"

namespace shadowbench::scene {

// In a unique name, separates a name that occurs more than once, or is empty, from its number.
inline constexpr char vdb_suffix = '\x1e';
inline constexpr const char* usual_grid = "density";
inline constexpr std::string_view vdb_float_tree = "Tree_float_5_4_3";

struct VdbGridName {
    std::string name, unique_name;  // unique_name: name, or name, vdb_suffix and a number
    std::string type;               // without "_HalfFloat"
};

// The name for people: "density", "density[1]" if several grids have that name, "(no name)".
std::string shown(const VdbGridName& grid);

// The index of the grid that the choice names: see GridChoice. Throws Error{bad_input}, place the file, with the names
// of all grids if the choice fits none or several.
std::size_t choose_grid(const std::filesystem::path& file, std::span<const VdbGridName> grids,
                        const GridChoice& choice);

// Notes which grid is read, if others are passed over (as shown to people) or it has not the usual name; and a
// background that reaches beyond the box of the active voxels, where no density is taken.
void note_grid(const VdbGridName& grid, std::span<const std::string> passed_over, float background, ReadNotes& notes);

}  // namespace shadowbench::scene
