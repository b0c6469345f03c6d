// Media at the limits of floats, on the committed scenarios, compared with closed forms in long double.
#include <gtest/gtest.h>

#include <cmath>

#include "bench/hard_case.h"

namespace shadowbench::bench {
namespace {

using base::Vec3d;
using techniques::Query;

// Map positions with one ray each: a technique stores the function of a known ray there.
const std::vector<std::string> one_ray = {"rays.samples_per_pixel=1", "rays.pattern=regular"};

TEST(HardMedia, AThickStepDarkensAsFastAsItsExponential) {
    const HardCase hard("thick_step");
    const double top = rays::to_light(hard.view(), {0, 0, 0}).z;
    std::vector<Query> queries;
    std::vector<long double> expected;
    for (const double below : {-0.02, 0.0, 1e-6, 1e-5, 3e-5, 1e-4, 2e-4, 5e-4, 1e-3, 8e-3, 0.01, 0.5, 0.999, 1.2}) {
        queries.push_back(hard.at({-0.5, -below, 0.1}));
        expected.push_back(std::exp(-1e4L * std::clamp(static_cast<double>(queries.back().z) - top, 0.0, 1.0)));
    }
    // The step begins at a depth of float, half of its last digit beside the box: x exp(-x) is at most 1 / e.
    const float front = static_cast<float>(top);
    hard.expect(queries, expected, 2e-6 + 1e4 * 0.5 * (std::nextafter(front, 1.0f) - front) / std::exp(1.0));
}

TEST(HardMedia, AThickBallDoesSoWhereRaysEnterIt) {
    const HardCase hard("thick_step", one_ray);
    std::vector<Query> queries;
    std::vector<long double> expected;
    for (const int i : {10, 11, 12, 13}) {
        const double x = (i + 0.5) / 8 - 1, y = 0.0625;  // of the ray, in the world
        const double half = std::sqrt(0.25 - (x - 0.5) * (x - 0.5) - y * y);
        for (const double inside : {-0.01, 1e-5, 1e-4, 3e-4, 1e-3, 0.1, 0.9}) {
            Query q = hard.at({x, -0.5 + half - inside, y}, 1e-6f);
            queries.push_back(q);
            const double front = rays::to_light(hard.view(), {x, -0.5 + half, y}).z;
            expected.push_back(std::exp(-1e4L * std::clamp(static_cast<double>(q.z) - front, 0.0, 2 * half)));
        }
    }
    hard.expect_of_techniques(queries, expected,
                              2e-4);  // a depth of 0.5 has floats 6e-8 apart: 3e-4 of this extinction
}

TEST(HardMedia, AMillionFaintStepsTakeAHundredth) {
    const HardCase hard("million_steps");
    std::vector<Query> queries;
    std::vector<long double> expected;
    for (const double below : {-0.1, 1e-4, 0.032, 0.0641, 0.3, 0.5, 0.7777, 1.0, 1.02399, 1.2}) {
        queries.push_back(hard.at({0, 0.512 - below, 0}));
        const double top = rays::to_light(hard.view(), {0, 0.512, 0}).z;
        expected.push_back(std::exp(-0.01L * std::clamp(static_cast<double>(queries.back().z) - top, 0.0, 1.024)));
    }
    hard.expect(queries, expected);
}

TEST(HardMedia, BoxesThinnerThanAFloatTakeTheirLight) {
    const HardCase hard("thin");
    std::vector<Query> queries;
    std::vector<long double> expected;
    for (const double x : {-0.8, -0.2, 0.2, 0.8})
        for (const double y : {0.3, 0.249, 0.22}) {
            queries.push_back(hard.at({x, y, -0.7}));
            expected.push_back(y > 0.25 ? 1.0L : std::exp(-1.0L));
        }
    hard.expect(queries, expected);
}

TEST(HardMedia, ALightInsideAMediumBeginsAtItsNearPlane) {
    std::vector<std::string> small = one_ray;
    small.push_back("rays.resolution=4");
    const HardCase hard("light_inside", small);
    std::vector<Query> queries;
    std::vector<long double> expected;
    for (const float x : {0.5f, 2.5f, 3.5f})  // y is 1.5: no ray runs through the edge that two triangles share
        for (const float z : {0.0005f, 0.001f, 0.0011f, 0.01f, 0.3f, 0.8f, 0.99f, 1.3f, 1.4999f, 1.6f, 1.999f, 2.5f}) {
            const long double length = rays::length_per_depth(hard.view(), x, 1.5);
            const auto passed = [&](long double end) {
                return length * std::max(std::min<long double>(z, end) - 1e-3L, 0.0L);
            };
            queries.push_back({x, 1.5f, z, 1e-6f});
            expected.push_back(std::exp(-passed(1 / length) - 0.25L * passed(2)) * (z > 1.5f ? 0.5L : 1.0L));
        }
    hard.expect_of_techniques(queries, expected);
}

TEST(HardMedia, AWideConePassesMediaAtTheLengthOfItsRays) {
    const HardCase hard("wide_cone", one_ray);
    std::vector<Query> queries;
    std::vector<long double> expected;
    for (const float at : {16.5f, 18.5f, 24.5f, 29.5f, 31.5f})  // on the diagonal, without spheres
        for (const float z : {0.5f, 1.0f, 1.001f, 1.1f, 1.5f, 2.0f, 2.9f, 3.1f, 50.0f}) {
            const long double length = rays::length_per_depth(hard.view(), at, at);
            queries.push_back({at, at, z, 1e-6f});
            expected.push_back(std::exp(-0.5L * length * (std::clamp(z, 1.0f, 2.0f) - 1.0f)) *
                               (z > 3.0f ? 0.5L : 1.0L));
        }
    EXPECT_GT(rays::length_per_depth(hard.view(), 31.5, 31.5), 15.0);
    hard.expect_of_techniques(queries, expected);
}

TEST(HardMedia, ChannelsOfOneMediumStaySeparate) {
    const HardCase hard("colour_split");
    const double top = rays::to_light(hard.view(), {0, 0, 0}).z;
    std::vector<Query> queries;
    std::vector<long double> expected[3];
    for (const double x : {-0.5, 0.5})
        for (const double below : {-0.05, 1e-5, 1e-4, 1e-3, 0.1, 0.25, 0.4999, 0.7, 0.8, 1.0}) {
            queries.push_back(hard.at({x, -below, -0.5}));
            const long double passed = std::clamp(static_cast<double>(queries.back().z) - top, 0.0, 0.5);
            const bool behind = x < 0 && below > 0.75;
            expected[0].push_back(std::exp(-1e4L * passed));
            expected[1].push_back(std::exp(-0.5L * passed) * (behind ? 0.5L : 1.0L));
            expected[2].push_back(behind ? 0.0L : 1.0L);
        }
    std::vector<long double> all;
    for (const auto& channel : expected) all.insert(all.end(), channel.begin(), channel.end());
    hard.expect(queries, all, 2e-4);  // red: floats at this depth are 6e-8 apart
}

}  // namespace
}  // namespace shadowbench::bench
