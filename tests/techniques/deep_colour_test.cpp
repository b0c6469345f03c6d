// Three channels in one deep shadow map.
#include <gtest/gtest.h>

#include "curves/norms.h"
#include "curves/sweep.h"
#include "techniques/built.h"
#include "techniques/deep/deep_map.h"

namespace shadowbench::techniques {
namespace {

using rays::testing::directional;
using rays::testing::quad;
using testing::build;
using testing::Built;

const Technique& deep() {
    return find("deep", "");
}

scene::Scene coloured_hair(bool media) {
    scene::Scene scene = testing::hairy_scene(media);
    scene.objects[0].opacity = base::Vec3f(0.7f, 0.4f, 0.5f);
    return scene;
}

// The same rays in three equal channels.
rays::LightRays in_three_channels(const rays::LightRays& tile) {
    rays::LightRays three = tile;
    three.channels = 3;
    three.transmittance.clear();
    for (const float t : tile.transmittance) three.transmittance.insert(three.transmittance.end(), 3, t);
    return three;
}

TEST(DeepColour, AGreySceneStoresOneChannelInEveryPixel) {
    for (const bool media : {false, true})
        for (const char* parameters : {"{}", R"({"filter": "tent", "radius": 1.0, "mip": "blend"})"}) {
            const Built grey =
                build(deep(), testing::hairy_scene(media), directional(), rays::testing::rays(24, 16), parameters);
            rays::MapLayout layout = grey.rays.layout;
            layout.channels = 3;
            const auto map = deep().create(grey.values);
            map->begin({layout, grey.rays.view, nullptr, 0});
            for (const auto& tile : grey.rays.tiles) map->add(in_three_channels(tile));
            map->finish();
            ASSERT_EQ(map->channels(), 3);
            const bool mip = std::string(parameters) != "{}";
            // 24 x 24 pixels are 9 words of flags, 12 x 12 are 3, and the levels of 6, 3, 2 and 1 pixels one each.
            EXPECT_EQ(map->bytes(), grey.map->bytes() + 8 * (mip ? 9 + 3 + 1 + 1 + 1 + 1 : 9));
            EXPECT_EQ(map->nodes().histogram, grey.map->nodes().histogram);
            base::Random random(3);
            for (int i = 0; i < 500; ++i) {
                const Query q{static_cast<float>(random.uniform(0, 24)), static_cast<float>(random.uniform(0, 24)),
                              static_cast<float>(random.uniform(0, 2)), static_cast<float>(random.uniform(0.5, 9))};
                float one, three[3];
                grey.map->lookup({&q, 1}, {&one, 1});
                map->lookup({&q, 1}, three);
                for (const float v : three) ASSERT_EQ(v, one);
            }
        }
}

TEST(DeepColour, ASceneOfOneChannelStoresNoColour) {
    const Built b = build(deep(), testing::hairy_scene(false), directional(), rays::testing::rays(24, 16));
    EXPECT_EQ(b.map->channels(), 1);
    EXPECT_EQ(b.map->bytes(), 4 * (24 * 24 + 1) + 8 * b.map->nodes().total + 4 * DeepLevel::padding);
}

TEST(DeepColour, EveryChannelStaysWithinTheTolerance) {
    for (const bool media : {false, true})
        for (const double tolerance : {0.0, 0.02, 0.1}) {
            const Built b = build(deep(), coloured_hair(media), directional(), rays::testing::rays(24, 16),
                                  ("{\"tolerance\": " + std::to_string(tolerance) + "}").c_str());
            ASSERT_EQ(b.rays.layout.channels, 3);
            curves::SweepScratch scratch;
            curves::Curve exact, stored;
            for (int c = 0; c < 3; ++c) {
                double worst = 0.0;
                for (const rays::LightRays& tile : b.rays.tiles)
                    for (int p = 0; p < tile.width * tile.height; ++p) {
                        curves::visibility(tile, static_cast<std::size_t>(p) * tile.samples, tile.samples, 1e-6,
                                           scratch, exact, c);
                        b.map->stored(tile.x0 + p % tile.width, tile.y0 + p / tile.width, c, {}, stored);
                        ASSERT_TRUE(curves::is_visibility(stored));
                        worst = std::max(worst, curves::distance(stored, exact, 0, 4).max);
                    }
                EXPECT_LE(worst, std::max(tolerance, media ? 1e-6 : 0.0) + 1.1e-6) << "channel " << c;
                EXPECT_GE(worst, 0.4 * tolerance) << "channel " << c;
            }
        }
}

// Four floats per node instead of two; a node that any channel needs is a node of all (the paper's section 5.2).
TEST(DeepColour, ThreeChannelsTakeAboutTwiceTheBytesOfOne) {
    const Built grey = build(deep(), testing::hairy_scene(false, 0.55f), directional(), rays::testing::rays(64, 16));
    const Built coloured = build(deep(), coloured_hair(false), directional(), rays::testing::rays(64, 16));
    const auto floats = [](const Built& b) { return static_cast<double>(b.map->bytes()) - 4 * (64 * 64 + 1); };
    const double ratio = floats(coloured) / floats(grey);
    RecordProperty("ratio", std::to_string(ratio));
    EXPECT_GT(ratio, 1.6);
    EXPECT_LT(ratio, 2.6);
}

TEST(DeepColour, OnlyPixelsThatSeeColourHoldIt) {
    scene::Scene scene;
    scene.objects.push_back(quad({-1, -1, 0}, {1, 0, 0}, {0, 2, 0}));
    scene.objects.back().opacity = base::Vec3f(0.25f, 0.5f, 1.0f);
    scene.objects.push_back(quad({0, -1, 0}, {0.5f, 0, 0}, {0, 2, 0}, 0.5f));
    const Built b = build(deep(), scene, directional(), rays::testing::rays(16, 4));
    // 8 columns of 2 nodes and 4 floats, 4 columns of 2 nodes and 2 floats, 4 empty ones; 256 flags.
    EXPECT_EQ(b.map->bytes(), 4 * 257 + 4 * (16 * (8 * 2 * 4 + 4 * 2 * 2) + 8) + 32u);
    for (const auto& [x, c, lit] : {std::tuple{4.5f, 0, 0.75f},
                                    {4.5f, 1, 0.5f},
                                    {4.5f, 2, 0.0f},
                                    {9.5f, 2, 0.5f},
                                    {9.5f, 0, 0.5f},
                                    {14.5f, 1, 1.0f}})
        EXPECT_NEAR(b.lookup(x, 8.5f, 5.0f, 1.0f, c), lit, 1e-6f) << x << " channel " << c;
    EXPECT_NEAR(b.lookup(8.0f, 8.5f, 5.0f, 2.0f, 0), 0.625f, 1e-6f) << "over both";
    EXPECT_EQ(b.lookup(-1.0f, 8.5f, 5.0f, 1.0f, 2), 1.0f) << "outside";
}

// Rays may differ in colour although their sums do not.
TEST(DeepColour, ColourThatNoDepthShowsIsNotStored) {
    scene::Scene scene;
    scene.objects.push_back(quad({-2, -2, 0.5f}, {4, 0, 0}, {0, 4, 0}));
    scene.objects.push_back(quad({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}));
    scene.objects.back().opacity = base::Vec3f(0.25f, 0.5f, 1.0f);
    const Built b = build(deep(), scene, directional(), rays::testing::rays(8, 4));
    EXPECT_EQ(b.map->bytes(), 4 * 65 + 4 * (64 * 2 * 2 + 8) + 8u) << "two nodes a pixel, of one channel";
}

TEST(DeepColour, AnswersLieChannelAfterChannel) {
    const Built b = build(deep(), coloured_hair(true), directional(), rays::testing::rays(16, 16));
    base::Random random(4);
    std::vector<Query> queries;
    for (int i = 0; i < 300; ++i)
        queries.push_back({static_cast<float>(random.uniform(-1, 17)), static_cast<float>(random.uniform(-1, 17)),
                           static_cast<float>(random.uniform(0.3, 1.7)),
                           i % 2 ? 0.0f : 3.0f});  // 0 asks the nearest pixel
    std::vector<float> answers(3 * queries.size());
    b.map->lookup(queries, answers);
    curves::Curve stored;
    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t i = 0; i < queries.size(); ++i) {
            const Query& q = queries[i];
            ASSERT_EQ(answers[c * queries.size() + i], b.lookup(q.x, q.y, q.z, q.width, static_cast<int>(c)));
            if (q.width > 1.0f || !(q.x >= 0 && q.y >= 0 && q.x < 16 && q.y < 16)) continue;
            b.map->stored(static_cast<int>(q.x), static_cast<int>(q.y), static_cast<int>(c), {}, stored);
            ASSERT_EQ(answers[c * queries.size() + i], curves::evaluate(stored, q.z));
        }
}

// Features that a scene does not use cost nothing, from the rays to the map.
TEST(DeepColour, AnOpaqueStillWhiteSceneStoresNoColourNoTimeNoVolume) {
    scene::Scene scene;
    scene.objects.push_back(quad({-1, -1, 0}, {1, 0, 0}, {0, 2, 0}));
    const Built b = build(deep(), scene, directional(), rays::testing::rays(16, 4));
    EXPECT_EQ(b.rays.layout.channels, 1);
    EXPECT_FALSE(b.rays.layout.moving);
    EXPECT_FALSE(b.rays.layout.media);
    std::size_t segments = 0;
    for (const rays::LightRays& tile : b.rays.tiles) {
        segments += tile.segments();
        EXPECT_EQ(tile.transmittance.size(), tile.segments()) << "one channel";
        EXPECT_EQ(tile.z_back.capacity(), 0u) << "no extents";
        EXPECT_EQ(tile.submission.capacity(), 0u);
    }
    EXPECT_EQ(segments, 16u * 8 * 4);
    // An offset a pixel and one more, two floats a node, and the padding: nothing else.
    const std::size_t nodes = b.map->nodes().total;
    EXPECT_EQ(nodes, 16u * 8 * 2) << "a step a covered pixel";
    EXPECT_EQ(b.map->bytes(),
              (16u * 16 + 1) * sizeof(std::uint32_t) + (2 * nodes + DeepLevel::padding) * sizeof(float));
}

}  // namespace
}  // namespace shadowbench::techniques
