#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
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

TEST(Pcf, SamplesOutsideTheMapAreLit) {
    const auto b = build(find("pcf", ""), half_wall(), directional(), rays::testing::rays(64, 1),
                         R"({"num_samples": 256, "res_factor": 1, "min_size": 0})");
    double sum = 0.0;
    for (int i = 0; i < 64; ++i) sum += b.lookup(0.001f, 8.0f + 0.7f * static_cast<float>(i), 10.0f, 8.0f);
    EXPECT_NEAR(sum / 64, 0.5, 0.01) << "the left half of each region lies before the map's border";
}

TEST(Pcf, AGivenRegionTakesThePlaceOfTheWidthAskedFor) {
    const auto given = build(find("pcf", ""), half_wall(), directional(), rays::testing::rays(64, 1),
                             R"({"num_samples": 64, "res_factor": 1, "min_size": 0, "region": 8})");
    const auto asked = build(find("pcf", ""), half_wall(), directional(), rays::testing::rays(64, 1),
                             R"({"num_samples": 64, "res_factor": 1, "min_size": 0})");
    for (float x = 25.0f; x < 39.0f; x += 0.37f)
        EXPECT_EQ(given.lookup(x, 32.0f, 10.0f, 0.5f), asked.lookup(x, 32.0f, 10.0f, 8.0f)) << x;
}

// The mean visibility of lookups `offset` pixels behind the edge of the wall, over this footprint.
double over_footprint(const testing::Built& b, const Footprint& footprint, float offset) {
    std::vector<Query> queries;
    for (int i = 0; i < 256; ++i)
        queries.push_back({32.0f + offset, 15.0f + 0.13f * static_cast<float>(i), 10.0f, 1.0f});
    const std::vector<Footprint> footprints(queries.size(), footprint);
    std::vector<float> visibility(queries.size());
    b.map->lookup_shaped(queries, footprints, visibility);
    double sum = 0.0;
    for (const float v : visibility) sum += v;
    return sum / static_cast<double>(queries.size());
}

TEST(Pcf, ThePixelOfAReceiverIsFilteredInItsBoxOrInItsShape) {
    const char* box = R"({"num_samples": 256, "res_factor": 1, "min_size": 0, "region": "pixel"})";
    const char* shape =
        R"({"num_samples": 256, "res_factor": 1, "min_size": 0, "region": "pixel", "placement": "shape"})";
    const auto in_box = build(find("pcf", ""), half_wall(), directional(), rays::testing::rays(64, 16), box);
    const auto in_shape = build(find("pcf", ""), half_wall(), directional(), rays::testing::rays(64, 16), shape);
    const Footprint diamond{4, 4, 4, -4};  // x = 4 (a + b), a and b uniform in [-1/2, 1/2]
    for (const double offset : {-3.0, -1.0, 0.0, 2.0}) {
        EXPECT_NEAR(over_footprint(in_box, diamond, static_cast<float>(offset)), 0.5 + offset / 8, 0.01) << offset;
        const double u = 1.0 - std::abs(offset) / 4, tail = 0.5 * u * u;  // of a triangular distribution
        EXPECT_NEAR(over_footprint(in_shape, diamond, static_cast<float>(offset)), offset < 0 ? tail : 1 - tail, 0.01)
            << offset;
    }
}

TEST(Pcf, AnUnknownPixelIsTheSquareOfTheWidthAskedFor) {
    const auto pixel =
        build(find("pcf", ""), half_wall(), directional(), rays::testing::rays(64, 1), R"({"region": "pixel"})");
    const auto query = build(find("pcf", ""), half_wall(), directional(), rays::testing::rays(64, 1));
    const std::vector<Query> queries{{31.0f, 20.0f, 10.0f, 4.0f}, {33.0f, 21.0f, 10.0f, 2.0f}, {32.5f, 9.0f, 9.0f, 3}};
    const std::vector<Footprint> unknown(3), known(3, Footprint{9, 0, 0, 9});
    std::vector<float> a(3), b(3), c(3);
    pixel.map->lookup_shaped(queries, unknown, a);
    query.map->lookup_shaped(queries, known, b);
    query.map->lookup(queries, c);
    EXPECT_EQ(a, c);
    EXPECT_EQ(b, c) << "a filter over the query's width ignores the pixel";
}

TEST(Pcf, PointsBehindTheLightAreLit) {
    const auto b = build(find("pcf", ""), half_wall(), directional(), rays::testing::rays(16, 1));
    EXPECT_EQ(b.lookup(2.5f, 8.5f, -1.0f), 1.0f);
}

TEST(Pcf, ABiasRangeThatEndsBeforeItBeginsIsRefused) {
    scene::Scene scene;
    scene.objects.push_back(rays::testing::quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}));
    const auto with = [&](const char* parameters) {
        return testing::build(find("pcf", ""), scene, rays::testing::directional(), rays::testing::rays(8, 1),
                              parameters);
    };
    EXPECT_NO_THROW(with(R"({"bias0": 0.1, "bias1": 0.1})"));
    EXPECT_THROW(with(R"({"bias0": 0.1})"), base::Error);
}

}  // namespace
}  // namespace shadowbench::techniques
