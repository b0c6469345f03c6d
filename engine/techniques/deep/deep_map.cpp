#include "techniques/deep/deep_map.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/error.h"
#include "curves/ray_functions.h"
#include "techniques/deep/mip.h"

namespace shadowbench::techniques {
namespace {

// The memory for making a tile's pixels.
struct TileScratch {
    PixelScratch pixel;
    std::vector<curves::WeightedRay> chosen;
    std::vector<RayOffset> offsets;
    const curves::RayFunctions* made = nullptr;  // of the tile's rays

    std::size_t bytes() const {
        return pixel.bytes() + chosen.capacity() * sizeof(curves::WeightedRay) +
               offsets.capacity() * sizeof(RayOffset) + (made ? made->scratch_bytes() : 0);
    }
};

bool is_grey(const rays::LightRays& tile, std::size_t first, std::size_t count) {
    for (std::size_t s = tile.begin[first]; s < tile.begin[first + count]; ++s) {
        const float* t = &tile.transmittance[3 * s];
        if (t[0] != t[1] || t[0] != t[2]) return false;
    }
    return true;
}

// Makes the functions of pixel (x, y): only one if its channels are surely equal. Returns how many. `offset_of(ray)` is
// called unless the filter is the pixel.
template <class OffsetOf>
int make_functions(const PixelFilter& filter, const rays::LightRays& tile, const OffsetOf& offset_of, int x, int y,
                   double linearisation, TileScratch& scratch) {
    auto& functions = scratch.pixel.function;
    const std::size_t count = static_cast<std::size_t>(tile.samples);
    if (filter.is_pixel()) {
        const std::size_t first = first_ray(tile, x, y);
        if (scratch.made) {
            curves::visibility(tile, *scratch.made, first, count, linearisation, scratch.pixel.sweep, functions[0]);
            return 1;
        }
        const int channels = tile.channels == 1 || is_grey(tile, first, count) ? 1 : 3;
        for (int c = 0; c < channels; ++c)
            curves::visibility(tile, first, count, linearisation, scratch.pixel.sweep, functions[c], c);
        return channels;
    }
    if (!any_segment(filter, tile, x, y)) {
        functions[0].clear();
        return 1;
    }
    filter_rays(filter, tile, offset_of, x, y, scratch.chosen);
    const bool grey =
        tile.channels == 1 || std::all_of(scratch.chosen.begin(), scratch.chosen.end(),
                                          [&](const curves::WeightedRay& r) { return is_grey(tile, r.ray, 1); });
    const int channels = grey ? 1 : 3;
    for (int c = 0; c < channels; ++c)
        curves::visibility(tile, scratch.chosen, linearisation, scratch.pixel.sweep, functions[c], c);
    return channels;
}

}  // namespace

double linearisation_of(double tolerance) {
    return std::max(tolerance / 16.0, 1e-6);
}

void DeepMap::begin(const rays::MapLayout& map_layout) {
    if (map_layout.apron < filter.apron())
        throw base::Error(base::ErrorCode::bad_input, "/techniques",
                          fmt::format("a pixel filter of radius {:g} needs an apron of {} pixels; the rays have {}",
                                      filter.radius, filter.apron(), map_layout.apron));
    layout_ = map_layout;
    begin_tiles(static_cast<std::size_t>(layout_.tiles()));
    scratch_bytes_.assign(layout_.tiles(), 0);
}

double DeepMap::linearisation() const {
    return layout_.media ? linearisation_of(compression.tolerance) : 0.0;
}

Compression DeepMap::after_lines() const {
    return {static_cast<float>(std::max(0.0, compression.tolerance - linearisation())), compression.method};
}

void DeepMap::begin_tiles(std::size_t count) {
    runs_.assign(count, {});
    lossless_.assign(rule.mip != Mip::none && levels_of_samples ? count : 0, {});
}

void DeepMap::place(std::size_t tile, int x0, int y0, int width, int channels) {
    const auto set = [&](PixelRun& run) {
        run.x0 = x0;
        run.y0 = y0;
        run.width = width;
        run.channels = channels;
    };
    set(runs_[tile]);
    if (!lossless_.empty()) set(lossless_[tile]);
}

void DeepMap::append(std::size_t tile, PixelScratch& scratch, int functions, const Compression& how) {
    if (!lossless_.empty()) append_lossless(lossless_[tile], scratch, functions);
    techniques::append(runs_[tile], scratch, functions, how);
}

void DeepMap::add(const rays::LightRays& tile, const curves::RayFunctions* functions) {
    const auto number = static_cast<std::size_t>(tile.tile);
    const int x0 = tile.tile % layout_.tiles_x() * layout_.tile_width;
    const int y0 = tile.tile / layout_.tiles_x() * layout_.tile_height;
    const int width = std::min(layout_.tile_width, layout_.width - x0);
    place(number, x0, y0, width, layout_.channels);
    const Compression rest = after_lines();
    TileScratch scratch;
    scratch.made = functions;
    const auto offset_of = [&](std::size_t ray) { return scratch.offsets[ray]; };
    if (!filter.is_pixel())
        for (std::size_t ray = 0; ray < tile.rays(); ++ray) scratch.offsets.push_back(ray_offset(layout_, tile, ray));
    const int y1 = std::min(y0 + layout_.tile_height, layout_.height);
    for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x0 + width; ++x)
            append(number, scratch.pixel, make_functions(filter, tile, offset_of, x, y, linearisation(), scratch),
                   rest);
    complete(runs_[number]);
    if (!lossless_.empty()) complete(lossless_[number]);
    scratch_bytes_[number] = scratch.bytes();
}

