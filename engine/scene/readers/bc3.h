// Blocks of 4 x 4 texels in the format BC3, which DDS files call DXT5 (Direct3D 11 functional specification, 19.5.10):
// 8 bytes of alpha, 8 bytes of colour.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace shadowbench::scene {

inline constexpr int bc3_side = 4;
inline constexpr std::size_t bc3_bytes = 16;
using Bc3Block = std::span<const std::uint8_t, bc3_bytes>;

// Alpha, in [0, 1], of the block's texels, x fastest. Interpolated values are not rounded to 8 bits.
std::array<float, 16> bc3_alpha(Bc3Block block);

// Red (0), green (1) or blue (2), likewise.
std::array<float, 16> bc3_colour(Bc3Block block, int channel);

// The alpha of a block in the format BC2, which DDS files call DXT3: 4 bits a texel. Its colour is as in BC3.
std::array<float, 16> bc2_alpha(Bc3Block block);

}  // namespace shadowbench::scene
