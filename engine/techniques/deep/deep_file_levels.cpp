// Reads a whole file back into memory.
#include <algorithm>

#include "techniques/deep/deep_file.h"

namespace shadowbench::techniques {
namespace {

// Calls visit(pixel of the level, its function) for every pixel of a level, tile by tile.
template <class Visit>
void for_each_function(const DeepFile& file, int level, std::vector<std::byte>& tile, const Visit& visit) {
    const DeepTiling& tiling = file.levels()[static_cast<std::size_t>(level)];
    for (std::size_t t = 0; t < tiling.tiles(); ++t) {
        const std::size_t number = tiling.first + t, pixels = file.tile_pixels(number);
        tile.resize(std::max(tile.size(), file.tile_bytes(number)));
        file.read_tile(number, tile.data());
        const int x0 = static_cast<int>(t % tiling.tiles_x) * file.tile_size();
        const int y0 = static_cast<int>(t / tiling.tiles_x) * file.tile_size();
        const int width = file.tile_width(x0, level);
        for (std::size_t p = 0; p < pixels; ++p) {
            const int x = x0 + static_cast<int>(p) % width, y = y0 + static_cast<int>(p) / width;
            visit(static_cast<std::size_t>(y) * tiling.width + x, function_of(tile.data(), pixels, file.channels(), p));
        }
    }
}

std::uint32_t floats_of(const DeepFunction& f) {
    return f.nodes * static_cast<std::uint32_t>(1 + f.channels);
}

// Reads the tiles twice: rows of pixels run across tiles, so the offsets must be known before the floats can be placed.
DeepLevel read_level(const DeepFile& file, int number, std::vector<std::byte>& tile) {
    const DeepTiling& tiling = file.levels()[static_cast<std::size_t>(number)];
    const std::size_t pixels = static_cast<std::size_t>(tiling.width) * tiling.height;
    DeepLevel level{tiling.width, tiling.height, file.channels(), {}, {}, {}};
    level.offsets.assign(pixels + 1, 0);
    if (file.channels() == 3) level.coloured.assign((pixels + 63) / 64, 0);
    for_each_function(file, number, tile, [&](std::size_t pixel, const DeepFunction& f) {
        level.offsets[pixel + 1] = floats_of(f);
        if (f.channels == 3) level.coloured[pixel / 64] |= std::uint64_t{1} << (pixel % 64);
    });
    for (std::size_t p = 0; p < pixels; ++p) level.offsets[p + 1] += level.offsets[p];
    level.floats.assign(std::size_t{level.offsets.back()} + DeepLevel::padding, 0.0f);
    for_each_function(file, number, tile, [&](std::size_t pixel, const DeepFunction& f) {
        std::copy_n(f.depths, floats_of(f), level.floats.data() + level.offsets[pixel]);
    });
    return level;
}

}  // namespace

std::vector<DeepLevel> read_levels(const DeepFile& file) {
    std::vector<DeepLevel> levels;
    std::vector<std::byte> tile;
    for (int level = 0; level < static_cast<int>(file.levels().size()); ++level)
        levels.push_back(read_level(file, level, tile));
    return levels;
}

}  // namespace shadowbench::techniques
