#include "rays/light_rays.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "base/random.h"
#include "rays/extended_oracle.h"
#include "rays/pixel_positions.h"

namespace shadowbench::rays {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr float kTiny = std::numeric_limits<float>::denorm_min();

struct Segment {
    float front, back, through;
};

LightRays ray_of(std::vector<Segment> segments) {
    std::sort(segments.begin(), segments.end(),
              [](const Segment& a, const Segment& b) { return std::tie(a.front, a.back) < std::tie(b.front, b.back); });
    LightRays rays;
    rays.width = rays.height = 1;
    rays.begin = {0, static_cast<std::uint32_t>(segments.size())};
    for (const Segment& s : segments) {
        rays.z_front.push_back(s.front);
        rays.z_back.push_back(s.back);
        rays.transmittance.push_back(s.through);
    }
    return rays;
}

// The optical depth, up to z, of the media that contain z, which the header's bound refers to.
double depth_around(const LightRays& rays, double z) {
    double sum = 0.0;
    for (std::size_t s = 0; s < rays.segments(); ++s)
        if (rays.z_front[s] < z && z < rays.z_back[s]) sum += optical_depth(rays, s, 0, z);
    return sum;
}

// Checks the oracle against the bound in its header.
void expect_agreement(const LightRays& rays, double z) {
    const long double expected = testing::extended_transmittance(rays, 0, 0, z);
    const double value = transmittance(rays, 0, 0, z);
    const long double bound = 0x1p-51L * (1.0L + depth_around(rays, z)) * expected + 1e-290L;
    EXPECT_LE(std::abs(value - expected), bound) << "at depth " << z << ": " << value;
}

std::vector<Segment> layers(int count, float through) {
    std::vector<Segment> segments;
    for (int i = 0; i < count; ++i) segments.push_back({static_cast<float>(i), static_cast<float>(i), through});
    return segments;
}

// A plain product of doubles loses a digit for every few layers.
TEST(Transmittance, Of100000FaintLayersKeepsItsLastDigits) {
    const LightRays rays = ray_of(layers(100'000, 1.0f - 1e-4f));
    for (const double z : {1.0, 10.0, 5'000.5, 77'777.0, kInfinity}) expect_agreement(rays, z);
    EXPECT_NEAR(transmittance(rays, 0, 0, kInfinity), std::exp(-10.0), 1e-7) << "1 - 1e-4 as a float";
}

TEST(Transmittance, Of100000LayersThatLetAThousandthThroughFallsToZeroAndNoFurther) {
    const LightRays rays = ray_of(layers(100'000, 0.001f));
    for (int z = 1; z < 120; ++z) expect_agreement(rays, z);
    EXPECT_EQ(transmittance(rays, 0, 0, kInfinity), 0.0);
}

TEST(Transmittance, OfAMillionLayersNextToOneCountsThemAll) {
    const float next = std::nextafter(1.0f, 0.0f);
    const LightRays rays = ray_of(layers(1'000'000, next));
    for (const double z : {1.0, 1000.0, 1e6}) expect_agreement(rays, z);
    EXPECT_NEAR(transmittance(rays, 0, 0, kInfinity), std::exp(1e6 * std::log1p(-0x1p-24)), 1e-12);
}

// Optical depths of 1e-14 are 1 as floats, so nothing remains of them.
TEST(Transmittance, OfAMillionLayersThatAreExactly1InFloatIs1) {
    EXPECT_EQ(transmittance(ray_of(layers(1'000'000, static_cast<float>(std::exp(-1e-14)))), 0, 0, kInfinity), 1.0);
}

// A product of a thousand exponentials adds up their roundings; a sum of optical depths does not.
TEST(Transmittance, InsideManyMediaIsThatOfTheirOpticalDepths) {
    std::vector<Segment> segments;
    for (int i = 0; i < 1000; ++i)
        segments.push_back({-static_cast<float>(i), 3.0f + 0.1f * static_cast<float>(i), 0.99f});
    const LightRays rays = ray_of(segments);
    for (double z = -1001; z < 110; z += 0.37) expect_agreement(rays, z);
}

TEST(Transmittance, OfAdversarialRaysStaysWithinItsBound) {
    base::Random random(1);
    const float throughs[] = {0.0f, kTiny,  1e-40f,       1e-38f,      1e-20f, 0.25f,
                              0.5f, 0.999f, 1.0f - 1e-4f, 0.99999994f, 1.0f};
    const float depths[] = {-1e6f, -3.0f, -kTiny, 0.0f, kTiny, 1e-3f, 1.0f, 1.0000001f, 2.0f, 1e6f, 1e30f};
    for (int round = 0; round < 2000; ++round) {
        std::vector<Segment> segments(random.below(12));
        for (Segment& s : segments) {
            const float a = depths[random.below(11)], b = depths[random.below(11)];
            s = {std::min(a, b), random.below(3) ? std::max(a, b) : std::min(a, b), throughs[random.below(11)]};
        }
        const LightRays rays = ray_of(segments);
        for (const float z : depths) {
            expect_agreement(rays, z);
            expect_agreement(rays, std::nextafter(static_cast<double>(z), kInfinity));
        }
    }
}

TEST(Transmittance, NeverLeavesItsRangeOnRandomRays) {
    base::Random random(2);
    for (int round = 0; round < 300; ++round) {
        std::vector<Segment> segments(1 + random.below(40));
        for (Segment& s : segments) {
            s.front = static_cast<float>(random.uniform(0, 10));
            s.back = random.below(2) ? s.front : s.front + static_cast<float>(random.uniform(0, 5));
            s.through = static_cast<float>(random.uniform());
        }
        const LightRays rays = ray_of(segments);
        for (int i = 0; i < 50; ++i) {
            const double z = random.uniform(-1, 16);
            expect_agreement(rays, z);
            const double value = transmittance(rays, 0, 0, z);
            ASSERT_TRUE(value >= 0.0 && value <= 1.0) << value;
        }
    }
}

// Each ray in its own cell, in a column of its own and in a row of its own, in every pixel.
TEST(SamplePosition, OfMultiJitteredRaysIsStratifiedInXAndInY) {
    for (const int samples : {1, 2, 7, 32, 50, 64, 125, 512}) {
        MapLayout layout;
        layout.width = layout.height = 8;
        layout.jittered = layout.multi_jittered = true;
        set_samples(layout, samples);
        for (layout.seed = 0; layout.seed < 5; ++layout.seed)
            for (int pixel = 0; pixel < 64; pixel += 5) {
                std::vector<int> columns(static_cast<std::size_t>(samples)), rows(columns);
                const int x = pixel % 8, y = pixel / 8;
                std::vector<SamplePosition> together;
                pixel_positions(layout, x, y, together);
                ASSERT_EQ(together.size(), static_cast<std::size_t>(samples));
                for (int j = 0; j < layout.samples_y; ++j)
                    for (int i = 0; i < layout.samples_x; ++i) {
                        const SamplePosition p =
                            sample_position(layout, x * layout.samples_x + i, y * layout.samples_y + j);
                        ASSERT_EQ(std::floor((p.x - x) * layout.samples_x), i);
                        ASSERT_EQ(std::floor((p.y - y) * layout.samples_y), j);
                        ASSERT_EQ(together[static_cast<std::size_t>(j * layout.samples_x + i)].x, p.x);
                        ASSERT_EQ(together[static_cast<std::size_t>(j * layout.samples_x + i)].y, p.y);
                        ++columns.at(static_cast<std::size_t>((p.x - x) * samples));
                        ++rows.at(static_cast<std::size_t>((p.y - y) * samples));
                    }
                ASSERT_EQ(std::count(columns.begin(), columns.end(), 1), samples) << "seed " << layout.seed;
                ASSERT_EQ(std::count(rows.begin(), rows.end(), 1), samples) << "seed " << layout.seed;
            }
    }
}

// Chi-squared over 20 x 20 parts of one cell, of 400,000 seeds: 399 degrees of freedom, 5 standard deviations.
TEST(SamplePosition, OfAMultiJitteredRayIsUniformInItsCell) {
    MapLayout layout;
    layout.width = layout.height = 8;
    layout.jittered = layout.multi_jittered = true;
    set_samples(layout, 20);  // 4 x 5 cells
    std::vector<int> count(400);
    constexpr int seeds = 400000;
    for (layout.seed = 0; layout.seed < seeds; ++layout.seed) {
        const SamplePosition p = sample_position(layout, 4 * 3 + 1, 5 * 2 + 3);
        const int x = static_cast<int>((p.x - 3.25) * 80), y = static_cast<int>((p.y - 2.6) * 100);
        ++count.at(static_cast<std::size_t>(y * 20 + x));
    }
    double chi = 0.0;
    for (const int c : count) chi += (c - seeds / 400.0) * (c - seeds / 400.0) / (seeds / 400.0);
    EXPECT_LT(std::abs(chi - 399), 5 * std::sqrt(2.0 * 399));
}

}  // namespace
}  // namespace shadowbench::rays
