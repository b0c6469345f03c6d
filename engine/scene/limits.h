// The largest inputs that are accepted. Larger ones are refused with a message that states the limit, before memory is
// allocated for them.
#pragma once

#include <cstdint>

#include "base/limits.h"

namespace shadowbench::scene {

inline constexpr std::uint64_t max_light_rays = std::uint64_t{1} << 32;     // width * height * samples_per_pixel
inline constexpr std::uint64_t max_camera_pixels = std::uint64_t{1} << 26;  // pixels of a camera's image
inline constexpr std::uint64_t max_camera_points = std::uint64_t{1}
                                                   << 28;  // pixels of a camera's image * (media_lookups + 1)
inline constexpr std::uint64_t max_reference_rays = std::uint64_t{1} << 32;  // queries * samples_per_pixel
inline constexpr std::uint64_t max_hair_points = 200'000'000;
inline constexpr int max_hairs_on_a_ray = 1000;                  // through a ball of hair
inline constexpr std::uint64_t max_mesh_elements = 200'000'000;  // vertices; triangles have the same limit
inline constexpr std::uint64_t max_voxels = 1'000'000'000;
inline constexpr std::uint64_t max_texels = std::uint64_t{1} << 30;
inline constexpr std::uint64_t max_deep_samples = std::uint64_t{1} << 31;
inline constexpr double max_march_steps = 1e7;       // across a volume's diagonal
inline constexpr double max_all_march_steps = 1e13;  // or cells, of all light rays, or of the reference: days of work
inline constexpr double max_scene_bytes = 8589934592.0;  // 8 GiB for all objects together
inline constexpr int max_image_side = 65536;

using base::max_coordinate;
using base::min_length;

// No image format in use packs more values into a byte of its file: one bit a value, deflated 1032 times.
inline constexpr std::uint64_t max_values_per_byte = 16384;

}  // namespace shadowbench::scene
