// Readers of point clouds; errors as in files.h.
#pragma once

#include <filesystem>
#include <vector>

#include "scene/scene.h"

namespace shadowbench::scene {

struct PointFile {
    Particles points;
    bool has_radii = false;  // in the file; without them, and without a radius given, all radii are 0
    std::vector<PassedOver> passed_over;
};

// The vertices of a PLY file, with their own "radius", "pscale" or half "width", and their "density", which is 1
// without it. `radius` > 0 overrides the radii of the file. Points whose radius in the file is 0 are passed over.
PointFile read_points(const std::filesystem::path& file, float radius);

}  // namespace shadowbench::scene
