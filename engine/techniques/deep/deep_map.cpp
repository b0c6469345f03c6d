#include "techniques/deep/deep_map.h"

#include <cmath>
#include <experimental/simd>
#include <limits>

#include "base/error.h"
#include "curves/compress.h"
#include "curves/sweep.h"

namespace shadowbench::techniques {
namespace {

namespace simd = std::experimental;

constexpr std::uint32_t lanes = DeepLevel::padding;  // depths that are compared at once
using Lanes = simd::fixed_size_simd<float, static_cast<int>(lanes)>;

// First of n sorted depths that is not less than z. Without branches for short functions, which most are.
inline std::uint32_t lower_bound(const float* depths, std::uint32_t n, float z) {
    if (n <= lanes) {
        const Lanes number([](auto lane) { return static_cast<float>(lane); });
        const auto before =
            (Lanes(depths, simd::element_aligned) < z) && (number < static_cast<float>(static_cast<int>(n)));
        return static_cast<std::uint32_t>(simd::popcount(before));
    }
    const float* first = depths;
    while (n > 1) {
        const std::uint32_t half = n / 2;
        first += first[half - 1] < z ? half : 0;
        n -= half;
    }
    return static_cast<std::uint32_t>(first - depths) + (*first < z);
}

// curves::evaluate, to the bit.
inline float evaluate(const float* depths, std::uint32_t n, float z) {
    if (n == 0) return 1.0f;
    const float* values = depths + n;
    const std::uint32_t next = lower_bound(depths, n, z);
    if (next == 0) return values[0];
    if (next == n) return values[n - 1];
    return curves::join({depths[next - 1], values[next - 1]}, {depths[next], values[next]}, z);
}

}  // namespace

double linearisation_of(double tolerance) {
    return std::max(tolerance / 16.0, 1e-6);
}

void DeepMap::begin(const rays::MapLayout& map_layout) {
    layout_ = map_layout;
    grid = make_cells(layout_, Cells::pixel);
    tiles_.assign(layout_.tiles(), {});
}

void DeepMap::add(const rays::LightRays& tile) {
    TileNodes& out = tiles_[tile.tile];
    out.x0 = tile.x0;
    out.y0 = tile.y0;
    out.width = tile.width;
    out.begin.assign(1, 0);
    const double linearisation = layout_.media ? linearisation_of(tolerance) : 0.0;
    const float compression = static_cast<float>(std::max(0.0, tolerance - linearisation));
    curves::SweepScratch scratch;
    curves::Curve function;
    const std::size_t pixels = static_cast<std::size_t>(tile.width) * tile.height;
    for (std::size_t p = 0; p < pixels; ++p) {
        curves::visibility(tile, p * tile.samples, tile.samples, linearisation, scratch, function);
        const std::size_t kept = curves::compress(function, compression, function.data());
        out.vertices.insert(out.vertices.end(), function.begin(), function.begin() + static_cast<std::ptrdiff_t>(kept));
        out.begin.push_back(static_cast<std::uint32_t>(out.vertices.size()));
    }
    out.scratch_bytes = scratch.bytes() + function.capacity() * sizeof(curves::Vertex);
}

void DeepMap::finish() {
    std::size_t total = 0, held = 0, scratch = 0;
    DeepLevel& level = levels[0];
    level.width = grid.width;
    level.height = grid.height;
    std::vector<std::uint32_t>& offsets = level.offsets;
    offsets.assign(grid.count() + 1, 0);
    for (const TileNodes& t : tiles_) {
        total += t.vertices.size();
        held += t.vertices.capacity() * sizeof(curves::Vertex) + t.begin.capacity() * sizeof(std::uint32_t);
        scratch = std::max(scratch, t.scratch_bytes);
        for (std::size_t p = 0; p + 1 < t.begin.size(); ++p)
            offsets[grid.index(t.x0 + static_cast<int>(p) % t.width, t.y0 + static_cast<int>(p) / t.width) + 1] =
                2 * (t.begin[p + 1] - t.begin[p]);
    }
    if (total > std::numeric_limits<std::uint32_t>::max() / 2)
        throw base::Error(base::ErrorCode::bad_input, "/techniques",
                          "a deep map holds at most 2^31 vertices: raise the tolerance or lower the resolution");
    for (std::size_t p = 0; p < grid.count(); ++p) offsets[p + 1] += offsets[p];
    level.floats.assign(2 * total + lanes, 0.0f);
    for (const TileNodes& t : tiles_)
        for (std::size_t p = 0; p + 1 < t.begin.size(); ++p) {
            const std::size_t pixel =
                grid.index(t.x0 + static_cast<int>(p) % t.width, t.y0 + static_cast<int>(p) / t.width);
            const std::uint32_t n = t.begin[p + 1] - t.begin[p];
            float* depths = level.floats.data() + offsets[pixel];
            for (std::uint32_t i = 0; i < n; ++i) {
                depths[i] = t.vertices[t.begin[p] + i].z;
                depths[n + i] = t.vertices[t.begin[p] + i].value;
            }
        }
    peak_bytes = held + scratch + bytes();
    tiles_ = {};
}

void DeepMap::lookup(std::span<const Query> queries, std::span<float> visibility) const {
    const std::vector<std::uint32_t>& offsets = levels[0].offsets;
    const std::vector<float>& nodes = levels[0].floats;
    // Queries go in blocks: the lines of a whole block are asked for before the first is used, so that their misses
    // overlap. First the offsets, then the nodes that they point to.
    constexpr std::size_t block = 32;
    std::uint32_t cell[block];
    bool single[block];
    for (std::size_t start = 0; start < queries.size(); start += block) {
        const std::size_t count = std::min(block, queries.size() - start);
        for (std::size_t k = 0; k < count; ++k) {
            const Query& q = queries[start + k];
            int x, y;
            single[k] = q.width <= 1.0f && !tent && grid.find(q.x, q.y, x, y);
            cell[k] = single[k] ? static_cast<std::uint32_t>(grid.index(x, y)) : 0;
            __builtin_prefetch(&offsets[cell[k]]);
        }
        for (std::size_t k = 0; k < count; ++k) {
            const float* first = nodes.data() + offsets[cell[k]];
            __builtin_prefetch(first);
            __builtin_prefetch(first + 16);
        }
        for (std::size_t k = 0; k < count; ++k) {
            const Query& q = queries[start + k];
            if (single[k]) {
                const std::uint32_t begin = offsets[cell[k]];
                visibility[start + k] = evaluate(nodes.data() + begin, (offsets[cell[k] + 1] - begin) / 2, q.z);
                continue;
            }
            Query wide = q;
            if (tent) wide.width *= 2.0f;
            const CellRange r = footprint(grid, wide);
            float sum = 0.0f, weights = 0.0f;
            for (int y = r.y0; y < r.y1; ++y)
                for (int x = r.x0; x < r.x1; ++x) {
                    const float wx = tent ? 1.0f - std::abs(static_cast<float>(x) + 0.5f - q.x) / q.width : 1.0f;
                    const float wy = tent ? 1.0f - std::abs(static_cast<float>(y) + 0.5f - q.y) / q.width : 1.0f;
                    const float weight = std::max(wx * wy, 0.0f);
                    const std::size_t p = grid.index(x, y);
                    sum += weight * evaluate(nodes.data() + offsets[p], (offsets[p + 1] - offsets[p]) / 2, q.z);
                    weights += weight;
                }
            visibility[start + k] = weights > 0.0f ? std::min(sum / weights, 1.0f) : 1.0f;
        }
    }
}

void DeepMap::touched(const Query& q, std::vector<const void*>& lines) const {
    Query wide = q;
    if (tent) wide.width *= 2.0f;
    const CellRange r = footprint(grid, wide);
    for (int y = r.y0; y < r.y1; ++y)
        for (int x = r.x0; x < r.x1; ++x) {
            const std::size_t p = grid.index(x, y);
            touch_lines(&levels[0].offsets[p], 2 * sizeof(std::uint32_t), lines);
            const std::uint32_t n = levels[0].nodes(p);
            if (n == 0) continue;
            const float* depths = levels[0].floats.data() + levels[0].offsets[p];
            const std::uint32_t i = lower_bound(depths, n, q.z);
            // The search ends at the two depths around z and reads the values beside them; a long function's earlier
            // probes lie elsewhere, and are counted too.
            const std::size_t before = lines.size();
            for (std::uint32_t low = 0, left = n; left > 1;) {
                const std::uint32_t half = left / 2;
                touch_lines(depths + low + half - 1, sizeof(float), lines);
                low += depths[low + half - 1] < q.z ? half : 0;
                left -= half;
            }
            touch_lines(depths + std::min(i, n - 1), sizeof(float), lines);
            touch_lines(depths + n + (i ? i - 1 : 0), sizeof(float), lines);
            touch_lines(depths + n + std::min(i, n - 1), sizeof(float), lines);
            keep_unique(lines, before);
        }
}

NodeStats DeepMap::stats() const {
    NodeStats result;
    for (std::size_t p = 0; p < grid.count(); ++p) result.add(levels[0].nodes(p));
    return result;
}

void DeepMap::stored(int x, int y, curves::Curve& out) const {
    const std::size_t p = grid.index(x, y);
    const std::uint32_t n = levels[0].nodes(p);
    const float* depths = levels[0].floats.data() + levels[0].offsets[p];
    out.resize(n);
    for (std::uint32_t i = 0; i < n; ++i) out[i] = {depths[i], depths[n + i]};
}

}  // namespace shadowbench::techniques
