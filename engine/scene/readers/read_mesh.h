// Readers of the mesh formats, for read_mesh.
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

// Text and binary. Corners at equal positions become one vertex; the vertices come in the order of their positions.
MeshFile read_stl(const std::filesystem::path& file);

// glTF 2.0, text and binary (read_gltf.cpp). The mesh has a texture if the alpha of any material is below 1.
MeshFile read_gltf(const std::filesystem::path& file);

// The triangles of a pbrt scene (pbrt_files.h).
MeshFile read_pbrt_mesh(const std::filesystem::path& file);

// If there are many kinds, the rest are counted together as "other things".
void pass_over(MeshFile& file, std::string_view what, std::uint64_t count = 1);

inline constexpr std::string_view fewer_corners = "faces of fewer than 3 corners";
inline constexpr std::string_view without_area = "faces without area";

// Whether the text is a letter followed by up to 31 letters, digits and underscores, so that it may be shown.
bool is_word(std::string_view text);

// Adds a polygon as triangles; `uv` has one entry for each corner or is empty. Passes over a polygon of fewer than 3
// corners or without area. Returns what is wrong with it: empty, or a text that follows "the face", such as "crosses
// itself ...".
std::string add_polygon(MeshFile& file, const std::vector<int>& corners, const std::vector<Vec2f>& uv);

}  // namespace shadowbench::scene
