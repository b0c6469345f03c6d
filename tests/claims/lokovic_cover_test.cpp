#include "claims/lokovic_cover.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"

namespace shadowbench::claims::lokovic {
namespace {

TEST(Cover, TheShareOfASquareIsThatOfItsCells) {
    const Cover cover = fur(128, 3);
    base::Random random(5);
    for (int i = 0; i < 200; ++i) {
        const double width = random.uniform(0.1, 9.0), x = random.uniform(0.0, 128.0), y = random.uniform(0.0, 128.0);
        double covered = 0.0, area = 0.0;
        for (int cy = 0; cy < 128; ++cy)
            for (int cx = 0; cx < 128; ++cx) {
                const auto overlap = [&](double centre, double cell) {
                    return std::max(0.0,
                                    std::min(centre + 0.5 * width, cell + 1.0) - std::max(centre - 0.5 * width, cell));
                };
                const double part = overlap(x, cx) * overlap(y, cy);
                area += part;
                covered += cover.at(cx, cy) ? part : 0.0;
            }
        EXPECT_NEAR(cover.share(x, y, width), covered / area, 1e-9);
    }
}

TEST(Cover, FurCoversHalf) {
    EXPECT_NEAR(fur(256, 1).share(128.0, 128.0, 256.0), 0.5, 0.001);
}

TEST(Cover, ASilhouetteLiesInTheMiddle) {
    const Cover cover = silhouette(64);
    EXPECT_TRUE(cover.at(20.5, 31.9));
    EXPECT_FALSE(cover.at(20.5, 32.1));
    EXPECT_NEAR(cover.share(20.0, 33.0, 8.0), 3.0 / 8.0, 1e-12);
}

// The mean square of independent errors has a relative standard error of sqrt((kurtosis - 1) / lookups), below
// sqrt(5 / lookups) here.
constexpr int lookups = 8000;
const double slack = 4.0 * 0.5 * std::sqrt(5.0 / lookups);

// Section 2: n parts of the region are crossed, each with a sample that is lit with the same uniform probability u. The
// variance is n u (1 - u) / N^2; its mean over u is n / (6 N^2).
TEST(Cover, TheErrorAtASilhouetteIsThatOfTheClosedForm) {
    const Cover cover = silhouette(256);
    for (const int samples : {4, 16, 144, 400}) {
        const double expected = std::pow(samples, -0.75) / std::sqrt(6.0);
        EXPECT_NEAR(filtering_error(cover, 128, samples, lookups, 7), expected, slack * expected) << samples;
    }
}

// All N samples are lit with the same uniform probability u: the mean of u (1 - u) / N is 1 / (6 N).
TEST(Cover, UnstratifiedSamplesErrMoreAtASilhouette) {
    const Cover cover = silhouette(256);
    for (const int samples : {4, 144}) {
        const double expected = 1.0 / std::sqrt(6.0 * samples);
        EXPECT_NEAR(filtering_error(cover, 128, samples, lookups, 7, "uniform"), expected, slack * expected) << samples;
    }
}

// Each sample is lit with probability 1/2: the variance is 1 / (4 N). Parts of the region have hardly more or less than
// half of their area covered, which lowers it by a few per cent.
TEST(Cover, TheErrorInFurIsThatOfTheClosedForm) {
    const Cover cover = fur(1024, 1);
    for (const int samples : {16, 144, 1024, 2500}) {
        const double expected = 0.5 / std::sqrt(samples), error = filtering_error(cover, 512, samples, lookups, 7);
        EXPECT_LT(error, (1.0 + slack) * expected) << samples;
        EXPECT_GT(error, (0.93 - slack) * expected) << samples;
    }
}

// A deep map filters the depths of its pixels beforehand: 10 pixels of 250 samples are 2,500 samples, but for those of
// pixels at the border of the square, which count in part.
TEST(Cover, ADeepMapHasTheErrorOfAllItsSamples) {
    double squares = 0.0;
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
        const double error = deep_error(fur(2048, seed), 250, 10.0, 2000, seed);
        squares += error * error / 8.0;
    }
    EXPECT_GT(std::sqrt(squares), 0.007);
    EXPECT_LT(std::sqrt(squares), 0.0105);
}

}  // namespace
}  // namespace shadowbench::claims::lokovic
