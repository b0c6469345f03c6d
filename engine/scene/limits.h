// The largest inputs that are accepted. Anything above is refused with a message that states the limit, before memory
// is taken for it.
#pragma once

#include <cstdint>

namespace shadowbench::scene {

inline constexpr std::uint64_t max_light_rays = std::uint64_t{1} << 32;      // width * height * samples_per_pixel
inline constexpr std::uint64_t max_camera_pixels = std::uint64_t{1} << 26;   // of a camera's image
inline constexpr std::uint64_t max_reference_rays = std::uint64_t{1} << 32;  // queries * samples_per_pixel
inline constexpr std::uint64_t max_hair_points = 200'000'000;
inline constexpr std::uint64_t max_mesh_elements = 200'000'000;  // vertices, and triangles
inline constexpr std::uint64_t max_voxels = 1'000'000'000;
inline constexpr std::uint64_t max_texels = std::uint64_t{1} << 30;
inline constexpr std::uint64_t max_deep_samples = std::uint64_t{1} << 31;
inline constexpr double max_march_steps = 65536.0;  // across a volume's diagonal
inline constexpr int max_image_side = 65536;

// Coordinates are stored as float; their squares must not overflow.
inline constexpr double max_coordinate = 1e18;

}  // namespace shadowbench::scene
