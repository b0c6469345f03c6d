#include "scene/readers/bc3.h"

namespace shadowbench::scene {
namespace {

std::uint64_t little_endian(Bc3Block block, std::size_t first, std::size_t bytes) {
    std::uint64_t value = 0;
    for (std::size_t i = bytes; i-- > 0;) value = (value << 8) | block[first + i];
    return value;
}

// The values that the texels' indices, of `bits` bits each, choose.
template <std::size_t Count>
std::array<float, 16> choose(const std::array<float, Count>& values, std::uint64_t indices, int bits) {
    std::array<float, 16> texels;
    for (float& texel : texels) {
        texel = values[static_cast<std::size_t>(indices & ((1u << bits) - 1u))];
        indices >>= bits;
    }
    return texels;
}

float mean_of(float a, float b, int part, int parts) {
    const auto share = static_cast<float>(part) / static_cast<float>(parts);
    return a * (1.0f - share) + b * share;
}

}  // namespace

std::array<float, 16> bc3_alpha(Bc3Block block) {
    const float first = static_cast<float>(block[0]) / 255.0f, second = static_cast<float>(block[1]) / 255.0f;
    std::array<float, 8> values{first, second};
    const int between = block[0] > block[1] ? 6 : 4;
    for (int i = 1; i <= between; ++i) values[static_cast<std::size_t>(1 + i)] = mean_of(first, second, i, between + 1);
    if (between == 4) values[7] = 1.0f;  // and values[6] is 0
    return choose(values, little_endian(block, 2, 6), 3);
}

std::array<float, 16> bc3_colour(Bc3Block block, int channel) {
    constexpr unsigned shift[] = {11, 5, 0}, most[] = {31, 63, 31};
    const auto end = [&](std::size_t byte) {
        const auto bits = static_cast<unsigned>(little_endian(block, byte, 2) >> shift[channel]) & most[channel];
        return static_cast<float>(bits) / static_cast<float>(most[channel]);
    };
    const float first = end(8), second = end(10);
    return choose(std::array{first, second, mean_of(first, second, 1, 3), mean_of(first, second, 2, 3)},
                  little_endian(block, 12, 4), 2);
}

std::array<float, 16> bc2_alpha(Bc3Block block) {
    std::array<float, 16> values;
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i) / 15.0f;
    return choose(values, little_endian(block, 0, 8), 4);
}

}  // namespace shadowbench::scene
