#include <gtest/gtest.h>

#include <cmath>

#include "curves/curve.h"
#include "curves/norms.h"
#include "curves/sweep.h"
#include "techniques/built.h"
#include "techniques/hand_rays.h"

namespace shadowbench::techniques {
namespace {

using testing::build;

const Technique& deep() {
    return find("deep", "");
}

// The largest exact distance between stored functions and the uncompressed functions of the same rays.
double curve_error(const testing::Built& b) {
    double worst = 0.0;
    curves::SweepScratch scratch;
    curves::Curve exact, stored;
    for (const rays::LightRays& tile : b.rays.tiles)
        for (int p = 0; p < tile.width * tile.height; ++p) {
            curves::visibility(tile, static_cast<std::size_t>(p) * tile.samples, tile.samples, 1e-6, scratch, exact);
            b.map->stored(tile.x0 + p % tile.width, tile.y0 + p / tile.width, 0, {}, stored);
            worst = std::max(worst, curves::distance(stored, exact, 0, 4).max);
        }
    return worst;
}

TEST(Deep, KeepsItsToleranceInEveryPixelAndUsesIt) {
    for (const bool media : {false, true})
        for (const double tolerance : {0.0, 0.001, 0.02, 0.1}) {
            const auto b =
                build(deep(), testing::hairy_scene(media), rays::testing::directional(), rays::testing::rays(24, 16),
                      ("{\"tolerance\": " + std::to_string(tolerance) + "}").c_str());
            const double error = curve_error(b);
            EXPECT_LE(error, std::max(tolerance, media ? 1e-6 : 0.0) + 1.1e-6) << "media " << media;
            EXPECT_GE(error, 0.5 * tolerance) << "a tolerance that is not used stores too much";
        }
}

// The bound that the default is measured against must come from the same rays and the same tolerance.
TEST(Deep, OptimalCompressionStoresFewerNodesWithinTheSameTolerance) {
    for (const bool media : {false, true}) {
        const auto map = [&](const char* parameters) {
            return build(deep(), testing::hairy_scene(media), rays::testing::directional(), rays::testing::rays(24, 16),
                         parameters);
        };
        const auto optimal = map(R"({"tolerance": 0.02, "compression": "optimal"})");
        EXPECT_LE(curve_error(optimal), 0.02 + 1.1e-6) << "media " << media;
        EXPECT_LT(optimal.map->nodes().total, map(R"({"tolerance": 0.02})").map->nodes().total) << "media " << media;
    }
}

TEST(Deep, TheNoiseToleranceFollowsTheSamples) {
    const auto layout = [](int samples) {
        rays::MapLayout l;
        rays::set_samples(l, samples);
        return l;
    };
    const ParameterValues values = read_parameters(deep().parameters, nlohmann::json::object(), "");
    EXPECT_DOUBLE_EQ(deep().error_bound(values, layout(16)), 0.0625);
    EXPECT_DOUBLE_EQ(deep().error_bound(values, layout(256)), 0.015625);
}

TEST(Deep, ALookupOfOnePixelIsItsStoredFunction) {
    const auto b = build(deep(), testing::hairy_scene(true), rays::testing::directional(), rays::testing::rays(16, 16));
    curves::Curve stored;
    base::Random random(5);
    for (int i = 0; i < 2000; ++i) {
        const float x = static_cast<float>(random.below(16)) + 0.5f, y = static_cast<float>(random.below(16)) + 0.5f;
        const float z = static_cast<float>(random.uniform(0, 2));
        b.map->stored(static_cast<int>(x), static_cast<int>(y), 0, {}, stored);
        EXPECT_NEAR(b.lookup(x, y, z), curves::evaluate(stored, z), 1e-6f);
        for (const curves::Vertex& v : stored)  // at vertices and steps exactly
            EXPECT_EQ(b.lookup(x, y, v.z), curves::evaluate(stored, v.z));
    }
}

TEST(Deep, AWideLookupAveragesThePixelsOfItsFootprint) {
    const auto b = build(deep(), testing::hairy_scene(true), rays::testing::directional(), rays::testing::rays(16, 16));
    double sum = 0.0;
    for (int y = 6; y < 9; ++y)
        for (int x = 4; x < 7; ++x) sum += b.lookup(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, 1.0f);
    EXPECT_NEAR(b.lookup(5.5f, 7.5f, 1.0f, 3.0f), sum / 9, 1e-6);
}

TEST(Deep, TheTentKernelIsBilinearAtAWidthOfOnePixel) {
    const auto b = build(deep(), testing::hairy_scene(true), rays::testing::directional(), rays::testing::rays(16, 16),
                         R"({"kernel": "tent"})");
    const auto box =
        build(deep(), testing::hairy_scene(true), rays::testing::directional(), rays::testing::rays(16, 16));
    const auto at = [&](float x, float y) { return box.lookup(x, y, 1.0f); };
    const float expected = 0.75f * (0.75f * at(7.5f, 8.5f) + 0.25f * at(8.5f, 8.5f)) +
                           0.25f * (0.75f * at(7.5f, 9.5f) + 0.25f * at(8.5f, 9.5f));
    EXPECT_NEAR(b.lookup(7.75f, 8.75f, 1.0f), expected, 1e-6f);
}

// Between pixel centres a tent narrower than a pixel would see no pixel at all, and light would leak.
TEST(Deep, ATentIsNeverNarrowerThanAPixel) {
    scene::Scene scene;
    scene.objects.push_back(rays::testing::quad({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, 0.75f));
    const auto b =
        build(deep(), scene, rays::testing::directional(), rays::testing::rays(16, 4), R"({"kernel": "tent"})");
    for (const float width : {0.01f, 0.5f, 0.9f})
        for (const float x : {8.0f, 8.2f, 8.5f}) EXPECT_NEAR(b.lookup(x, 8.0f, 5.0f, width), 0.25f, 1e-6f) << width;
}

// Their shares of a pixel's light add up without rounding.
TEST(Deep, TheOrderOfRaysThatMeetSurfacesAloneChangesNoDigit) {
    base::Random random(3);
    for (int i = 0; i < 200; ++i) {
        testing::HandRays given{1, 1, 9, {}};
        for (int r = 0; r < 9; ++r) {
            given.rays.emplace_back();
            for (std::size_t s = random.below(5); s > 0; --s) {
                const auto z = static_cast<float>(1 + random.below(6));
                given.rays.back().push_back({z, z, 0.1f * static_cast<float>(random.below(10))});
            }
        }
        const ParameterValues values = read_parameters(deep().parameters, {{"tolerance", 0.0131}}, "");
        const testing::HandMap one = testing::make_map(deep(), values, given);
        for (std::size_t k = given.rays.size(); k > 1; --k) std::swap(given.rays[k - 1], given.rays[random.below(k)]);
        const testing::HandMap two = testing::make_map(deep(), values, given);
        for (float z = 0.5f; z < 8.0f; z += 0.5f)
            EXPECT_EQ(one({0.5f, 0.5f, z, 1.0f}), two({0.5f, 0.5f, z, 1.0f})) << i << " at " << z;
    }
}

TEST(Deep, EmptyPixelsCostOnlyTheirOffset) {
    scene::Scene scene;
    scene.objects.push_back(rays::testing::quad({-1, -1, 0}, {0.125f, 0, 0}, {0, 0.125f, 0}));  // one pixel of 16 x 16
    const auto b = build(deep(), scene, rays::testing::directional(), rays::testing::rays(16, 16));
    EXPECT_EQ(b.map->bytes(), 4u * 257 + 2 * 8 + 4 * 8) << "offsets, two nodes and the padding";
}

TEST(Deep, GivenFunctionsAreCompressedAsTheyAre) {
    const std::vector<curves::Curve> functions = {{}, {{1, 1}, {1, 0.5f}, {2, 0.5f}, {2, 0}}, {{0, 1}, {10, 0}}};
    const ParameterValues values = read_parameters(deep().parameters, {{"tolerance", 0.01}}, "");
    const auto map = deep().from_curves(values, functions);
    const Query q[] = {{0.5f, 0.5f, 5, 1}, {1.5f, 0.5f, 1.5f, 1}, {1.5f, 0.5f, 2.5f, 1}, {2.5f, 0.5f, 2.5f, 1}};
    float v[4];
    map->lookup(q, v);
    EXPECT_EQ(v[0], 1.0f);
    EXPECT_NEAR(v[1], 0.5f, 0.01);
    EXPECT_NEAR(v[2], 0.0f, 1e-6);
    EXPECT_NEAR(v[3], 0.75f, 0.01);
}

}  // namespace
}  // namespace shadowbench::techniques
