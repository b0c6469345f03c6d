// The mesh formats behind read_mesh.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "scene/readers/files.h"
#include "scene/scene.h"

namespace shadowbench::scene {

MeshFile read_obj(const std::filesystem::path& file);
MeshFile read_ply(const std::filesystem::path& file);

// Names of many kinds come together as "other things".
void pass_over(MeshFile& file, std::string_view what, std::uint64_t count = 1);

inline constexpr std::string_view fewer_corners = "faces of fewer than 3 corners";

// A letter, and up to 31 letters, digits and underscores: what may be shown.
bool is_word(std::string_view text);

// Adds a polygon as triangles; `uv` is one a corner, or empty. One of fewer than 3 corners or without area is passed
// over. Returns what is wrong with it, which is empty when nothing is: the face "crosses itself ...".
std::string add_polygon(MeshFile& file, const std::vector<int>& corners, const std::vector<Vec2f>& uv);

}  // namespace shadowbench::scene
