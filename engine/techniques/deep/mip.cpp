#include "techniques/deep/mip.h"

#include <algorithm>
#include <cmath>

namespace shadowbench::techniques {
namespace {

// The pixels of the level below that one pixel covers, with their shares.
struct Children {
    std::size_t count = 0;
    std::array<std::size_t, 4> pixel{};
    std::array<double, 4> share{};
};

// The number of map pixels, along one side, that a pixel of a level covers.
int covered(int at, int level, int map_size) {
    return static_cast<int>(std::min(1LL << level, map_size - (static_cast<long long>(at) << level)));
}

Children children_of(const DeepLevel& below, int level, const DeepLevel& map, int x, int y) {
    Children children;
    const double area =
        static_cast<double>(covered(x, level, map.width)) * static_cast<double>(covered(y, level, map.height));
    for (int cy = 2 * y; cy < std::min(2 * y + 2, below.height); ++cy)
        for (int cx = 2 * x; cx < std::min(2 * x + 2, below.width); ++cx) {
            children.pixel[children.count] = below.pixel(cx, cy);
            children.share[children.count++] = static_cast<double>(covered(cx, level - 1, map.width)) *
                                               static_cast<double>(covered(cy, level - 1, map.height)) / area;
        }
    return children;
}

// Makes the functions of the scratch the means of those of the children. Returns how many: 1 or 3.
int average(const DeepLevel& below, const Children& children, PixelScratch& scratch) {
    bool coloured = false;
    for (std::size_t i = 0; i < children.count; ++i) coloured = coloured || below.has_colour(children.pixel[i]);
    const int functions = coloured ? 3 : 1;
    std::array<curves::WeightedCurve, 4> terms;
    for (int c = 0; c < functions; ++c) {
        for (std::size_t i = 0; i < children.count; ++i) {
            read_function(below, children.pixel[i], c, scratch.children[i]);
            terms[i] = {scratch.children[i], children.share[i]};
        }
        curves::weighted_sum({terms.data(), children.count}, scratch.sweep, scratch.function[c]);
    }
    return functions;
}

PixelRun run_of(int width, int channels) {
    PixelRun run;
    run.width = width;
    run.channels = channels;
    return run;
}

}  // namespace

int mip_levels(int width, int height) {
    int levels = 1;
    while (mip_size(width, levels - 1) > 1 || mip_size(height, levels - 1) > 1) ++levels;
    return levels;
}

std::size_t add_mip_levels(std::vector<DeepLevel>& levels, const Compression& compression,
                           std::optional<DeepLevel> uncompressed) {
    const int count = mip_levels(levels[0].width, levels[0].height);
    levels.reserve(static_cast<std::size_t>(count));
    PixelScratch scratch;
    std::size_t peak = 0;
    for (int l = 1; l < count; ++l) {
        const DeepLevel &map = levels[0], &below = uncompressed ? *uncompressed : levels.back();
        const int width = mip_size(map.width, l), height = mip_size(map.height, l), channels = map.channels;
        PixelRun run = run_of(width, channels), lossless = run_of(width, channels);
        const Compression finer{std::ldexp(compression.tolerance, -l), compression.method};
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const int functions = average(below, children_of(below, l, map, x, y), scratch);
                if (uncompressed) append_lossless(lossless, scratch, functions);
                append(run, scratch, functions, finer);
            }
        std::size_t held = scratch.bytes() + run.bytes(), assembling = 0;
        levels.push_back(assemble(width, height, channels, {&run, 1}, assembling));  // ends the life of `map`, `below`
        if (uncompressed) {
            DeepLevel next = assemble(width, height, channels, {&lossless, 1}, assembling);
            held += assembling + uncompressed->bytes();
            *uncompressed = std::move(next);
        }
        peak = std::max(peak, held);
    }
    levels.shrink_to_fit();
    return peak;
}

}  // namespace shadowbench::techniques
