#include <gtest/gtest.h>

#include <cmath>

#include "techniques/built.h"

namespace shadowbench::techniques {
namespace {

using rays::testing::directional;
using rays::testing::quad;
using testing::build;

// A wall over the left half of the map.
scene::Scene half_wall() {
    scene::Scene scene;
    scene.objects.push_back(quad({-1, -1, 0}, {1, 0, 0}, {0, 2, 0}));
    return scene;
}

TEST(ShadowMap, TheBiasIsAddedToStoredDepths) {
    const auto b =
        build(find("shadow_map", ""), half_wall(), directional(), rays::testing::rays(16, 1), R"({"bias": 0.5})");
    const float z = b.rays.tiles[0].z_front[0];
    EXPECT_EQ(b.lookup(2.5f, 8.5f, z + 0.49f), 1.0f);
    EXPECT_EQ(b.lookup(2.5f, 8.5f, z + 0.51f), 0.0f);
}

TEST(ShadowMap, KeepsEverySampleOrOnlyTheMiddleOne) {
    const auto all = build(find("shadow_map", ""), half_wall(), directional(), rays::testing::rays(16, 16));
    const auto one = build(find("shadow_map", ""), half_wall(), directional(), rays::testing::rays(16, 16),
                           R"({"cells": "centre"})");
    EXPECT_EQ(all.map->bytes(), 16u * 16 * 16 * 4);
    EXPECT_EQ(one.map->bytes(), 16u * 16 * 4);
    EXPECT_EQ(one.lookup(2.5f, 8.5f, 10.0f), 0.0f);
    EXPECT_EQ(one.lookup(12.5f, 8.5f, 10.0f), 1.0f);
}

TEST(Pcf, AnEdgeIsFilteredToItsCoverage) {
    // The expected value of a lookup is the share of its region that the wall covers: no shift to either side.
    const auto b = build(find("pcf", ""), half_wall(), directional(), rays::testing::rays(64, 16),
                         R"({"num_samples": 256, "res_factor": 1, "min_size": 0})");
    for (const float offset : {-1.5f, -0.5f, 0.0f, 0.25f, 1.0f}) {
        double sum = 0.0;
        for (int i = 0; i < 64; ++i) sum += b.lookup(32.0f + offset, 8.0f + 0.7f * static_cast<float>(i), 10.0f, 4.0f);
        EXPECT_NEAR(sum / 64, 0.5 + offset / 4.0, 0.01) << offset;
    }
}

TEST(Pcf, TheRegionIsWidenedByResFactorAndNeverSmallerThanMinSize) {
    const auto narrow = build(find("pcf", ""), half_wall(), directional(), rays::testing::rays(64, 1),
                              R"({"num_samples": 64, "res_factor": 1, "min_size": 0})");
    const auto wide = build(find("pcf", ""), half_wall(), directional(), rays::testing::rays(64, 1),
                            R"({"num_samples": 64, "res_factor": 3, "min_size": 0})");
    const auto floored = build(find("pcf", ""), half_wall(), directional(), rays::testing::rays(64, 1),
                               R"({"num_samples": 64, "res_factor": 1, "min_size": 6})");
    // 4 cells left of the edge: outside of a half-size of 2, inside of one of 6.
    EXPECT_EQ(narrow.lookup(28.0f, 32.0f, 10.0f, 4.0f), 0.0f);
    EXPECT_GT(wide.lookup(28.0f, 32.0f, 10.0f, 4.0f), 0.05f);
    EXPECT_GT(floored.lookup(28.0f, 32.0f, 10.0f, 4.0f), 0.05f);
}

TEST(Pcf, TheBiasIsDrawnBetweenItsEnds) {
    const auto b = build(find("pcf", ""), half_wall(), directional(), rays::testing::rays(64, 1),
                         R"({"num_samples": 256, "bias0": 0.2, "bias1": 0.6})");
    const float z = b.rays.tiles[0].z_front[0];
    const auto mean = [&](float dz) {
        double sum = 0.0;
        for (int i = 0; i < 32; ++i) sum += b.lookup(15.0f + 0.1f * static_cast<float>(i), 20.0f, z + dz, 4.0f);
        return sum / 32;
    };
    EXPECT_EQ(mean(0.19f), 1.0);
    EXPECT_NEAR(mean(0.3f), 0.75, 0.02);
    EXPECT_NEAR(mean(0.5f), 0.25, 0.02);
    EXPECT_EQ(mean(0.61f), 0.0);
}

TEST(Pcf, PointsBehindTheLightAreLit) {
    const auto b = build(find("pcf", ""), half_wall(), directional(), rays::testing::rays(16, 1));
    EXPECT_EQ(b.lookup(2.5f, 8.5f, -1.0f), 1.0f);
}

}  // namespace
}  // namespace shadowbench::techniques