void DeepMap::finish() {
    const std::size_t scratch = *std::max_element(scratch_bytes_.begin(), scratch_bytes_.end());
    scratch_bytes_ = {};
    put_together(scratch, layout_.width, layout_.height, layout_.channels);
}

void DeepMap::make(std::span<const curves::Curve> functions) {
    const int width = static_cast<int>(functions.size());
    begin_tiles(1);
    place(0, 0, 0, width, 1);
    PixelScratch scratch;
    for (const curves::Curve& function : functions) {
        if (lossless_.empty()) {
            append_given(runs_[0], scratch, function, compression);
            continue;
        }
        scratch.function[0] = function;
        append(0, scratch, 1, compression);
    }
    put_together(scratch.bytes(), width, 1, 1);
}

void DeepMap::put_together(std::size_t scratch_bytes, int width, int height, int channels) {
    const auto bytes_of = [](const std::vector<PixelRun>& runs) {
        std::size_t sum = 0;
        for (const PixelRun& run : runs) sum += run.bytes();
        return sum;
    };
    std::size_t assembling = 0;
    levels.push_back(assemble(width, height, channels, runs_, assembling));
    peak_bytes = scratch_bytes + assembling + bytes_of(lossless_);
    runs_ = {};
    if (rule.mip == Mip::none) return;
    std::optional<DeepLevel> uncompressed;
    if (!lossless_.empty()) {
        uncompressed = assemble(width, height, channels, lossless_, assembling);
        peak_bytes = std::max(peak_bytes, bytes() + assembling);
        lossless_ = {};
    }
    const std::size_t working = add_mip_levels(levels, compression, std::move(uncompressed));
    peak_bytes = std::max(peak_bytes, working + bytes());
}

void DeepMap::weights(int x, int y, const rays::LightRays& tile, std::vector<curves::WeightedRay>& out) const {
    filter_rays(
        filter, tile, [&](std::size_t ray) { return ray_offset(layout_, tile, ray); }, x, y, out);
}

FewestNodes DeepMap::fewest_nodes(int x, int y, const rays::LightRays& tile) const {
    TileScratch scratch;
    const auto offset_of = [&](std::size_t ray) { return ray_offset(layout_, tile, ray); };
    const int functions = make_functions(filter, tile, offset_of, x, y, linearisation(), scratch);
    if (is_coloured(scratch.pixel, functions)) return {0, false};
    curves::Curve& function = scratch.pixel.function[0];
    curves::FewestScratch& fewest = scratch.pixel.fewest;
    fewest.most_steps = curves::steps_of_a_bound;
    const std::size_t nodes = curves::compress_to_fewest(function, after_lines().tolerance, fewest, function.data());
    return {nodes, fewest.complete};
}

std::size_t DeepMap::bytes() const {
    std::size_t sum = 0;
    for (const DeepLevel& level : levels) sum += level.bytes();
    return sum;
}

NodeStats DeepMap::stats() const {
    NodeStats result;
    const std::size_t pixels = levels[0].offsets.size() - 1;
    for (std::size_t p = 0; p < pixels; ++p) result.add(levels[0].nodes(p));
    return result;
}

}  // namespace shadowbench::techniques
