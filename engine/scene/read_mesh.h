// The mesh formats behind read_mesh.
#pragma once

#include <filesystem>
#include <vector>

#include "scene/scene.h"

namespace shadowbench::scene {

Mesh read_obj(const std::filesystem::path& file);
Mesh read_ply(const std::filesystem::path& file);

// Adds a polygon of at least 3 corners as the fan around its first one; `uv` is one a corner, or empty.
void add_fan(Mesh& mesh, const std::vector<int>& corners, const std::vector<Vec2f>& uv);

}  // namespace shadowbench::scene
