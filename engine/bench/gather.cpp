#include "bench/gather.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "base/compensated.h"

namespace shadowbench::bench {
namespace {

using rays::LightRays;
using rays::MapLayout;
using techniques::Query;

// For each pixel of a tile, the parts whose footprint touches it, by depth.
struct PartsByPixel {
    std::vector<std::uint32_t> begin;  // pixels + 1
    std::vector<std::uint32_t> part;
};

template <class Visit>
void for_each_pixel(const LightRays& tile, const FilterBox& f, const Visit& visit) {
    for (int y = std::max(f.y0, tile.y0); y <= std::min(f.y1, tile.y0 + tile.height - 1); ++y)
        for (int x = std::max(f.x0, tile.x0); x <= std::min(f.x1, tile.x0 + tile.width - 1); ++x)
            visit(static_cast<std::size_t>(y - tile.y0) * tile.width + (x - tile.x0));
}

PartsByPixel sort_parts(const LightRays& tile, const std::vector<FilterBox>& footprints, std::span<const Query> queries,
                        std::span<const Part> parts) {
    std::vector<std::uint32_t> order(parts.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return queries[parts[a].query].z < queries[parts[b].query].z;
    });
    PartsByPixel result;
    result.begin.assign(static_cast<std::size_t>(tile.width) * tile.height + 1, 0);
    for (const FilterBox& f : footprints) for_each_pixel(tile, f, [&](std::size_t p) { ++result.begin[p + 1]; });
    std::partial_sum(result.begin.begin(), result.begin.end(), result.begin.begin());
    result.part.resize(result.begin.back());
    std::vector<std::uint32_t> next(result.begin.begin(), result.begin.end() - 1);
    for (const std::uint32_t i : order)
        for_each_pixel(tile, footprints[i], [&](std::size_t p) { result.part[next[p]++] = i; });
    return result;
}

// The transmittance of one ray at ever larger depths: what rays::transmittance gives, without starting anew.
class RayWalk {
public:
    void start(const LightRays& tile, std::size_t ray) {
        next_ = tile.begin[ray];
        end_ = tile.begin[ray + 1];
        std::fill(std::begin(passed_), std::end(passed_), base::CompensatedProduct());
        inside_.clear();
    }

    void advance(const LightRays& tile, double z) {
        for (; next_ < end_ && tile.z_front[next_] < z; ++next_) {
            if (tile.back(next_) <= z)
                pass(tile, next_);
            else
                inside_.push_back(next_);
        }
        std::size_t kept = 0;
        for (const std::size_t s : inside_) {
            if (tile.back(s) <= z)
                pass(tile, s);
            else
                inside_[kept++] = s;
        }
        inside_.resize(kept);
    }

    double transmittance(const LightRays& tile, int channel, double z) const {
        base::CompensatedSum inside;
        for (const std::size_t s : inside_) inside.add(rays::optical_depth(tile, s, channel, z));
        return passed_[channel].value() * std::exp(-inside.value());
    }

private:
    void pass(const LightRays& tile, std::size_t s) {
        for (int c = 0; c < tile.channels; ++c) passed_[c].multiply(tile.transmittance[s * tile.channels + c]);
    }

    std::size_t next_ = 0, end_ = 0;
    base::CompensatedProduct passed_[3];
    std::vector<std::size_t> inside_;  // media that reach beyond the depth
};

}  // namespace

FilterBox filter_box(const Query& query, const MapLayout& layout) {
    const double half = 0.5 * query.width;
    FilterBox f{query.x - half, query.x + half, query.y - half, query.y + half, 0, 0, 0, 0};
    const auto pixel = [](double place, int pixels) {
        return static_cast<int>(std::clamp(std::floor(place), 0.0, pixels - 1.0));
    };
    f.x0 = pixel(f.left, layout.width);
    f.x1 = pixel(f.right, layout.width);
    f.y0 = pixel(f.low, layout.height);
    f.y1 = pixel(f.high, layout.height);
    return f;
}

void gather_footprints(const LightRays& tile, const MapLayout& layout, std::span<const Query> queries,
                       std::span<Part> parts) {
    std::vector<FilterBox> footprints;
    footprints.reserve(parts.size());
    for (const Part& part : parts) footprints.push_back(filter_box(queries[part.query], layout));
    const PartsByPixel sorted = sort_parts(tile, footprints, queries, parts);
    RayWalk walk;
    for (std::size_t ray = 0; ray < tile.rays(); ++ray) {
        const std::size_t pixel = ray / tile.samples, sample = ray % tile.samples;
        if (sorted.begin[pixel] == sorted.begin[pixel + 1]) continue;
        const int x = tile.x0 + static_cast<int>(pixel) % tile.width,
                  y = tile.y0 + static_cast<int>(pixel) / tile.width;
        const rays::SamplePosition place =
            rays::sample_position(layout, x * layout.samples_x + static_cast<int>(sample) % layout.samples_x,
                                  y * layout.samples_y + static_cast<int>(sample) / layout.samples_x);
        walk.start(tile, ray);
        for (std::uint32_t k = sorted.begin[pixel]; k < sorted.begin[pixel + 1]; ++k) {
            const FilterBox& f = footprints[sorted.part[k]];
            if (place.x < f.left || place.x > f.right || place.y < f.low || place.y > f.high) continue;
            Part& part = parts[sorted.part[k]];
            const double z = queries[part.query].z;
            walk.advance(tile, z);
            for (int c = 0; c < tile.channels; ++c) part.moments.add(c, walk.transmittance(tile, c, z));
            ++part.moments.count;
        }
    }
}

void gather_nearest(const LightRays& tile, const MapLayout& layout, std::span<const Query> queries,
                    std::span<Part> parts) {
    for (Part& part : parts) {
        const Query& query = queries[part.query];
        const int i = static_cast<int>(query.x * static_cast<double>(layout.samples_x));
        const int j = static_cast<int>(query.y * static_cast<double>(layout.samples_y));
        const int x = i / layout.samples_x - tile.x0, y = j / layout.samples_y - tile.y0;
        if (x < 0 || x >= tile.width || y < 0 || y >= tile.height) continue;
        const int sample = (j % layout.samples_y) * layout.samples_x + i % layout.samples_x;
        const std::size_t ray = (static_cast<std::size_t>(y) * tile.width + x) * tile.samples + sample;
        for (int c = 0; c < tile.channels; ++c) part.moments.add(c, rays::transmittance(tile, ray, c, query.z));
        ++part.moments.count;
    }
}

}  // namespace shadowbench::bench
