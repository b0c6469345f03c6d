#include "techniques/deep/pixel_run.h"

#include <algorithm>
#include <limits>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

#include "base/error.h"
#include "curves/compress_published.h"

namespace shadowbench::techniques {
namespace {

// Calls visit(pixel of the level, pixel of the run) for the first pixel of every row.
template <class Visit>
void for_each_row(const DeepLevel& level, const PixelRun& run, const Visit& visit) {
    for (std::size_t first = 0; first + 1 < run.begin.size(); first += run.width)
        visit(level.pixel(run.x0, run.y0 + static_cast<int>(first) / run.width), first);
}

// Returns the number of vertices. `out` may be the function's own memory.
std::size_t compress_one(curves::CurveView function, curves::FewestScratch& fewest, const Compression& how,
                         curves::Vertex* out) {
    switch (how.method) {
        case Compression::Method::published:
            return curves::compress_published(function, how.tolerance, out);
        case Compression::Method::optimal:
            return curves::compress_to_fewest(function, how.tolerance, fewest, out);
        case Compression::Method::bounded:
            break;
    }
    return curves::compress(function, how.tolerance, out);
}

// `function` may be the scratch's first one.
void append_one(PixelRun& run, PixelScratch& scratch, curves::CurveView function, const Compression& how) {
    curves::Curve& out = scratch.function[0];
    if (out.size() < function.size()) out.resize(function.size());
    const std::size_t n = compress_one(function, scratch.fewest, how, out.data());
    const std::size_t first = run.floats.size();
    run.floats.resize(first + 2 * n);
    float* depths = run.floats.data() + first;
    for (std::size_t i = 0; i < n; ++i) {
        depths[i] = out[i].z;
        depths[n + i] = out[i].value;
    }
}

void end_pixel(PixelRun& run, bool coloured) {
    if (run.channels == 3) run.coloured.push_back(coloured);
    run.begin.push_back(static_cast<std::uint32_t>(run.floats.size()));
}

void append_three(PixelRun& run, PixelScratch& scratch, const Compression& how) {
    const auto& f = scratch.function;
    scratch.colour.resize(f[0].size() + f[1].size() + f[2].size());
    const std::array<curves::CurveView, 3> three{f[0], f[1], f[2]};
    const std::size_t n = how.method == Compression::Method::published
                              ? curves::compress_published(three, how.tolerance, scratch.colour.data())
                              : curves::compress(three, how.tolerance, scratch.colour.data());
    const std::size_t first = run.floats.size();
    run.floats.resize(first + 4 * n);
    float* depths = run.floats.data() + first;
    for (std::size_t i = 0; i < n; ++i) {
        depths[i] = scratch.colour[i].z;
        for (std::size_t c = 0; c < 3; ++c) depths[(c + 1) * n + i] = scratch.colour[i].value[c];
    }
}

// The C library keeps small blocks that were freed, unless it is asked.
constexpr std::size_t pays_to_return = std::size_t{32} << 20;
void return_freed_memory() {
#if defined(__GLIBC__)
    malloc_trim(0);
#endif
}

}  // namespace

std::size_t PixelScratch::bytes() const {
    std::size_t vertices = 0;
    for (const curves::Curve& curve : function) vertices += curve.capacity();
    for (const curves::Curve& curve : kept) vertices += curve.capacity();
    for (const curves::Curve& curve : children) vertices += curve.capacity();
    return vertices * sizeof(curves::Vertex) + colour.capacity() * sizeof(curves::ColourVertex) + sweep.bytes() +
           fewest.bytes();
}

bool is_coloured(const PixelScratch& scratch, int functions) {
    const auto& f = scratch.function;
    return functions == 3 && !(f[0] == f[1] && f[0] == f[2]);
}

void append(PixelRun& run, PixelScratch& scratch, int functions, const Compression& compression) {
    const bool coloured = is_coloured(scratch, functions);
    if (coloured)
        append_three(run, scratch, compression);
    else
        append_one(run, scratch, scratch.function[0], compression);
    end_pixel(run, coloured);
}

void append_given(PixelRun& run, PixelScratch& scratch, curves::CurveView function, const Compression& compression) {
    append_one(run, scratch, function, compression);
    end_pixel(run, false);
}

void complete(PixelRun& run) {
    run.begin.shrink_to_fit();
    run.floats.shrink_to_fit();
    run.coloured.shrink_to_fit();
}

void append_lossless(PixelRun& run, PixelScratch& scratch, int functions) {
    for (std::size_t c = 0; c < static_cast<std::size_t>(functions); ++c) scratch.kept[c] = scratch.function[c];
    append(run, scratch, functions, {});
    for (std::size_t c = 0; c < static_cast<std::size_t>(functions); ++c) scratch.function[c].swap(scratch.kept[c]);
}

DeepLevel assemble(int width, int height, int channels, std::span<PixelRun> runs, std::size_t& peak_bytes) {
    DeepLevel level;
    level.width = width;
    level.height = height;
    level.channels = channels;
    const std::size_t pixels = static_cast<std::size_t>(width) * height;
    std::size_t total = 0, held = 0;
    for (const PixelRun& run : runs) {
        total += run.floats.size();
        held += run.bytes();
    }
    if (total > std::numeric_limits<std::uint32_t>::max())
        throw base::Error(
            base::ErrorCode::bad_input, "/techniques",
            "a level of a deep map holds at most 2^32 numbers: raise the tolerance, lower the resolution, or make mip "
            "levels with mip_from=compressed");
    level.offsets.assign(pixels + 1, 0);
    if (channels == 3) level.coloured.assign((pixels + 63) / 64, 0);
    for (const PixelRun& run : runs)
        for_each_row(level, run, [&](std::size_t to, std::size_t from) {
            for (std::size_t x = 0; x < static_cast<std::size_t>(run.width); ++x) {
                level.offsets[to + x + 1] = run.begin[from + x + 1] - run.begin[from + x];
                if (channels == 3 && run.coloured[from + x])
                    level.coloured[(to + x) / 64] |= std::uint64_t{1} << (to + x) % 64;
            }
        });
    for (std::size_t p = 0; p < pixels; ++p) level.offsets[p + 1] += level.offsets[p];
    // The system gives pages to the level as they are written, so the runs and the level never fill memory both.
    level.floats.reserve(total + DeepLevel::padding);
    held += level.bytes() - level.floats.capacity() * sizeof(float);
    peak_bytes = held;
    std::size_t freed = 0;
    for (std::size_t first = 0, last = 0; first < runs.size(); first = last) {
        std::size_t band = 0;
        for (; last < runs.size() && runs[last].y0 == runs[first].y0; ++last) band += runs[last].floats.size();
        level.floats.resize(level.floats.size() + band);
        peak_bytes = std::max(peak_bytes, held + level.floats.size() * sizeof(float));
        for (PixelRun& run : runs.subspan(first, last - first)) {
            for_each_row(level, run, [&](std::size_t to, std::size_t from) {
                std::copy(run.floats.begin() + run.begin[from],
                          run.floats.begin() + run.begin[from + static_cast<std::size_t>(run.width)],
                          level.floats.begin() + level.offsets[to]);
            });
            held -= run.bytes();
            freed += run.bytes();
            run = {};
        }
        if (freed >= pays_to_return) {
            return_freed_memory();
            freed = 0;
        }
    }
    level.floats.resize(total + DeepLevel::padding);
    return level;
}

void read_function(const DeepLevel& level, std::size_t pixel, int channel, curves::Curve& out) {
    const std::size_t n = level.nodes(pixel);
    const float* depths = level.floats.data() + level.offsets[pixel];
    const float* values = depths + (level.has_colour(pixel) ? channel + 1 : 1) * n;
    out.resize(n);
    for (std::size_t i = 0; i < n; ++i) out[i] = {depths[i], values[i]};
}

}  // namespace shadowbench::techniques
