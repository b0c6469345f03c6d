// The media of a pbrt scene.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "scene/readers/pbrt_statement.h"
#include "scene/readers/pbrt_transforms.h"
#include "scene/scene.h"

namespace shadowbench::scene {

struct PbrtMediumSource {
    std::string name;
    std::string lost;                // not empty: why it is passed over, as "media of the type nanovdb"
    Vec3d extinction{0, 0, 0};       // per unit of length, and of density for a grid: of red, green and blue
    std::optional<GridVolume> grid;  // its densities times the mean extinction; without it: homogeneous
    bool used = false;

    double mean() const { return (extinction.x + extinction.y + extinction.z) / 3.0; }
    bool is_coloured() const { return extinction.x != extinction.y || extinction.y != extinction.z; }
};

// Of a MakeNamedMedium at this place. A grid of more than `most_voxels` is a fault. Faults throw Error{bad_input} at
// the statement.
PbrtMediumSource read_pbrt_medium_source(const PbrtStatement& statement, const Matrix& place,
                                         std::uint64_t most_voxels);

}  // namespace shadowbench::scene
