// Reads the part of a pbrt-v4 scene that this project has shapes for; errors as in files.h. The rest is passed over,
// and counted where it could cast a shadow.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scene/limits.h"
#include "scene/readers/files.h"
#include "scene/scene.h"

namespace shadowbench::scene {

// A file of a few bytes may include others again and again, and may hold many instances of an object.
struct PbrtLimits {
    std::uint64_t elements = max_mesh_elements;    // of triangles, vertices and points of hair, each
    std::uint64_t voxels = max_voxels;             // of all media together
    std::uint64_t bytes = std::uint64_t{1} << 32;  // of all files that are read, unpacked
    std::uint64_t files = 65536;
    std::uint64_t repeats = std::uint64_t{1} << 29;  // bytes of files that were read before; their text is read again
};

struct PbrtMedium {
    std::string name;
    GridVolume volume;  // density: extinction per unit of length, of red, green and blue their mean
};

struct PbrtFile {
    // trianglemesh and plymesh, also of instances. Without texture coordinates.
    Mesh mesh;
    // curve, of all types and bases: ribbons that face the ray. Curves in a row that join are one strand.
    Hair hair;
    // Spheres whose inside is a homogeneous medium; density as that of media.
    Particles particles;
    // Grids (uniformgrid, and heterogeneous of version 3) that some shape has inside, and boxes whose inside is a
    // homogeneous medium.
    std::vector<PbrtMedium> media;
    std::vector<PassedOver> passed_over;
    std::vector<std::string> facts;  // in lines for people
};

// Other files that the scene includes, which gzip may have packed, must lie in its folder or below.
PbrtFile read_pbrt(const std::filesystem::path& file, const PbrtLimits& limits = {});

// A medium by its name, or by its number from 0 on; without either, the only one.
GridVolume read_pbrt_medium(const std::filesystem::path& file, const GridChoice& choice);

}  // namespace shadowbench::scene
