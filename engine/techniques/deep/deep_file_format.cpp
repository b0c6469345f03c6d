#include "techniques/deep/deep_file_format.h"

#include <zlib.h>

namespace shadowbench::techniques::deep_format {

std::uint32_t checksum(const void* bytes, std::size_t count, std::uint32_t before) {
    return static_cast<std::uint32_t>(crc32_z(before, static_cast<const Bytef*>(bytes), count));
}

std::vector<DeepTiling> tilings(int width, int height, int levels, int tile_size) {
    std::vector<DeepTiling> result;
    std::size_t first = 0;
    for (int level = 0; level < levels; ++level) {
        result.push_back(
            {width, height, (width + tile_size - 1) / tile_size, (height + tile_size - 1) / tile_size, first});
        first += result.back().tiles();
        width = (width + 1) / 2;
        height = (height + 1) / 2;
    }
    return result;
}

}  // namespace shadowbench::techniques::deep_format
