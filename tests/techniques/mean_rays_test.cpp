// The mean of a pixel's rays as one ray, against the mean of their transmittances in double.
#include "techniques/mean_rays.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/random.h"
#include "rays/light_rays.h"
#include "techniques/hand_rays.h"

namespace shadowbench::techniques {
namespace {

using testing::HandRays;
using testing::light_rays;
using testing::Segments;

// Surfaces and, where `media`, slabs that may overlap; some rays are empty, some end at something opaque.
Segments any_ray(base::Random& random, bool media) {
    Segments segments;
    const int count = static_cast<int>(random.below(6));
    for (int i = 0; i < count; ++i) {
        const float front = static_cast<float>(random.uniform(0.0, 10.0));
        const bool slab = media && random.below(2) == 0;
        const float back = slab ? front + static_cast<float>(random.uniform(0.1, 4.0)) : front;
        const float through = random.below(8) == 0 ? 0.0f : static_cast<float>(random.uniform(0.05, 1.0));
        segments.push_back({front, back, through});
    }
    return segments;
}

HandRays any_pixels(std::uint64_t seed, bool media, int samples) {
    base::Random random(seed);
    HandRays given{.width = 3, .height = 2, .samples = samples, .rays = {}};
    for (int i = 0; i < 6 * samples; ++i) given.rays.push_back(any_ray(random, media));
    return given;
}

double mean_at(const rays::LightRays& tile, std::size_t pixel, double z) {
    double sum = 0.0;
    for (std::size_t ray = pixel * tile.samples; ray < (pixel + 1) * tile.samples; ++ray)
        sum += rays::transmittance(tile, ray, 0, z);
    return sum / tile.samples;
}

double worst_error(const rays::LightRays& tile, const rays::LightRays& means) {
    double worst = 0.0;
    for (std::size_t pixel = 0; pixel < means.rays(); ++pixel)
        for (double z = -0.5; z < 15.0; z += 0.00625)
            worst = std::max(worst, std::abs(rays::transmittance(means, pixel, 0, z) - mean_at(tile, pixel, z)));
    return worst;
}

TEST(MeanRays, OfSurfacesAreExactToTheRoundingOfTheirSegments) {
    MeanRays means;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        const rays::LightRays tile = light_rays(any_pixels(seed, false, 9));
        EXPECT_LT(worst_error(tile, means.of(tile)), 40 * 0x1p-24) << seed;
    }
}

TEST(MeanRays, OfMediaErrByTheirLinearisation) {
    MeanRays means;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        const rays::LightRays tile = light_rays(any_pixels(seed, true, 4));
        EXPECT_LT(worst_error(tile, means.of(tile)), 1e-4 + 1e-5) << seed;
    }
}

// What an opaque wall at different depths lets through falls by steps, and all of it ends at the last one.
TEST(MeanRays, OfWallsAtDifferentDepthsAreStairs) {
    const rays::LightRays tile =
        light_rays({.width = 1,
                    .height = 1,
                    .samples = 4,
                    .rays = {{{1, 1, 0}}, {{2, 2, 0}}, {{2, 2, 0.5f}, {5, 5, 0}}, {{4, 4, 0}}}});
    MeanRays means;
    const rays::LightRays& mean = means.of(tile);
    ASSERT_EQ(mean.rays(), 1u);
    EXPECT_EQ(mean.z_front, (std::vector<float>{1, 2, 4, 5}));
    EXPECT_EQ(mean.z_back, mean.z_front);
    EXPECT_EQ(rays::transmittance(mean, 0, 0, 1.5), 0.75);
    EXPECT_NEAR(rays::transmittance(mean, 0, 0, 3), 0.375, 1e-7);
    EXPECT_NEAR(rays::transmittance(mean, 0, 0, 4.5), 0.125, 1e-7);
    EXPECT_EQ(rays::transmittance(mean, 0, 0, 6), 0.0);
}

TEST(MeanRays, KeepThePixelsOfTheirTileAndEmptyOnesStayEmpty) {
    rays::LightRays tile = light_rays({.width = 2, .height = 1, .samples = 2, .rays = {{}, {}, {{1, 1, 0.5f}}, {}}});
    tile.tile = 3;
    tile.x0 = 4;
    tile.y0 = 5;
    MeanRays means;
    const rays::LightRays& mean = means.of(tile);
    EXPECT_EQ(mean.tile, 3);
    EXPECT_EQ(mean.x0, 4);
    EXPECT_EQ(mean.y0, 5);
    EXPECT_EQ(mean.samples, 1);
    EXPECT_EQ(mean.begin, (std::vector<std::uint32_t>{0, 0, 1}));
    EXPECT_EQ(mean.transmittance, std::vector<float>{0.75f});
}

}  // namespace
}  // namespace shadowbench::techniques
