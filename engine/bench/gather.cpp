#include "bench/gather.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "base/compensated.h"
#include "rays/pixel_positions.h"

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

// The transmittance of one ray at growing depths: equal to rays::transmittance(), without starting again for each
// depth.
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

// A ray's sample cell in the map.
struct Cell {
    int i, j;
};
Cell cell_of(const LightRays& tile, const MapLayout& layout, std::size_t ray) {
    const int pixel = static_cast<int>(ray / tile.samples), sample = static_cast<int>(ray % tile.samples);
    return {(tile.x0 + pixel % tile.width) * layout.samples_x + sample % layout.samples_x,
            (tile.y0 + pixel / tile.width) * layout.samples_y + sample / layout.samples_x};
}

// The transmittance of the grid volumes along one ray at some depths.
class MediaWalk {
public:
    MediaWalk(const GridsInLight& media, const MapLayout& layout) : media_(media), layout_(layout) {}

    void start(const Cell& cell, std::span<const double> depths) {  // ascending
        if (media_.grids.empty()) return;
        const rays::SamplePosition place = rays::sample_position(layout_, cell.i, cell.j);
        optical_depth_.resize(depths.size());
        media_.grids.optical_depths(media_.view, place.x, place.y, rays::sample_time(layout_, cell.i, cell.j), depths,
                                    optical_depth_);
    }
    double transmittance(std::size_t depth, int channel) const {
        return media_.grids.empty() ? 1.0 : std::exp(-optical_depth_[depth][channel]);
    }

private:
    const GridsInLight& media_;
    const MapLayout& layout_;
    std::vector<base::Vec3d> optical_depth_;
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

std::vector<std::vector<Part>> parts_by_tile(const MapLayout& layout, std::span<const Query> queries) {
    std::vector<std::vector<Part>> parts(static_cast<std::size_t>(layout.tiles()));
    for (std::size_t q = 0; q < queries.size(); ++q) {
        const FilterBox f = filter_box(queries[q], layout);
        for (int ty = f.y0 / layout.tile_height; ty <= f.y1 / layout.tile_height; ++ty)
            for (int tx = f.x0 / layout.tile_width; tx <= f.x1 / layout.tile_width; ++tx)
                parts[static_cast<std::size_t>(ty) * layout.tiles_x() + tx].push_back({q, {}});
    }
    return parts;
}

std::vector<Moments> reduce(const std::vector<std::vector<Part>>& parts, std::size_t queries) {
    std::vector<Moments> total(queries);
    for (const std::vector<Part>& tile : parts)
        for (const Part& part : tile) {
            Moments& sum = total[part.query];
            for (int c = 0; c < 3; ++c) {
                sum.sum[c] += part.moments.sum[c];
                sum.squares[c] += part.moments.squares[c];
            }
            sum.count += part.moments.count;
        }
    return total;
}

void gather_footprints(const LightRays& tile, const MapLayout& layout, std::span<const Query> queries,
                       const GridsInLight& media, std::span<Part> parts) {
    std::vector<FilterBox> footprints;
    footprints.reserve(parts.size());
    for (const Part& part : parts) footprints.push_back(filter_box(queries[part.query], layout));
    const PartsByPixel sorted = sort_parts(tile, footprints, queries, parts);
    RayWalk walk;
    MediaWalk through_media(media, layout);
    std::vector<std::uint32_t> answered;  // parts whose footprint holds the ray, by depth
    std::vector<double> depths;
    std::vector<rays::SamplePosition> positions;  // of the pixel's rays
    for (std::size_t ray = 0; ray < tile.rays(); ++ray) {
        const std::size_t pixel = ray / tile.samples;
        if (sorted.begin[pixel] == sorted.begin[pixel + 1]) continue;
        const std::size_t sample = ray % tile.samples;
        if (sample == 0) {
            const auto across = static_cast<std::size_t>(tile.width);
            rays::pixel_positions(layout, tile.x0 + static_cast<int>(pixel % across),
                                  tile.y0 + static_cast<int>(pixel / across), positions);
        }
        const rays::SamplePosition place = positions[sample];
        answered.clear();
        depths.clear();
        for (std::uint32_t k = sorted.begin[pixel]; k < sorted.begin[pixel + 1]; ++k) {
            const FilterBox& f = footprints[sorted.part[k]];
            if (place.x < f.left || place.x > f.right || place.y < f.low || place.y > f.high) continue;
            answered.push_back(sorted.part[k]);
            depths.push_back(queries[parts[sorted.part[k]].query].z);
        }
        if (answered.empty()) continue;
        walk.start(tile, ray);
        through_media.start(cell_of(tile, layout, ray), depths);
        for (std::size_t k = 0; k < answered.size(); ++k) {
            Moments& moments = parts[answered[k]].moments;
            walk.advance(tile, depths[k]);
            for (int c = 0; c < tile.channels; ++c)
                moments.add(c, walk.transmittance(tile, c, depths[k]) * through_media.transmittance(k, c));
            ++moments.count;
        }
    }
}

void gather_nearest(const LightRays& tile, const MapLayout& layout, std::span<const Query> queries,
                    const GridsInLight& media, std::span<Part> parts) {
    MediaWalk through_media(media, layout);
    for (Part& part : parts) {
        const Query& query = queries[part.query];
        const int i = static_cast<int>(query.x * static_cast<double>(layout.samples_x));
        const int j = static_cast<int>(query.y * static_cast<double>(layout.samples_y));
        const int x = i / layout.samples_x - tile.x0, y = j / layout.samples_y - tile.y0;
        if (x < 0 || x >= tile.width || y < 0 || y >= tile.height) continue;
        const int sample = (j % layout.samples_y) * layout.samples_x + i % layout.samples_x;
        const std::size_t ray = (static_cast<std::size_t>(y) * tile.width + x) * tile.samples + sample;
        const double depth = query.z;
        through_media.start({i, j}, {&depth, 1});
        for (int c = 0; c < tile.channels; ++c)
            part.moments.add(c, rays::transmittance(tile, ray, c, depth) * through_media.transmittance(0, c));
        ++part.moments.count;
    }
}

}  // namespace shadowbench::bench
