// Hair projected into a tile against a test of every sample, segment by segment.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <vector>

#include "base/random.h"
#include "rays/hits.h"
#include "rays/project_hair.h"
#include "rays/tile_grid.h"

namespace shadowbench::rays {
namespace {

// Tile (1, 1) of a map whose pixels are not square and whose tiles are not multiples of four cells wide.
TileGrid grid_of(bool perspective, LightView& view) {
    view.perspective = perspective;
    view.z_near = perspective ? 0.01 : -std::numeric_limits<double>::infinity();
    view.lower = {-0.6, -0.5};
    view.pixel = {0.05, 0.08};
    MapLayout layout;
    layout.width = 26;
    layout.height = 22;
    layout.samples_x = 3;
    layout.samples_y = 4;
    layout.jittered = true;
    LightRays tile;
    tile.x0 = 13;
    tile.y0 = 7;
    tile.width = 9;
    tile.height = 5;
    return make_tile_grid(view, layout, tile, false);
}

using Hit = std::tuple<std::uint32_t, float>;

template <bool perspective>
std::vector<Hit> projected(const std::vector<HairSegment>& segments, const TileGrid& grid, const LightView& view) {
    const float half = 0.5f;
    SurfaceHits sink;
    HairProjection<perspective, SurfaceHits> projection(grid, view, &half, sink);
    for (const HairSegment& s : segments) projection.project(s);
    projection.finish();
    std::vector<Hit> hits;
    for (const auto& hit : sink.hits) hits.emplace_back(hit.ray, hit.z);
    return hits;
}

template <bool perspective>
std::vector<Hit> every_sample(const std::vector<HairSegment>& segments, const TileGrid& grid, double z_near) {
    std::vector<Hit> hits;
    for (const HairSegment& s : segments)
        for (int j = 0; j < grid.ny; ++j)
            for (int i = 0; i < grid.nx; ++i) {
                const std::size_t sample = static_cast<std::size_t>(j) * grid.nx + i;
                const double z = hair_depth(s, RayMetric<perspective>(grid.x[sample], grid.y[sample]));
                if (z > z_near) hits.emplace_back(grid.ray_row[j] + grid.ray_column[i], static_cast<float>(z));
            }
    return hits;
}

// Short and long, thin and wide, along rows and columns, without length, and around the light.
std::vector<HairSegment> segments_of(bool perspective, std::uint64_t seed) {
    base::Random random(seed);
    const auto place = [&](double z, double reach) {
        const double scale = perspective ? std::abs(z) : 1.0;
        return base::Vec3f(static_cast<float>(scale * random.uniform(-reach, reach)),
                           static_cast<float>(scale * random.uniform(-reach, reach)), static_cast<float>(z));
    };
    std::vector<HairSegment> segments;
    for (int n = 0; n < 400; ++n) {
        const double length = std::pow(10.0, random.uniform(-4.0, 0.3)),
                     radius = std::pow(10.0, random.uniform(-4, -0.7));
        const double z = n % 50 == 49 ? random.uniform(-0.05, 0.1) : random.uniform(0.5, 4.0);
        const base::Vec3f a = place(z, n % 10 == 9 ? 30.0 : 0.5);
        base::Vec3f b = a + place(z, length);
        b.z = static_cast<float>(z + random.uniform(-1.0, 1.0) * length * std::min(1.0, z));
        if (n % 5 == 1) b.x = a.x;
        if (n % 5 == 2) b.y = a.y;
        if (n % 25 == 3) b = a;
        const float thick = static_cast<float>(perspective ? radius * std::abs(z) : radius);
        segments.push_back({a, b, thick, n % 3 == 0 ? 0.0f : 0.6f * thick, n % 4 == 0});
    }
    return segments;
}

template <bool perspective>
void expect_no_sample_lost() {
    LightView view;
    const TileGrid grid = grid_of(perspective, view);
    std::size_t hits = 0;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const std::vector<HairSegment> segments = segments_of(perspective, seed);
        const std::vector<Hit> expected = every_sample<perspective>(segments, grid, view.z_near);
        EXPECT_EQ(projected<perspective>(segments, grid, view), expected) << seed;
        hits += expected.size();
    }
    EXPECT_GT(hits, 4000u);
}

// A strip that is too narrow, or a row that is read beyond its end, loses crossings or finds them twice.
TEST(HairProjection, FindsExactlyWhatATestOfEverySampleFinds) {
    expect_no_sample_lost<false>();
    expect_no_sample_lost<true>();
}

// Without the strip, a segment would cost a test of every sample in its box.
TEST(HairProjection, PassesOverTilesAndSamplesBesideTheStrip) {
    LightView view;
    const TileGrid grid = grid_of(false, view);
    // From the tile's last corner.
    const double x = grid.plane_x + grid.nx / grid.per_cell_x, y = grid.plane_y + grid.ny / grid.per_cell_y;
    const auto segment = [&](double ax, double ay, double bx, double by) {
        return HairSegment{{static_cast<float>(x + ax), static_cast<float>(y + ay), 1.0f},
                           {static_cast<float>(x + bx), static_cast<float>(y + by), 1.0f},
                           0.001f,
                           0.001f,
                           false};
    };
    HairStrip strip;
    EXPECT_FALSE(find_strip<false>(segment(0.1, -0.1, 0.2, -0.1), grid, view, strip)) << "beside";
    EXPECT_FALSE(find_strip<false>(segment(-0.1, 0.1, -0.1, 0.2), grid, view, strip)) << "above";
    EXPECT_FALSE(find_strip<false>(segment(0.3, -0.1, -0.1, 0.3), grid, view, strip)) << "past the corner";
    ASSERT_TRUE(find_strip<false>(segment(-0.2, -0.2, -0.1, -0.1), grid, view, strip));
    EXPECT_LT(strip.reach, 0.1) << "cells";
}

}  // namespace
}  // namespace shadowbench::rays
