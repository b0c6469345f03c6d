// Readers of scene files. Each throws Error: no_such_file, io, or bad_input with "file:offset" of the fault; a value
// that is not finite, a count that the file is too short for and a box or index out of range are bad input.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scene/limits.h"
#include "scene/scene.h"

namespace shadowbench::scene {

// TressFX 3 and 4 (.tfx). `radius` is the half-width of every point; 0 keeps 0.
Hair read_tressfx(const std::filesystem::path& file, float radius);

// Cem Yuksel's .hair format (cemyuksel.com/research/hairmodels). Thickness in the file is taken as full width;
// `radius` > 0 overrides it.
Hair read_hair(const std::filesystem::path& file, float radius);

struct MeshFile {
    Mesh mesh;
    std::vector<PassedOver> passed_over;
};

// By extension: .obj or .ply (ASCII and binary, faces and triangle strips). Polygons are split into triangles that
// cover them once (triangulate.h); one that crosses itself is bad input. A file may hold vertices alone.
MeshFile read_mesh(const std::filesystem::path& file);

// The alpha channel of an image (its luminance where it has none): PNG, JPEG, TIFF, OpenEXR, DDS or TGA.
AlphaTexture read_alpha(const std::filesystem::path& file);

// Raw values, x fastest; type "uint8" (scaled to [0, 1]) or "float32" (little-endian). The file's size must match.
// The caller sets the box and step.
GridVolume read_raw_volume(const std::filesystem::path& file, Vec3i size, const std::string& type);

// An OpenVDB float fog volume, by grid name, with its own world box. Axis-aligned transforms only. A small file can
// hold a large box of equal voxels: one of more than `most_voxels` is bad input.
GridVolume read_vdb(const std::filesystem::path& file, const std::string& grid, std::uint64_t most_voxels = max_voxels);

// A deep EXR: channels A, Z and, where present, ZBack. Files with mip levels are refused before their pixels are read.
DeepImage read_deep_image(const std::filesystem::path& file);

}  // namespace shadowbench::scene
