#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "techniques/any_rays.h"
#include "techniques/one_ray.h"
#include "techniques/variants.h"

namespace shadowbench::techniques {
namespace {

using testing::OneRay;
using testing::Segment;

double smooth(double t) {
    return t * t * (3 - 2 * t);
}

// A slab from 2 to 8 of the given optical depth, in a map of [0, 16] whose steps end at multiples of 1/32.
OneRay slab(double depth, const char* parameters = "{}") {
    return OneRay("volume_deep", parameters, {{2, 8, static_cast<float>(std::exp(-depth))}}, 0, 16);
}

// Where the slab's opacity is `alpha`.
double crossing(double depth, double alpha) {
    return 2.0 + 6.0 * -std::log(1.0 - alpha) / depth;
}

constexpr double step = 16.0 / 512;

TEST(VolumeDeep, AnEmptyRayIsLit) {
    const OneRay ray("volume_deep", "{}", {}, 0, 16);
    for (const float z : {-1.0f, 0.0f, 5.0f, 16.0f, 1e9f}) EXPECT_EQ(ray(z), 1.0f) << z;
}

TEST(VolumeDeep, AllThresholdsReached) {
    const OneRay ray = slab(4.0);
    const double d10 = crossing(4, 0.1), d50 = crossing(4, 0.5), d90 = crossing(4, 0.9);
    EXPECT_EQ(ray(static_cast<float>(d10 - step)), 1.0f);
    EXPECT_NEAR(ray(static_cast<float>(d10 + step)), 0.9, 0.01) << "the first depth is a step";
    EXPECT_NEAR(ray(static_cast<float>(d50)), 0.5, 0.01);
    EXPECT_NEAR(ray(static_cast<float>(d90 - step)), 0.1, 0.01);
    EXPECT_NEAR(ray(static_cast<float>(d90 + step)), std::exp(-4.0), 1e-6) << "past the last: the maximum, at once";
    EXPECT_NEAR(ray(1e6f), std::exp(-4.0), 1e-6);
}

TEST(VolumeDeep, BetweenDepthsASmoothStepMixesTheOpacities) {
    const OneRay ray = slab(4.0);
    curves::Curve stored;
    ray.map->stored(0, 0, 0, {}, stored);
    ASSERT_EQ(stored.size(), 6u) << "each depth from both sides";
    const double low = stored[0].z, middle = stored[2].z, high = stored[4].z;
    EXPECT_NEAR(low, crossing(4, 0.1), step);
    EXPECT_NEAR(middle, crossing(4, 0.5), step);
    EXPECT_NEAR(high, crossing(4, 0.9), step);
    for (double t = 0.01; t < 1.0; t += 0.01) {
        EXPECT_NEAR(ray(static_cast<float>(low + t * (middle - low))), 1 - (0.1 + 0.4 * smooth(t)), 1e-5) << t;
        EXPECT_NEAR(ray(static_cast<float>(middle + t * (high - middle))), 1 - (0.5 + 0.4 * smooth(t)), 1e-5) << t;
    }
}

TEST(VolumeDeep, TwoThresholdsReached) {
    const OneRay ray = slab(1.5);  // 78 %
    const double most = 1 - std::exp(-1.5), d50 = crossing(1.5, 0.5);
    EXPECT_NEAR(ray(static_cast<float>(d50)), 0.5, 0.01);
    // On to the maximum at the exit, not to a 90 % that never comes.
    EXPECT_NEAR(ray(static_cast<float>((d50 + 8) / 2)), 1 - (0.5 + most) / 2, 0.01);
    EXPECT_NEAR(ray(7.999f), 1 - most, 0.01);
    EXPECT_NEAR(ray(8.001f), 1 - most, 1e-6);
}

TEST(VolumeDeep, OneThresholdReached) {
    const OneRay ray = slab(0.3);  // 26 %
    const double most = 1 - std::exp(-0.3), d10 = crossing(0.3, 0.1);
    EXPECT_EQ(ray(static_cast<float>(d10 - step)), 1.0f);
    EXPECT_NEAR(ray(static_cast<float>(d10 + step)), 0.9, 0.01);
    EXPECT_NEAR(ray(static_cast<float>((d10 + 8) / 2)), 1 - (0.1 + most) / 2, 0.01);
    EXPECT_NEAR(ray(8.001f), 1 - most, 1e-6);
    EXPECT_NEAR(ray(1e9f), 1 - most, 1e-6);
}

TEST(VolumeDeep, NoThresholdReached) {
    const OneRay ray = slab(0.05);  // 5 %
    EXPECT_EQ(ray(0.0f), 1.0f);
    EXPECT_EQ(ray(5.0f), 1.0f) << "lit inside";
    EXPECT_EQ(ray(8.0f), 1.0f);
    EXPECT_NEAR(ray(8.001f), std::exp(-0.05), 1e-6) << "the shadow on what lies behind is not forgotten";
    EXPECT_NEAR(ray(1e9f), std::exp(-0.05), 1e-6);
}

TEST(VolumeDeep, WhatLiesBehindGetsTheMaximumOpacity) {
    for (int seed = 0; seed < 50; ++seed) {
        const OneRay ray("volume_deep", seed % 2 ? "{}" : R"({"interpolation": "bucket", "steps": 7})",
                         testing::random_segments(seed, 1 + seed % 10, 1, 15), 0, 16);
        EXPECT_NEAR(ray(16.001f), ray.exact(17), 1e-6);
        EXPECT_EQ(ray(0), 1.0f);
    }
}

TEST(VolumeDeep, BucketsAreTheLastStepsBeforeTheCrossings) {
    const OneRay ray = slab(4.0, R"({"interpolation": "bucket", "steps": 32})");  // steps end at multiples of 1/2
    curves::Curve stored;
    ray.map->stored(0, 0, 0, {}, stored);
    ASSERT_EQ(stored.size(), 6u);
    EXPECT_EQ(stored[0].z, std::floor(2 * crossing(4, 0.1)) / 2);
    EXPECT_EQ(stored[2].z, std::floor(2 * crossing(4, 0.5)) / 2);
    EXPECT_EQ(stored[4].z, std::floor(2 * crossing(4, 0.9)) / 2);
}

TEST(VolumeDeep, ACrossingInsideAStepIsPlacedBySmoothStep) {
    // One wall inside the only step: opacity goes from 0 to 0.8 there.
    const OneRay ray("volume_deep", R"({"steps": 1})", {{3, 3, 0.2f}}, 0, 16);
    curves::Curve stored;
    ray.map->stored(0, 0, 0, {}, stored);
    ASSERT_EQ(stored.size(), 6u);
    EXPECT_NEAR(stored[0].z, 16 * smooth(0.1 / 0.8), 1e-4);
    EXPECT_NEAR(stored[2].z, 16 * smooth(0.5 / 0.8), 1e-4);
    EXPECT_NEAR(stored[4].z, 16, 1e-4) << "90 % is never reached: the exit";
}

TEST(VolumeDeep, AnOpaqueWallIsBlackBehindItsStep) {
    for (const char* parameters : {"{}", R"({"interpolation": "bucket"})"}) {
        const OneRay ray("volume_deep", parameters, {{5.01f, 5.01f, 0.0f}}, 0, 16);
        EXPECT_EQ(ray(5.0f), 1.0f);
        EXPECT_EQ(ray(5.04f), 0.0f);
        EXPECT_EQ(ray(100.0f), 0.0f);
    }
}

TEST(VolumeDeep, TheStepsAreItsOwn) {
    // The same medium in one segment, and in pieces that do not match the steps.
    std::vector<Segment> pieces;
    for (int i = 0; i < 97; ++i)
        pieces.push_back({2 + 6 * static_cast<float>(i) / 97, 2 + 6 * static_cast<float>(i + 1) / 97,
                          static_cast<float>(std::exp(-4.0 / 97))});
    const OneRay cut("volume_deep", R"({"steps": 40})", pieces, 0, 16), whole = slab(4.0, R"({"steps": 40})");
    for (float z = 0; z < 16; z += 0.1f) EXPECT_NEAR(cut(z), whole(z), 1e-4f) << z;
}

TEST(VolumeDeep, StoredIsWhatLookupsAnswer) {
    for (const double depth : {0.05, 0.3, 1.5, 4.0}) {
        const OneRay ray = slab(depth);
        std::vector<float> depths;
        for (float z = 0.0f; z < 16.0f; z += 0.25f) depths.push_back(z);
        curves::Curve stored;
        ray.map->stored(0, 0, 0, depths, stored);
        EXPECT_TRUE(curves::is_visibility(stored));
        for (const float z : depths) EXPECT_EQ(curves::evaluate(stored, z), ray(z)) << z << " " << depth;
    }
}

TEST(VolumeDeep, ATexelIsFourFloats) {
    EXPECT_EQ(slab(1).map->bytes(), 16u);
}

// If a threshold is never reached, the texel stores the maximum opacity, at a depth of the ray.
RC_GTEST_PROP(VolumeDeep, AThresholdThatIsNeverReachedActsAsTheMaximum, ()) {
    const testing::HandRays given{1, 1, 1, {*testing::any_segments()}};
    const Technique& row = find("volume_deep", "");
    ParameterValues values = testing::defaults(row);
    values.values["steps"] = static_cast<double>(*rc::gen::element(512, 1, 2, 33));
    if (*rc::gen::arbitrary<bool>()) values.values["interpolation"] = std::string("bucket");
    const testing::HandMap built = make_map(row, values, given);
    double through = 1.0;
    for (const Segment& s : given.rays[0]) through *= s.through;
    const float left = built({0.5f, 0.5f, INFINITY, 0.0f}), most = 1.0f - left;
    RC_ASSERT(std::abs(left - through) <= 1e-6);

    curves::Curve stored;
    built.map->stored(0, 0, 0, {}, stored);
    RC_ASSERT(!stored.empty() || left == 1.0f);
    if (stored.empty()) return;
    RC_ASSERT(curves::is_visibility(stored));
    RC_ASSERT(stored.front().value == 1.0f);
    RC_ASSERT(stored.back().value == left);
    RC_ASSERT(stored.front().z >= built.layout.z_min);
    RC_ASSERT(stored.back().z <= built.layout.z_max);
    RC_ASSERT(stored.size() % 2 == 0u);
    if (most < 0.1f) RC_ASSERT(stored.size() == 2u);
    // Before the last depth nothing is darker than the last threshold that was reached.
    for (std::size_t i = 0; i + 1 < stored.size(); ++i)
        RC_ASSERT(stored[i].value >= 1.0f - std::min(most, 0.9f) - 1e-7f);
}

}  // namespace
}  // namespace shadowbench::techniques
