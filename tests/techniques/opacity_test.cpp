#include <gtest/gtest.h>

#include <cmath>

#include "curves/norms.h"
#include "curves/sweep.h"
#include "techniques/built.h"
#include "techniques/one_ray.h"

namespace shadowbench::techniques {
namespace {

using testing::OneRay;
using testing::Segment;

TEST(Opacity, AtEverySliceTheTransmittanceIsExact) {
    for (int seed = 0; seed < 100; ++seed) {
        // Slices stand at the whole numbers.
        const OneRay ray("opacity", "{}", testing::random_segments(seed, 20, 1, 31), 0, 32);
        for (int slice = 0; slice <= 32; ++slice) {
            const auto z = static_cast<float>(slice);
            EXPECT_NEAR(ray(z), ray.exact(z), 1e-6) << "slice " << slice << " seed " << seed;
        }
        EXPECT_NEAR(ray(1e6f), ray.exact(1e6), 1e-6);
        EXPECT_EQ(ray(-1.0f), 1.0f);
    }
}

TEST(Opacity, ASurfaceOnASliceIsNotYetFeltThere) {
    const OneRay ray("opacity", "{}", {{16, 16, 0.25f}}, 0, 32);
    EXPECT_EQ(ray(16), 1.0f);
    EXPECT_NEAR(ray(17), 0.25f, 1e-7f);
}

TEST(Opacity, BetweenSlicesTheOpticalDepthIsLinear) {
    const OneRay ray("opacity", "{}", {{16.9f, 16.9f, 0.25f}}, 0, 32);
    EXPECT_NEAR(ray(16.5f), 0.5f, 1e-6f) << "half the optical depth, not half the opacity";
    EXPECT_NEAR(ray(16.25f), std::sqrt(0.5f), 1e-6f);
}

TEST(Opacity, AMediumIsSpreadOverTheSlicesThatItCrosses) {
    for (const auto& [front, back] : {std::pair{3.0f, 29.0f}, {3.3f, 3.6f}, {3.3f, 4.6f}, {3.3f, 28.9f}, {0.0f, 32.0f}})
        for (const float through : {0.9f, 0.01f}) {
            const OneRay ray("opacity", "{}", {{front, back, through}}, 0, 32);
            for (int slice = 0; slice <= 32; ++slice)
                EXPECT_NEAR(ray(static_cast<float>(slice)), ray.exact(slice), 1e-6) << front << " " << back;
        }
}

TEST(Opacity, WhatIsOpaqueHasTheGivenOpticalDepth) {
    const OneRay one("opacity", R"({"opaque_depth": 3})", {{5.5f, 5.5f, 0.0f}}, 0, 32);
    EXPECT_NEAR(one(6), std::exp(-3.0), 1e-6);
    const OneRay two("opacity", R"({"opaque_depth": 3})", {{5.5f, 5.5f, 0.0f}, {7.5f, 9.5f, 1e-20f}}, 0, 32);
    EXPECT_NEAR(two(10), std::exp(-6.0), 1e-6) << "each segment is limited separately";
}

TEST(Opacity, BoundsOfATexelKeepALoneWallExact) {
    const OneRay ray("opacity", R"({"bounds": "texel", "opaque_depth": 20})", {{500.3f, 500.3f, 0.0f}}, 0, 1000);
    EXPECT_EQ(ray(500.3f), 1.0f);
    EXPECT_NEAR(ray(std::nextafter(500.3f, 501.0f)), 0.0f, 1e-6f);
}

TEST(Opacity, BoundsOfATexelFollowWhatIsThere) {
    // All of it lies in one interval of the whole map's slices.
    const auto segments = testing::random_segments(7, 20, 500, 510);
    const OneRay map("opacity", R"({"bounds": "map"})", segments, 0, 1000);
    const OneRay texel("opacity", R"({"bounds": "texel"})", segments, 0, 1000);
    double map_error = 0.0, texel_error = 0.0;
    for (double z = 490; z < 520; z += 0.01) {
        const auto depth = static_cast<float>(z);
        map_error = std::max(map_error, std::abs(map(depth) - map.exact(depth)));
        texel_error = std::max(texel_error, std::abs(texel(depth) - texel.exact(depth)));
    }
    EXPECT_LT(texel_error, 0.5 * map_error);
    EXPECT_NEAR(texel(511), texel.exact(511), 1e-6);
    EXPECT_EQ(texel.map->bytes(), map.map->bytes() + 8);
}

TEST(Opacity, MoreSlicesLeaveLessError) {
    double before = 1e9;
    for (const int slices : {4, 16, 64, 256}) {
        const auto b = testing::build(find("opacity", ""), testing::hairy_scene(true), rays::testing::directional(),
                                      rays::testing::rays(24, 4),
                                      ("{\"cells\": \"sample\", \"slices\": " + std::to_string(slices) + "}").c_str());
        double error = 0.0;
        curves::SweepScratch scratch;
        curves::Curve exact, stored;
        rays::testing::for_each_ray(b.rays, [&](const rays::LightRays& tile, std::size_t ray, int i, int j) {
            curves::visibility(tile, ray, 1, 1e-4, scratch, exact);
            b.map->stored(i, j, 0, {}, stored);
            error += curves::distance(stored, exact, b.rays.layout.z_min, b.rays.layout.z_max).l1;
        });
        EXPECT_LT(error, 0.5 * before) << slices;
        before = error;
    }
}

TEST(Opacity, StoredIsWhatLookupsAnswer) {
    for (const char* parameters : {"{}", R"({"bounds": "texel"})"}) {
        const OneRay ray("opacity", parameters, testing::random_segments(3, 12, 5, 25), 0, 32);
        const std::vector<float> depths = {-1.0f, 4.0f, 5.5f, 9.1f, 15.0f, 24.9f, 40.0f};
        curves::Curve stored;
        ray.map->stored(0, 0, 0, depths, stored);
        ASSERT_GT(stored.size(), 32u);
        for (const float z : depths) EXPECT_EQ(curves::evaluate(stored, z), ray(z)) << z;
    }
}

TEST(Opacity, ThirtyTwoSlicesTakeThe128BytesOfTheComparison) {
    const OneRay ray("opacity", "{}", {}, 0, 1);
    EXPECT_EQ(ray.map->bytes(), 128u) << "Salvi et al. 2010, table 1: 8 MB at 256^2";
}

}  // namespace
}  // namespace shadowbench::techniques
