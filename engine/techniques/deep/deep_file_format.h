// What writing and reading the format of deep_file.h share.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "techniques/deep/deep_file.h"

namespace shadowbench::techniques::deep_format {

static_assert(std::endian::native == std::endian::little, "numbers are read and written in the file's byte order");

constexpr std::array<unsigned char, 8> magic{0x53, 0x42, 0x44, 0x53, 0x4d, 0x0d, 0x0a, 0x1a};
constexpr std::uint32_t byte_order = 0x01020304;
constexpr std::uint32_t unit_version = 1, wide_version = 2;  // of files whose values are in these ranges
constexpr float unit_least = 0.0f, unit_most = 1.0f, wide_least = -2.0f, wide_most = 3.0f;
constexpr std::uint32_t max_side = 1u << 20;  // pixels
constexpr std::uint32_t max_text = 1u << 16;  // bytes

struct Header {
    std::array<unsigned char, 8> magic;
    std::uint32_t byte_order, version;
    std::uint64_t file_bytes;
    std::uint32_t width, height, channels, levels, tile_size, text_bytes;
    float tolerance, z_min, z_max;
    std::uint32_t checksum;
};
static_assert(sizeof(Header) == 64);

// CRC-32; pass a result as `before` to continue with the bytes that follow.
std::uint32_t checksum(const void* bytes, std::size_t count, std::uint32_t before = 0);

inline std::uint32_t header_checksum(const Header& header) {
    return checksum(&header, sizeof header - sizeof header.checksum);
}

// The number of levels of a map of this size, down to one pixel.
constexpr std::uint32_t max_levels(std::uint32_t width, std::uint32_t height) {
    std::uint32_t levels = 1;
    for (; width > 1 || height > 1; ++levels) {
        width = (width + 1) / 2;
        height = (height + 1) / 2;
    }
    return levels;
}

std::vector<DeepTiling> tilings(int width, int height, int levels, int tile_size);

// The number of words of a tile before its floats.
constexpr std::size_t colour_words(std::size_t pixels, int channels) {
    return channels == 3 ? (pixels + 31) / 32 : 0;
}
constexpr std::size_t table_words(std::size_t pixels, int channels) {
    return pixels + 1 + colour_words(pixels, channels);
}

}  // namespace shadowbench::techniques::deep_format
