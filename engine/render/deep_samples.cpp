#include "render/deep_samples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/error.h"
#include "curves/sweep.h"
#include "techniques/cell_grid.h"

namespace shadowbench::render {
namespace {

using curves::Curve;

constexpr double linearisation = 1e-4;  // of media in pixels of several rays
constexpr double rounding = 1e-6;       // by which a function may rise
constexpr int sampled_depths = 64;

void close_pixel(DeepBlock& block) {
    block.begin.push_back(block.z_front.size());
}

void append_ray(const rays::LightRays& tile, std::size_t ray, DeepBlock& block) {
    for (std::uint32_t s = tile.begin[ray]; s < tile.begin[ray + 1]; ++s) {
        block.z_front.push_back(tile.z_front[s]);
        block.z_back.push_back(tile.back(s));
        for (int c = 0; c < tile.channels; ++c)
            block.alpha.push_back(1.0f - tile.transmittance[std::size_t{s} * tile.channels + c]);
    }
}

// The samples of one pixel, front to back. Each takes the composite of the earlier samples to the function's value
// behind it, so that rounding errors of alphas do not add up. Where a function is flat, no sample is made.
class Compositor {
public:
    Compositor(std::size_t channels, DeepBlock& block) : channels_(channels), block_(block) {
        composite_.fill(1.0);
        least_.fill(1.0f);
    }

    // Appends a sample after which the composite has these values. Returns false if one rises.
    bool reach(float z_front, float z_back, const std::array<float, 3>& values) {
        std::array<float, 3> alpha{};
        bool falls = false;
        for (std::size_t c = 0; c < channels_; ++c) {
            if (!(values[c] <= least_[c] + rounding)) return false;
            if (values[c] >= least_[c]) continue;
            least_[c] = values[c];
            if (composite_[c] <= 0.0) continue;  // because an alpha near 1 was rounded
            alpha[c] = static_cast<float>(std::clamp(1.0 - values[c] / composite_[c], 0.0, 1.0));
            composite_[c] *= 1.0 - static_cast<double>(alpha[c]);
            falls = falls || alpha[c] > 0.0f;
        }
        if (!falls) return true;
        block_.z_front.push_back(z_front);
        block_.z_back.push_back(z_back);
        block_.alpha.insert(block_.alpha.end(), alpha.begin(), alpha.begin() + static_cast<std::ptrdiff_t>(channels_));
        return true;
    }

private:
    std::size_t channels_;
    DeepBlock& block_;
    std::array<double, 3> composite_;
    std::array<float, 3> least_;
};

std::vector<float> depths_of(std::span<const Curve> functions) {
    std::vector<float> depths;
    for (const Curve& function : functions)
        for (const curves::Vertex& vertex : function) depths.push_back(vertex.z);
    std::sort(depths.begin(), depths.end());
    depths.erase(std::unique(depths.begin(), depths.end()), depths.end());
    return depths;
}

bool append_samples(std::span<const Curve> functions, float front, DeepBlock& block) {
    const std::vector<float> depths = depths_of(functions);
    if (depths.empty()) return true;
    const auto values = [&](float z, bool behind) {
        std::array<float, 3> result{};
        for (std::size_t c = 0; c < functions.size(); ++c)
            result[c] = behind ? curves::evaluate_behind(functions[c], z) : curves::evaluate(functions[c], z);
        return result;
    };
    Compositor composite(functions.size(), block);
    const float before = std::min(front, std::nextafter(depths[0], -std::numeric_limits<float>::infinity()));
    bool falls = composite.reach(before, before, values(depths[0], false));
    for (std::size_t i = 0; i < depths.size() && falls; ++i) {
        if (i > 0) falls = composite.reach(depths[i - 1], depths[i], values(depths[i], false));
        falls = falls && composite.reach(depths[i], depths[i], values(depths[i], true));
    }
    return falls;
}

// From the front to the back of all casters.
std::vector<float> even_depths(const rays::MapLayout& layout) {
    std::vector<float> depths;
    for (int i = 0; i < sampled_depths; ++i)
        depths.push_back(layout.z_min + (layout.z_max - layout.z_min) *
                                            (static_cast<float>(i) / static_cast<float>(sampled_depths - 1)));
    return depths;
}

}  // namespace

bool append_function(std::span<const Curve> functions, float front, DeepBlock& block) {
    const std::size_t before = block.z_front.size();
    if (append_samples(functions, front, block)) return true;
    block.z_front.resize(before);
    block.z_back.resize(before);
    block.alpha.resize(before * static_cast<std::size_t>(block.channels));
    return false;
}

DeepBlock samples_of_rays(const rays::LightRays& tile) {
    DeepBlock block{tile.x0, tile.y0, tile.width, tile.height, tile.channels, {0}, {}, {}, {}};
    std::vector<rays::LightRays> single;  // one channel each
    for (int c = 0; c < tile.channels && tile.samples > 1 && tile.channels > 1; ++c)
        single.push_back(rays::channel(tile, c));
    std::vector<Curve> functions(static_cast<std::size_t>(tile.channels));
    curves::SweepScratch scratch;
    const std::size_t pixels = static_cast<std::size_t>(tile.width) * tile.height;
    for (std::size_t p = 0; p < pixels; ++p, close_pixel(block)) {
        if (tile.samples == 1) {
            append_ray(tile, p, block);
            continue;
        }
        const auto count = static_cast<std::size_t>(tile.samples);
        for (std::size_t c = 0; c < functions.size(); ++c)
            curves::visibility(single.empty() ? tile : single[c], p * count, count, linearisation, scratch,
                               functions[c]);
        if (!append_function(functions, std::numeric_limits<float>::infinity(), block))
            throw base::Error(base::ErrorCode::internal, "", "a visibility function of light rays rises");
    }
    return block;
}

base::Vec2i size_of(const bench::Maps& maps) {
    const techniques::CellGrid grid = techniques::make_cells(*maps.layout, bench::cells(maps));
    return {grid.width, grid.height};
}

DeepBlock samples_of_functions(const bench::Maps& maps, int y) {
    DeepBlock block{0, y, size_of(maps).x, 1, static_cast<int>(maps.channels()), {0}, {}, {}, {}};
    const std::vector<float> depths = even_depths(*maps.layout);
    std::vector<Curve> functions(maps.channels());
    for (int x = 0; x < block.width; ++x, close_pixel(block)) {
        for (int c = 0; c < block.channels; ++c)
            bench::stored(maps, x, y, c, depths, functions[static_cast<std::size_t>(c)]);
        if (!append_function(functions, maps.layout->z_min, block))
            throw base::Error(
                base::ErrorCode::bad_input, "--technique",
                fmt::format("the function of cell ({}, {}) rises with depth, which a deep image cannot hold", x, y));
    }
    if (const std::string fault = bench::fault(maps); !fault.empty())
        throw base::Error(base::ErrorCode::internal, "--technique", fault);
    return block;
}

}  // namespace shadowbench::render
