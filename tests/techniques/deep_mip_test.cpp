// Mip-maps of deep shadow maps.
#include <gtest/gtest.h>

#include <cmath>

#include "curves/norms.h"
#include "curves/sweep.h"
#include "techniques/built.h"
#include "techniques/deep/deep_map.h"
#include "techniques/deep/footprint.h"
#include "techniques/deep/mip.h"
#include "techniques/deep/pixel_run.h"

namespace shadowbench::techniques {
namespace {

using rays::testing::capture;
using rays::testing::Captured;
using rays::testing::directional;
using rays::testing::quad;
using testing::build;
using testing::Built;

const Technique& deep() {
    return find("deep", "");
}

scene::RaySettings oblong(int width, int height, int samples) {
    scene::RaySettings settings = rays::testing::rays(width, samples);
    settings.resolution = {width, height};
    return settings;
}

DeepMap make_map(const Captured& rays, float tolerance, bool levels_of_samples = false) {
    DeepMap map;
    map.compression.tolerance = tolerance;
    map.rule.mip = Mip::blend;
    map.levels_of_samples = levels_of_samples;
    map.begin(rays.layout);
    for (const auto& tile : rays.tiles) map.add(tile);
    map.finish();
    return map;
}

// Uncompressed functions of all map pixels in one channel.
std::vector<curves::Curve> exact_functions(const Captured& c, int channel) {
    std::vector<curves::Curve> functions(static_cast<std::size_t>(c.layout.width) * c.layout.height);
    curves::SweepScratch scratch;
    for (const rays::LightRays& tile : c.tiles)
        for (int p = 0; p < tile.width * tile.height; ++p) {
            const int x = tile.x0 + p % tile.width, y = tile.y0 + p / tile.width;
            curves::visibility(tile, static_cast<std::size_t>(p) * tile.samples, tile.samples, 1e-5, scratch,
                               functions[static_cast<std::size_t>(y) * c.layout.width + x], channel);
        }
    return functions;
}

// The mean over the map pixels that pixel (x, y) of a level covers.
curves::Curve exact_mean(const std::vector<curves::Curve>& functions, const rays::MapLayout& layout, int level, int x,
                         int y) {
    const int side = 1 << level;
    std::vector<curves::WeightedCurve> terms;
    for (int py = y * side; py < std::min((y + 1) * side, layout.height); ++py)
        for (int px = x * side; px < std::min((x + 1) * side, layout.width); ++px)
            terms.push_back({functions[static_cast<std::size_t>(py) * layout.width + px], 1.0});
    for (curves::WeightedCurve& t : terms) t.weight = 1.0 / static_cast<double>(terms.size());
    curves::SweepScratch scratch;
    curves::Curve mean;
    curves::weighted_sum(terms, scratch, mean);
    return mean;
}

// Two bands of two runs. If runs stayed until the level is complete, a map would take twice its memory.
TEST(DeepMip, ALevelIsPutTogetherWhileItsRunsAreGivenBack) {
    std::vector<PixelRun> runs(4);
    const std::uint32_t floats = 1000;
    for (std::size_t r = 0; r < runs.size(); ++r) {
        runs[r].x0 = r % 2 ? 2 : 0;
        runs[r].y0 = r / 2 ? 1 : 0;
        runs[r].width = r % 2 ? 1 : 2;
        for (int x = 0; x < runs[r].width; ++x) {
            runs[r].floats.insert(runs[r].floats.end(), floats, static_cast<float>(10 * r) + static_cast<float>(x));
            runs[r].begin.push_back(static_cast<std::uint32_t>(runs[r].floats.size()));
        }
        complete(runs[r]);
        EXPECT_EQ(runs[r].floats.capacity(), runs[r].floats.size());
    }
    std::size_t before = 0, peak = 0;
    for (const PixelRun& run : runs) before += run.bytes();
    const DeepLevel level = assemble(3, 2, 1, runs, peak);
    const float expected[] = {0, 1, 10, 20, 21, 30};
    for (std::size_t p = 0; p < 6; ++p) {
        ASSERT_EQ(level.offsets[p + 1] - level.offsets[p], floats);
        EXPECT_EQ(level.floats[level.offsets[p]], expected[p]);
        EXPECT_EQ(level.floats[level.offsets[p + 1] - 1], expected[p]);
    }
    for (const PixelRun& run : runs) EXPECT_EQ(run.floats.capacity(), 0u);
    EXPECT_GT(peak, before);
    EXPECT_LT(peak, before + level.bytes() * 3 / 5) << "one of two bands is held twice";
}

TEST(DeepMip, SizesGoDownToOnePixel) {
    EXPECT_EQ(mip_levels(1, 1), 1);
    EXPECT_EQ(mip_levels(2, 1), 2);
    EXPECT_EQ(mip_levels(16, 16), 5);
    EXPECT_EQ(mip_levels(17, 3), 6);
    EXPECT_EQ(mip_size(17, 0), 17);
    EXPECT_EQ(mip_size(17, 1), 9);
    EXPECT_EQ(mip_size(17, 4), 2);
    EXPECT_EQ(mip_size(17, 5), 1);
}

// The largest distance of a level's functions from the exact means in one channel.
double worst_error(const DeepMap& map, const Captured& rays, const std::vector<curves::Curve>& functions, int number,
                   int channel) {
    const DeepLevel& level = map.levels[static_cast<std::size_t>(number)];
    curves::Curve stored;
    double worst = 0.0;
    for (int y = 0; y < level.height; ++y)
        for (int x = 0; x < level.width; ++x) {
            read_function(level, level.pixel(x, y), channel, stored);
            EXPECT_TRUE(curves::is_visibility(stored));
            const auto exact = exact_mean(functions, rays.layout, number, x, y);
            worst = std::max(worst, curves::distance(stored, exact, 0, 4).max);
        }
    return worst;
}

// Calls visit(light rays, their uncompressed functions, channel) for grey surfaces and for coloured hair in media.
template <class Visit>
void for_each_channel(const Visit& visit) {
    for (const bool coloured : {false, true})
        for (const auto& [width, height] : {std::pair{16, 16}, {21, 13}}) {
            scene::Scene scene = testing::hairy_scene(coloured);
            if (coloured) scene.objects[0].opacity = base::Vec3f(0.7f, 0.3f, 0.5f);
            const Captured rays = capture(scene, directional(), oblong(width, height, 9));
            for (int c = 0; c < rays.layout.channels; ++c) visit(rays, exact_functions(rays, c), c);
        }
}

TEST(DeepMip, EveryLevelStaysWithinTwiceTheToleranceOfTheExactMean) {
    const float tolerance = 0.04f;
    for_each_channel([&](const Captured& rays, const std::vector<curves::Curve>& functions, int channel) {
        const DeepMap map = make_map(rays, tolerance);
        ASSERT_EQ(map.levels.size(), static_cast<std::size_t>(mip_levels(rays.layout.width, rays.layout.height)));
        for (int l = 0; l < static_cast<int>(map.levels.size()); ++l) {
            const double worst = worst_error(map, rays, functions, l, channel);
            EXPECT_LE(worst, tolerance * (2.0 - std::ldexp(1.0, -l)) + 1.2e-5) << "level " << l << " of " << channel;
            EXPECT_GT(worst, 0.0) << "nothing was compressed";
        }
    });
}

// Nothing accumulates, and level 0 is the same map.
TEST(DeepMip, LevelsOfSamplesEachKeepTheirOwnTolerance) {
    const float tolerance = 0.04f;
    for_each_channel([&](const Captured& rays, const std::vector<curves::Curve>& functions, int channel) {
        const DeepMap map = make_map(rays, tolerance, true), published = make_map(rays, tolerance);
        ASSERT_EQ(map.levels.size(), published.levels.size());
        EXPECT_EQ(map.levels[0].floats, published.levels[0].floats);
        EXPECT_EQ(map.levels[0].offsets, published.levels[0].offsets);
        for (int l = 1; l < static_cast<int>(map.levels.size()); ++l) {
            const double worst = worst_error(map, rays, functions, l, channel);
            const double lines = rays.layout.media ? linearisation_of(tolerance) : 0.0;
            EXPECT_LE(worst, std::ldexp(tolerance, -l) + lines + 1.2e-5) << "level " << l << " of " << channel;
            EXPECT_GT(worst, 0.0) << "nothing was compressed";
        }
    });
}

// Without loss both ways give the exact means.
TEST(DeepMip, LevelsOfSamplesAreThoseOfALosslessMap) {
    const Captured rays = capture(testing::hairy_scene(false), directional(), oblong(21, 13, 9));
    const auto functions = exact_functions(rays, 0);
    for (const bool of_samples : {false, true}) {
        const DeepMap map = make_map(rays, 0.0f, of_samples);
        for (int l = 0; l < static_cast<int>(map.levels.size()); ++l)
            EXPECT_LE(worst_error(map, rays, functions, l, 0), 1e-6 * (l + 1)) << l;
    }
}

// The paper's estimate is 1.55 (section 5.3).
TEST(DeepMip, AllLevelsTakeAboutHalfAsMuchAgainAsTheMap) {
    scene::Scene scene;
    scene.objects.push_back(rays::testing::curly_hair(1500, 12, 0.01f, 4));
    const Captured rays = capture(scene, directional(), rays::testing::rays(64, 16));
    const DeepMap map = make_map(rays, 0.02f);
    const double ratio = static_cast<double>(map.bytes()) / static_cast<double>(map.levels[0].bytes());
    RecordProperty("ratio", std::to_string(ratio));
    EXPECT_GT(ratio, 1.2);
    EXPECT_LT(ratio, 2.0);
}

TEST(DeepMip, PixelsAtOddEdgesWeighAsMuchAsTheyCover) {
    scene::Scene scene;  // three of five columns in shade
    scene.objects.push_back(quad({-1, -1, 0}, {1.2f, 0, 0}, {0, 2, 0}));
    for (const char* parameters :
         {R"({"mip": "blend"})", R"({"mip": "nearest"})", R"({"mip": "nearest", "kernel": "tent"})"}) {
        const Built b = build(deep(), scene, directional(), rays::testing::rays(5, 4), parameters);
        EXPECT_NEAR(b.lookup(2.5f, 2.5f, 5.0f, 1000.0f), 0.4f, 1e-6f) << parameters;
        EXPECT_NEAR(b.lookup(2.5f, 2.5f, b.rays.tiles[0].z_front[0], 1000.0f), 1.0f, 1e-6f);
        EXPECT_EQ(b.lookup(5.5f, 2.5f, 5.0f, 1000.0f), 1.0f) << "outside, though inside the last coarse pixel";
    }
    const Built none = build(deep(), scene, directional(), rays::testing::rays(5, 4));
    const Built blend = build(deep(), scene, directional(), rays::testing::rays(5, 4), R"({"mip": "blend"})");
    for (const float width : {5.0f, 9.0f, 12.0f})
        EXPECT_NEAR(blend.lookup(2.5f, 2.5f, 5.0f, width + 7), none.lookup(2.5f, 2.5f, 5.0f, width + 7), 1e-6f);
}

TEST(DeepMip, NarrowLookupsReadTheMapItself) {
    const auto scene = testing::hairy_scene(true);
    const Built none = build(deep(), scene, directional(), rays::testing::rays(16, 16));
    const Built blend = build(deep(), scene, directional(), rays::testing::rays(16, 16), R"({"mip": "blend"})");
    base::Random random(8);
    for (int i = 0; i < 500; ++i) {
        const float x = static_cast<float>(random.uniform(0, 16)), y = static_cast<float>(random.uniform(0, 16));
        const float z = static_cast<float>(random.uniform(0.3, 1.7)), w = static_cast<float>(random.uniform(0.1, 1.5));
        ASSERT_EQ(blend.lookup(x, y, z, w), none.lookup(x, y, z, w));
    }
}

// A tent at a coarse pixel's centre, one such pixel wide, is that pixel, whole or cut by the map's edge.
TEST(DeepMip, ATentOverOneCoarsePixelIsThatPixel) {
    const Built b = build(deep(), testing::hairy_scene(true), directional(), oblong(21, 13, 4),
                          R"({"mip": "nearest", "kernel": "tent", "tolerance": 0})");
    const Built none =
        build(deep(), testing::hairy_scene(true), directional(), oblong(21, 13, 4), R"({"tolerance": 0})");
    for (int y = 0; y < 13; y += 4)
        for (int x = 0; x < 21; x += 4) {
            if (x + 2 > 21 || y + 2 > 13) continue;  // its centre lies outside
            double sum = 0.0;
            int count = 0;
            for (int py = y; py < std::min(y + 4, 13); ++py)
                for (int px = x; px < std::min(x + 4, 21); ++px, ++count)
                    sum += none.lookup(static_cast<float>(px) + 0.5f, static_cast<float>(py) + 0.5f, 1.0f);
            const float at_x = static_cast<float>(x) + 2.0f, at_y = static_cast<float>(y) + 2.0f;
            ASSERT_NEAR(b.lookup(at_x, at_y, 1.0f, 4.0f), sum / count, 1e-6) << x << " " << y;
        }
    // Near the corner the cut pixels take part: pixel (5, 3) of level 2 covers one map pixel.
    const float corner = none.lookup(20.5f, 12.5f, 1.0f);
    double row = 0.0, column = 0.0, inner = 0.0;
    for (int i = 0; i < 4; ++i) {
        row += none.lookup(16.5f + static_cast<float>(i), 12.5f, 1.0f) / 4;
        column += none.lookup(20.5f, 8.5f + static_cast<float>(i), 1.0f) / 4;
        for (int j = 0; j < 4; ++j)
            inner += none.lookup(16.5f + static_cast<float>(i), 8.5f + static_cast<float>(j), 1.0f) / 16;
    }
    // Centres of the coarse pixels: 18 and 22, 10 and 14; at (20, 12) all are as near, and the edge cuts to a quarter.
    EXPECT_NEAR(b.lookup(20.0f, 12.0f, 1.0f, 4.0f), (inner + 0.25 * (row + column) + 0.0625 * corner) / 1.5625, 1e-6);
}

// A footprint that covers whole pixels of one level is their mean, so the exact one within the error of that level.
TEST(DeepMip, AWideFootprintOnPixelBordersIsTheMeanOfItsPixels) {
    const auto scene = testing::hairy_scene(true);
    const float tolerance = 0.02f;
    const Built mip =
        build(deep(), scene, directional(), rays::testing::rays(32, 4), R"({"mip": "nearest", "tolerance": 0.02})");
    const Built exact = build(deep(), scene, directional(), rays::testing::rays(32, 4), R"({"tolerance": 0})");
    double worst = 0.0;
    for (const float width : {4.0f, 8.0f, 16.0f})  // two pixels of levels 1, 2 and 3
        for (float y = 0.5f * width; y < 32.0f; y += 0.5f * width)
            for (float x = 0.5f * width; x < 32.0f; x += 0.5f * width)
                for (const float z : {0.8f, 1.0f, 1.3f})
                    worst =
                        std::max<double>(worst, std::abs(mip.lookup(x, y, z, width) - exact.lookup(x, y, z, width)));
    EXPECT_LE(worst, 2.0 * tolerance);
    EXPECT_GT(worst, 0.0);
}

// Between pixel borders a box must not snap to whole pixels: it would be off by half a coarse pixel.
TEST(DeepMip, AWideBoxFollowsAnEdgeSmoothly) {
    scene::Scene scene;  // the left half in shade
    scene.objects.push_back(quad({-1, -1, 0}, {1, 0, 0}, {0, 2, 0}));
    for (const char* parameters : {R"({"mip": "nearest"})", R"({"mip": "blend"})"}) {
        const Built b = build(deep(), scene, directional(), rays::testing::rays(64, 1), parameters);
        for (const float width : {12.0f, 16.0f, 20.0f})
            for (float x = 32.0f - width; x <= 32.0f + width; x += 0.25f) {
                const float lit = std::clamp((x + 0.5f * width - 32.0f) / width, 0.0f, 1.0f);
                ASSERT_NEAR(b.lookup(x, 32.0f, 5.0f, width), lit, 0.2f) << width << " at " << x;
            }
    }
}

TEST(DeepMip, BlendedLookupsDoNotJumpWhereLevelsChange) {
    const Built b = build(deep(), testing::hairy_scene(true), directional(), rays::testing::rays(32, 4),
                          R"({"mip": "blend", "kernel": "tent"})");
    base::Random random(6);
    for (const float width : {1.0f, 2.0f, 4.0f, 8.0f, 16.0f, 32.0f})
        for (int i = 0; i < 100; ++i) {
            const float x = static_cast<float>(random.uniform(0, 32)), y = static_cast<float>(random.uniform(0, 32));
            ASSERT_NEAR(b.lookup(x, y, 1.0f, width * 0.9999f), b.lookup(x, y, 1.0f, width * 1.0001f), 1e-3f);
        }
}

TEST(DeepMip, WideLookupsReadAFewPixelsHoweverWide) {
    const DeepMap map = make_map(capture(testing::hairy_scene(false), directional(), oblong(64, 43, 1)), 0.1f);
    base::Random random(9);
    for (const Kernel kernel : {Kernel::box, Kernel::tent, Kernel::pixels})
        for (int i = 0; i < 3000; ++i) {
            const LookupRule rule{kernel, Mip::blend, Search::binary};
            const Query q{static_cast<float>(random.uniform(0, 64)), static_cast<float>(random.uniform(0, 43)), 1.0f,
                          static_cast<float>(std::exp(random.uniform(-1, 6)))};
            const LevelChoice choice = choose_levels(rule, q.width, map.levels.size());
            for (int l = choice.fine; l <= choice.fine + (choice.coarser > 0.0f); ++l) {
                int pixels = 0;
                double weights = 0.0;
                const DeepLevel& level = map.levels[static_cast<std::size_t>(l)];
                for_each_pixel(64, 43, l, kernel, q, [&](int x, int y, double weight) {
                    ASSERT_TRUE(x >= 0 && y >= 0 && x < level.width && y < level.height);
                    ++pixels;
                    weights += weight;
                });
                ASSERT_LE(pixels, l == choice.fine ? 16 : 9) << "level " << l << " width " << q.width;
                ASSERT_GT(weights, 0.0);
            }
        }
}

}  // namespace
}  // namespace shadowbench::techniques
