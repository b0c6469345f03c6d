#include "bench/gather.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/random.h"
#include "scene/scene.h"

namespace shadowbench::bench {
namespace {

using rays::LightRays;
using rays::MapLayout;
using techniques::Query;

MapLayout layout_of(int channels) {
    MapLayout layout;
    layout.width = 6;
    layout.height = 5;
    layout.channels = channels;
    layout.jittered = true;
    layout.seed = 3;
    layout.tile_width = 4;
    layout.tile_height = 3;
    rays::set_samples(layout, 6);
    return layout;
}

// The tile at pixel (4, 0), two pixels wide. Rays through random surfaces and media that overlap; some are opaque.
LightRays random_tile(const MapLayout& layout, std::uint64_t seed) {
    LightRays tile;
    tile.tile = 1;
    tile.x0 = 4;
    tile.width = 2;
    tile.height = 3;
    tile.samples = layout.samples();
    tile.channels = layout.channels;
    base::Random random(seed);
    tile.begin.push_back(0);
    for (int ray = 0; ray < tile.width * tile.height * tile.samples; ++ray) {
        std::vector<std::pair<float, float>> ends(random.below(8));
        for (auto& [front, back] : ends) {
            front = static_cast<float>(random.below(12)) * 0.5f;
            back = front + (random.below(2) ? 0.0f : static_cast<float>(random.below(8)) * 0.5f);
        }
        std::sort(ends.begin(), ends.end());
        for (const auto& [front, back] : ends) {
            tile.z_front.push_back(front);
            tile.z_back.push_back(back);
            for (int c = 0; c < tile.channels; ++c)
                tile.transmittance.push_back(random.below(6) ? static_cast<float>(random.uniform()) : 0.0f);
        }
        tile.begin.push_back(static_cast<std::uint32_t>(tile.z_front.size()));
    }
    return tile;
}

// Each ray of the tile for each query, with rays::transmittance() only.
Moments one_by_one(const LightRays& tile, const MapLayout& layout, const Query& query) {
    Moments moments;
    for (std::size_t ray = 0; ray < tile.rays(); ++ray) {
        const int pixel = static_cast<int>(ray) / tile.samples, sample = static_cast<int>(ray) % tile.samples;
        const rays::SamplePosition p =
            rays::sample_position(layout, (tile.x0 + pixel % tile.width) * layout.samples_x + sample % layout.samples_x,
                                  (tile.y0 + pixel / tile.width) * layout.samples_y + sample / layout.samples_x);
        if (std::abs(p.x - query.x) > 0.5 * query.width || std::abs(p.y - query.y) > 0.5 * query.width) continue;
        for (int c = 0; c < tile.channels; ++c) moments.add(c, rays::transmittance(tile, ray, c, query.z));
        ++moments.count;
    }
    return moments;
}

TEST(Gather, agrees_with_the_oracle_at_every_depth_of_each_ray) {
    for (const int channels : {1, 3}) {
        const MapLayout layout = layout_of(channels);
        const rays::GridMedia no_grids(scene::Scene(), true);
        const rays::LightView view;
        const LightRays tile = random_tile(layout, 17);
        base::Random random(5);
        std::vector<Query> queries;
        std::vector<Part> parts;
        for (std::size_t q = 0; q < 300; ++q) {
            // Depths at the ends of segments too, at which surfaces do not shade yet.
            const float z =
                q % 2 ? static_cast<float>(random.uniform(-1, 11)) : static_cast<float>(random.below(20)) * 0.5f;
            queries.push_back({static_cast<float>(random.uniform(3, 6)), static_cast<float>(random.uniform(0, 4)), z,
                               static_cast<float>(random.uniform(0.1, 3))});
            parts.push_back({q, {}});
        }
        gather_footprints(tile, layout, queries, {no_grids, view}, parts);
        std::uint64_t found = 0;
        for (std::size_t q = 0; q < queries.size(); ++q) {
            const Moments expected = one_by_one(tile, layout, queries[q]);
            ASSERT_EQ(parts[q].moments.count, expected.count) << q;
            for (int c = 0; c < channels; ++c) {
                ASSERT_NEAR(parts[q].moments.sum[c], expected.sum[c], 1e-12) << q;
                ASSERT_NEAR(parts[q].moments.squares[c], expected.squares[c], 1e-12) << q;
            }
            found += expected.count;
        }
        EXPECT_GT(found, 1000u);
    }
}

}  // namespace
}  // namespace shadowbench::bench
