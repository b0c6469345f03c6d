#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "techniques/fourier/series.h"
#include "techniques/one_ray.h"

namespace shadowbench::techniques {
namespace {

using testing::OneRay;
using testing::Segment;

constexpr double pi = std::numbers::pi;

// The published formulas as they stand, for depths in [0, 1]: sums over the places of the absorption, of which a medium
// has very many.
double brute_force(const std::vector<Segment>& segments, int terms, double opaque_depth, double d) {
    const auto integral_of = [&](double at) {  // of the series of a unit of absorption at one place
        double sum = d;                        // a_0 / 2 d, a_0 = 2
        for (int k = 1; k < terms; ++k) {
            const double w = 2.0 * pi * k;
            sum += 2.0 * std::cos(w * at) * std::sin(w * d) / w + 2.0 * std::sin(w * at) * (1.0 - std::cos(w * d)) / w;
        }
        return sum;
    };
    double sum = 0.0;
    for (const Segment& s : segments) {
        const double absorption = s.through > 0 ? std::min(-std::log(double{s.through}), opaque_depth) : opaque_depth;
        const int places = s.front == s.back ? 1 : 400;
        for (int i = 0; i < places; ++i)
            sum += absorption / places *
                   integral_of(s.front + (static_cast<double>(s.back) - s.front) * (i + 0.5) / places);
    }
    return std::exp(-sum);
}

TEST(Fourier, HarmonicsKeepTheirDigits) {
    Harmonics cosines, sines;
    for (double x = -7.0; x < 7.0; x += 0.0137) {
        harmonics(x, most_terms, cosines, sines);
        for (int k = 0; k < most_terms; ++k) {
            EXPECT_NEAR(cosines[k], std::cos(k * x), 2e-13) << k << " " << x;
            EXPECT_NEAR(sines[k], std::sin(k * x), 2e-13) << k << " " << x;
        }
    }
}

TEST(Fourier, LookupsAreTheTruncatedSeries) {
    for (const int terms : {1, 7, 16, 64})
        for (int seed = 0; seed < 3; ++seed) {
            const auto segments = testing::random_segments(seed, 12, 0, 1);
            const OneRay ray("fourier", ("{\"range\": \"raw\", \"terms\": " + std::to_string(terms) + "}").c_str(),
                             segments, 0, 1);
            for (double d = 0.0; d <= 1.0; d += 0.0625) {
                const double expected = brute_force(segments, terms, 5.545, d);
                EXPECT_NEAR(ray(static_cast<float>(d)), expected, 1e-5 * std::max(expected, 1.0)) << terms << " " << d;
            }
        }
}

TEST(Fourier, DepthIsNormalisedBetweenTheBoundsOfTheMap) {
    const auto segments = testing::random_segments(5, 12, 0, 1);
    auto moved = segments;
    for (Segment& s : moved) {
        s.front = 16.0f + 8.0f * s.front;
        s.back = 16.0f + 8.0f * s.back;
    }
    const OneRay a("fourier", "{}", segments, 0, 1), b("fourier", "{}", moved, 16, 24);
    for (float d = -0.5f; d < 1.5f; d += 0.0625f) EXPECT_NEAR(a(d), b(16.0f + 8.0f * d), 1e-5f) << d;
}

TEST(Fourier, AVeryThinSegmentIsASurface) {
    const OneRay thin("fourier", "{}", {{0.5f, std::nextafter(0.5f, 1.0f), 0.3f}}, 0, 1);
    const OneRay surface("fourier", "{}", {{0.5f, 0.5f, 0.3f}}, 0, 1);
    for (float d = 0.0f; d <= 1.0f; d += 0.01f) EXPECT_NEAR(thin(d), surface(d), 1e-5f) << d;
}

TEST(Fourier, AMediumThroughoutNeedsOneTermAlone) {
    for (const int terms : {1, 16}) {
        const OneRay ray("fourier", ("{\"terms\": " + std::to_string(terms) + "}").c_str(), {{0, 1, 0.1f}}, 0, 1);
        for (float d = 0.0f; d <= 1.0f; d += 0.05f) EXPECT_NEAR(ray(d), std::pow(0.1, d), 1e-6) << d;
    }
}

TEST(Fourier, BehindEverythingTheTransmittanceIsExact) {
    for (int seed = 0; seed < 50; ++seed) {
        const OneRay ray("fourier", "{}", testing::random_segments(seed, 20, 1, 31), 0, 32);
        EXPECT_NEAR(ray(32), ray.exact(32), 1e-5);
        EXPECT_NEAR(ray(1e9f), ray.exact(1e9), 1e-5);
        EXPECT_EQ(ray(0), 1.0f);
        EXPECT_EQ(ray(-1), 1.0f);
    }
}

TEST(Fourier, AStepRingsOnBothSides) {
    const std::vector<Segment> wall = {{0.5f, 0.5f, 0.1f}};
    const OneRay raw("fourier", R"({"range": "raw"})", wall, 0, 1), clamped("fourier", "{}", wall, 0, 1);
    float highest = 0.0f, lowest = 1.0f, highest_clamped = 0.0f;
    int rises = 0;
    for (float d = 0.0f; d < 1.0f; d += 0.001f) {
        highest = std::max(highest, raw(d));
        lowest = std::min(lowest, raw(d));
        highest_clamped = std::max(highest_clamped, clamped(d));
        EXPECT_EQ(clamped(d), std::min(raw(d), 1.0f));
        rises += raw(d + 0.001f) > raw(d) + 1e-4f;
    }
    // The sum of a step's series overshoots it by 0.0895 of its height (Wilbraham 1848, Gibbs 1899): here optical
    // depth.
    const double height = -std::log(0.1);
    EXPECT_NEAR(std::log(highest), 0.0895 * height, 0.01 * height);
    EXPECT_NEAR(-std::log(lowest), 1.0895 * height, 0.01 * height);
    EXPECT_EQ(highest_clamped, 1.0f);
    EXPECT_GT(rises, 100) << "it is not monotone, and does not promise to be";
}

TEST(Fourier, ASlabConvergesWithTheTerms) {
    double before = 1e9;
    for (const int terms : {2, 4, 8, 16, 32, 64}) {
        const OneRay ray("fourier", ("{\"terms\": " + std::to_string(terms) + "}").c_str(), {{0.3f, 0.7f, 0.2f}}, 0, 1);
        double sum = 0.0;
        for (double d = 0.0; d < 1.0; d += 0.001) {
            const double error = ray(static_cast<float>(d)) - ray.exact(d);
            sum += error * error;
        }
        const double error = std::sqrt(sum / 1000);
        EXPECT_LT(error, 0.7 * before) << terms;
        before = error;
    }
    EXPECT_LT(before, 1e-3);
}

TEST(Fourier, WhatIsOpaqueHasTheGivenAbsorption) {
    const OneRay ray("fourier", R"({"opaque_depth": 3})", {{0.4f, 0.4f, 0.0f}}, 0, 1);
    EXPECT_NEAR(ray(1), std::exp(-3.0), 1e-6);
}

TEST(Fourier, RawPromisesNoRange) {
    const Technique& row = find("fourier", "");
    const auto with = [&](const char* parameters) {
        return promises(row, read_parameters(row.parameters, nlohmann::json::parse(parameters), ""));
    };
    EXPECT_TRUE(with(R"({"range": "clamped"})").unit_range);
    EXPECT_FALSE(with(R"({"range": "raw"})").unit_range);
    EXPECT_FALSE(with("{}").monotone);
    EXPECT_NEAR(with(R"({"opaque_depth": 3})").leak, std::exp(-3.0), 1e-12);
    EXPECT_NEAR(row.promises.leak, with("{}").leak, 1e-12) << "the row says what its defaults promise";
    EXPECT_NEAR(find("opacity", "").promises.leak, with("{}").leak, 1e-12);
}

TEST(Fourier, RawAnswersStayFinite) {
    // Thousands of opaque walls: the series swings by more than a float's exponent holds.
    std::vector<Segment> walls(4000, {0.5f, 0.5f, 0.0f});
    const OneRay ray("fourier", R"({"range": "raw", "opaque_depth": 80})", walls, 0, 1);
    float highest = 0.0f;
    for (float d = 0.0f; d < 1.0f; d += 0.001f) {
        EXPECT_TRUE(std::isfinite(ray(d))) << d;
        highest = std::max(highest, ray(d));
    }
    EXPECT_GT(highest, 1e20f);
}

TEST(Fourier, StoredIsWhatLookupsAnswer) {
    const OneRay ray("fourier", "{}", testing::random_segments(3, 12, 5, 25), 0, 32);
    const std::vector<float> depths = {-1.0f, 4.0f, 5.5f, 9.1f, 15.0f, 24.9f, 40.0f};
    curves::Curve stored;
    ray.map->stored(0, 0, 0, depths, stored);
    for (const float z : depths) EXPECT_EQ(curves::evaluate(stored, z), ray(z)) << z;
}

TEST(Fourier, SixteenTermsTakeThe128BytesOfTheComparison) {
    const OneRay ray("fourier", "{}", {}, 0, 1);
    EXPECT_EQ(ray.map->bytes(), 128u) << "Salvi et al. 2010, table 1: 8 MB at 256^2";
}

}  // namespace
}  // namespace shadowbench::techniques
