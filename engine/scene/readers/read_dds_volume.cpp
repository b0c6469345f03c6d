// DDS volume textures. OpenImageIO 2.4 opens them, but reads the blocks of their first slice alone. Slices follow each
// other, and a block covers texels of one slice.
#include <algorithm>
#include <array>
#include <cstdint>

#include <fmt/format.h>

#include "scene/readers/bc3.h"
#include "scene/readers/dds_layout.h"
#include "scene/readers/file_reader.h"
#include "scene/readers/files.h"

namespace shadowbench::scene {
namespace {

constexpr std::array<const char*, 4> channel_names{"red", "green", "blue", "alpha"};
constexpr int alpha = 3;

// The channel that holds the density: 0 to 3.
int choose_channel(const FileReader& file, const DdsLayout& layout, DdsChannel wanted) {
    const auto there = [&](int channel) {
        return layout.blocks || layout.byte[static_cast<std::size_t>(channel)] >= 0;
    };
    if (wanted != DdsChannel::usual) {
        const int channel = static_cast<int>(wanted) - static_cast<int>(DdsChannel::red);
        if (!there(channel))
            file.fail(80, fmt::format("its texels have no {} channel; give another \"channel\"",
                                      channel_names[static_cast<std::size_t>(channel)]));
        return channel;
    }
    if (there(alpha)) return alpha;
    if (layout.byte[0] == layout.byte[1] && layout.byte[0] == layout.byte[2]) return 0;
    file.fail(80, "its texels have several channels and no alpha: give \"channel\"");
}

using Row = std::vector<std::uint8_t>;

// Copies the texels of a row of blocks that are inside the slice; `density` is that of the row's first texel.
void unpack_blocks(const Row& row, const DdsLayout& layout, int y, int channel, float* density) {
    const Vec3i& size = layout.size;
    const int rows = std::min(bc3_side, size.y - y);
    for (int x = 0; x < size.x; x += bc3_side) {
        const Bc3Block block(row.data() + static_cast<std::size_t>(x / bc3_side) * bc3_bytes, bc3_bytes);
        const std::array<float, 16> texels = channel != alpha ? bc3_colour(block, channel)
                                             : layout.bc2     ? bc2_alpha(block)
                                                              : bc3_alpha(block);
        const int columns = std::min(bc3_side, size.x - x);
        for (int j = 0; j < rows; ++j)
            std::copy_n(texels.begin() + j * bc3_side, columns, density + std::ptrdiff_t{j} * size.x + x);
    }
}

}  // namespace

GridVolume read_dds_volume(const std::filesystem::path& file, DdsChannel wanted, std::uint64_t most_voxels) {
    FileReader reader(file);
    const DdsLayout layout = read_dds_layout(reader, most_voxels);
    const int channel = choose_channel(reader, layout, wanted);
    const Vec3i size = layout.size;
    const int rows_at_once = layout.blocks ? bc3_side : 1;
    const auto columns = static_cast<std::uint64_t>((size.x - 1) / rows_at_once + 1);
    const std::uint64_t row_bytes =
        columns * (layout.blocks ? bc3_bytes : static_cast<std::uint64_t>(layout.texel_bytes));
    const auto rows = static_cast<std::uint64_t>((size.y - 1) / rows_at_once + 1) * static_cast<std::uint64_t>(size.z);
    reader.need(rows, row_bytes, "voxels");

    GridVolume volume;
    volume.size = size;
    volume.density.resize(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) *
                          static_cast<std::size_t>(size.z));
    float* density = volume.density.data();
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; y += rows_at_once) {
            const Row row = reader.array<std::uint8_t>(row_bytes, "voxels");
            if (layout.blocks) {
                unpack_blocks(row, layout, y, channel, density);
            } else {
                const std::uint8_t* from = row.data() + layout.byte[static_cast<std::size_t>(channel)];
                for (int x = 0; x < size.x; ++x) density[x] = static_cast<float>(from[x * layout.texel_bytes]) / 255.0f;
            }
            density += std::ptrdiff_t{std::min(rows_at_once, size.y - y)} * size.x;
        }
    if (layout.mip_levels > 1)
        volume.notes.lines.push_back(
            fmt::format("its largest mip level is read and {} passed over", layout.mip_levels - 1));
    return volume;
}

}  // namespace shadowbench::scene
