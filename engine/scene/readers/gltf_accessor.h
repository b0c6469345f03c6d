// Reads the arrays of a glTF file. Nothing is allocated before the file is known to be long enough for it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/vec.h"
#include "scene/readers/gltf_model.h"

namespace shadowbench::scene {

// Elements without bytes, which are 0, at most.
inline constexpr std::uint64_t most_gltf_zeros = std::uint64_t{1} << 20;

// Throws Error{bad_input} if the file is too short for the elements, or too few of them have bytes.
void check_gltf_accessor(const GltfModel& model, std::size_t accessor);

// Three components, each finite and at most max_coordinate.
std::vector<base::Vec3f> read_gltf_points(const GltfModel& model, std::size_t accessor);
// Two components, each finite.
std::vector<base::Vec2f> read_gltf_uvs(const GltfModel& model, std::size_t accessor);
// One component, a whole number that is not negative.
std::vector<std::uint32_t> read_gltf_indices(const GltfModel& model, std::size_t accessor);

// All bytes of a view.
std::vector<char> read_gltf_view(const GltfModel& model, std::size_t view);

}  // namespace shadowbench::scene
