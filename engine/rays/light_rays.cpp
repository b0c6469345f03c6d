#include "rays/light_rays.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/compensated.h"
#include "base/random.h"
#include "rays/pixel_positions.h"
#include "rays/shutter.h"

namespace shadowbench::rays {
namespace {

// The key of the pixel that holds sample cell (i, j).
std::uint64_t pixel_of(const MapLayout& layout, int i, int j) {
    return static_cast<std::uint64_t>(i / layout.samples_x) << 32 | static_cast<std::uint32_t>(j / layout.samples_y);
}

// The columns and rows of a multi-jittered pixel: those of the cells' columns permuted, and of their rows.
std::uint32_t permuted_column(const MapLayout& layout, int column, std::uint64_t key) {
    return scatter(static_cast<std::uint32_t>(column), static_cast<std::uint32_t>(layout.samples_x), base::mix(key));
}
std::uint32_t permuted_row(const MapLayout& layout, int row, std::uint64_t key) {
    return scatter(static_cast<std::uint32_t>(row), static_cast<std::uint32_t>(layout.samples_y), key);
}
std::uint64_t permutation_key(const MapLayout& layout, int i, int j) {
    return base::hash(layout.seed ^ 0x66696e6572u, pixel_of(layout, i, j));
}

// Row and column are the permuted ones of the cell, if the layout is multi-jittered.
SamplePosition position_in_cell(const MapLayout& layout, int i, int j, std::uint32_t column, std::uint32_t row) {
    double u = 0.5, v = 0.5;
    if (layout.jittered) {
        const std::uint64_t bits =
            base::hash(layout.seed, static_cast<std::uint64_t>(i) << 32 | static_cast<std::uint32_t>(j));
        u = static_cast<double>(bits >> 32) * 0x1p-32;
        v = static_cast<double>(bits & 0xffffffffu) * 0x1p-32;
        if (layout.multi_jittered) {
            u = (row + u) / layout.samples_y;
            v = (column + v) / layout.samples_x;
        }
    }
    return {(i + u) / layout.samples_x, (j + v) / layout.samples_y};
}

}  // namespace

void set_samples(MapLayout& layout, int samples) {
    int across = static_cast<int>(std::sqrt(static_cast<double>(samples)));
    while (across > 1 && samples % across != 0) --across;
    layout.samples_x = std::max(across, 1);
    layout.samples_y = samples / layout.samples_x;
}

SamplePosition sample_position(const MapLayout& layout, int i, int j) {
    if (!layout.multi_jittered) return position_in_cell(layout, i, j, 0, 0);
    const std::uint64_t key = permutation_key(layout, i, j);
    return position_in_cell(layout, i, j, permuted_column(layout, i % layout.samples_x, key),
                            permuted_row(layout, j % layout.samples_y, key));
}

void pixel_positions(const MapLayout& layout, int x, int y, std::vector<SamplePosition>& positions) {
    const int i0 = x * layout.samples_x, j0 = y * layout.samples_y;
    thread_local std::vector<std::uint32_t> columns;  // keeps its memory from pixel to pixel
    columns.assign(static_cast<std::size_t>(layout.samples_x), 0);
    const std::uint64_t key = permutation_key(layout, i0, j0);
    if (layout.multi_jittered)
        for (int i = 0; i < layout.samples_x; ++i) columns[i] = permuted_column(layout, i, key);
    positions.clear();
    for (int j = 0; j < layout.samples_y; ++j) {
        const std::uint32_t row = layout.multi_jittered ? permuted_row(layout, j, key) : 0;
        for (int i = 0; i < layout.samples_x; ++i)
            positions.push_back(position_in_cell(layout, i0 + i, j0 + j, columns[i], row));
    }
}

TileCore core_of(const MapLayout& layout, int tile) {
    TileCore core{tile % layout.tiles_x() * layout.tile_width, tile / layout.tiles_x() * layout.tile_height, 0, 0};
    core.width = std::min(layout.tile_width, layout.width - core.x0);
    core.height = std::min(layout.tile_height, layout.height - core.y0);
    return core;
}

double sample_time(const MapLayout& layout, int i, int j) {
    if (!layout.moving) return 0.0;
    const std::uint64_t key = base::hash(layout.seed ^ 0x74696d65u, pixel_of(layout, i, j));
    const std::uint32_t part =
        shutter_part(layout.samples_x, layout.samples_y, i % layout.samples_x, j % layout.samples_y, key);
    const double within = layout.jittered ? static_cast<double>(base::hash(key, part) >> 32) * 0x1p-32 : 0.5;
    return (part + within) / layout.samples();
}

LightRays channel(const LightRays& rays, int channel) {
    LightRays result = rays;
    result.channels = 1;
    if (rays.channels > 1) {
        result.transmittance.resize(rays.segments());
        for (std::size_t s = 0; s < rays.segments(); ++s)
            result.transmittance[s] = rays.transmittance[s * rays.channels + channel];
    }
    return result;
}

double optical_depth(const LightRays& rays, std::size_t segment, int channel, double z) {
    const double front = rays.z_front[segment], back = rays.back(segment);
    const float through = rays.transmittance[segment * rays.channels + channel];
    const double thickness = -std::log(static_cast<double>(std::max(through, std::numeric_limits<float>::min())));
    return thickness * ((z - front) / (back - front));
}

double transmittance(const LightRays& rays, std::size_t ray, int channel, double z) {
    base::CompensatedProduct passed;
    base::CompensatedSum inside;  // optical depth of the media that reach beyond z
    for (std::size_t s = rays.begin[ray]; s < rays.begin[ray + 1] && rays.z_front[s] < z; ++s) {
        if (rays.back(s) <= z)
            passed.multiply(rays.transmittance[s * rays.channels + channel]);
        else
            inside.add(optical_depth(rays, s, channel, z));
    }
    return passed.value() * std::exp(-inside.value());
}

}  // namespace shadowbench::rays
