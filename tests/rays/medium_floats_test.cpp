#include "rays/medium_floats.h"

#include <gtest/gtest.h>

#include "base/random.h"
#include "rays/light_rays.h"

namespace shadowbench::rays {
namespace {

TEST(StepRounding, AMillionStepsTooFaintForAFloatKeepTheirLight) {
    // Each of them rounds to 1, or to one of two floats that are a fifth too dark or too bright.
    for (const double depth : {1e-8, 2.9e-8, 7e-8, 1e-7, 3.3e-6}) {
        StepRounding rounding;
        long double left = 1.0L;
        for (int i = 0; i < 1'000'000; ++i) left *= rounding.transmittance(0, depth);
        EXPECT_NEAR(static_cast<double>(left / std::exp(-1e6L * depth)), 1.0, 1e-7) << depth;
    }
}

TEST(StepRounding, IsNeverFartherOffThanOneRounding) {
    base::Random random(5);
    StepRounding rounding;
    long double left[2] = {1.0L, 1.0L}, depth[2] = {0.0L, 0.0L};
    for (int i = 0; i < 20'000; ++i)
        for (const int c : {0, 1}) {
            const double step = std::pow(10.0, random.uniform(-12.0, -2.5));
            depth[c] += step;
            const float t = rounding.transmittance(c, step);
            EXPECT_LE(t, 1.0f);
            left[c] *= t;
            ASSERT_NEAR(static_cast<double>(left[c] * std::exp(depth[c])), 1.0, 1e-7) << i << ", channel " << c;
        }
}

// One ray with the parts that a segment is cut into.
LightRays cut(float front, float back, double depth, const base::Vec3f& extinction) {
    LightRays rays;
    rays.channels = 3;
    cut_where_dark(front, back, depth, extinction, [&](float from, float to, const float* t) {
        EXPECT_LT(from, to);
        rays.z_front.push_back(from);
        rays.z_back.push_back(to);
        rays.transmittance.insert(rays.transmittance.end(), t, t + 3);
    });
    rays.begin = {0, static_cast<std::uint32_t>(rays.z_front.size())};
    return rays;
}

TEST(CutWhereDark, KeepsTheExtinction) {
    // As one segment that transmits 0, half of this light would be left where exp(-50) is.
    const base::Vec3f extinction(1.0f, 0.01f, 0.0f);
    for (const double depth : {80.1, 87.0, 1e3, 9e3, 1e4, 1e6}) {
        const LightRays rays = cut(1.0f, 1.5f, depth, extinction);
        for (const double share : {1e-6, 1e-5, 1e-4, 1e-3, 0.01, 0.1, 0.5, 0.9, 0.999, 1.0}) {
            const double z = 1.0 + 0.5 * share;
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(transmittance(rays, 0, c, z), std::exp(-depth * extinction[c] * share), 1e-6)
                    << depth << " at " << share << ", channel " << c;
        }
    }
}

TEST(CutWhereDark, FitsIntoOneFloat) {
    const float back = next_depth(1.0f);
    for (const double depth : {81.0, 1e4, 1e30}) {
        const LightRays rays = cut(1.0f, back, depth, base::Vec3f(1.0f, 0.5f, 0.25f));
        EXPECT_LE(rays.z_back.back(), back);
        for (int c = 0; c < 3; ++c) {
            EXPECT_EQ(transmittance(rays, 0, c, 1.0), 1.0);
            EXPECT_LT(transmittance(rays, 0, c, back), 1e-8);
        }
    }
}

}  // namespace
}  // namespace shadowbench::rays
