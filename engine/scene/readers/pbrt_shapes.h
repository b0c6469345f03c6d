// The shapes of a pbrt scene, at the place that a matrix gives them. A fault throws Error{bad_input} at the statement.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "scene/readers/pbrt_statement.h"
#include "scene/readers/pbrt_transforms.h"
#include "scene/readers/strands.h"
#include "scene/scene.h"

namespace shadowbench::scene {

// Of a trianglemesh, not yet placed.
Mesh pbrt_triangles(const PbrtStatement& shape);

void add_placed(const Mesh& mesh, const Matrix& place, const PbrtStatement& statement, Mesh& to);
// Widths grow by mean_scale().
void add_placed(const Hair& hair, const Matrix& place, const PbrtStatement& statement, Strands& to);

// A curve of degree 2 or 3, a Bezier curve or a B-spline. It goes on with the last strand if it begins where that
// ended. More than `most_points` of all strands are a fault.
void add_pbrt_curve(const PbrtStatement& shape, const Matrix& place, std::uint64_t most_points, Strands& to);

inline constexpr std::size_t box_triangles = 12;

// The box whose faces that many triangles cover once, along the axes.
std::optional<Box3d> box_of(const Mesh& mesh);

}  // namespace shadowbench::scene
