#include "curves/sweep.h"

#include <gtest/gtest.h>

#include "cases.h"

namespace shadowbench::curves {
namespace {

using cases::make_rays;
using cases::Segment;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Curve visibility_of(const rays::LightRays& rays, double linearisation = 1e-4) {
    SweepScratch scratch;
    Curve out{{9, 9}};  // existing vertices are replaced
    visibility(rays, 0, rays.rays(), linearisation, scratch, out);
    return out;
}

Curve sum_of(const std::vector<WeightedCurve>& terms) {
    SweepScratch scratch;
    Curve out{{9, 9}};
    weighted_sum(terms, scratch, out);
    return out;
}

double direct_sum(const std::vector<WeightedCurve>& terms, double z, bool behind) {
    long double sum = 0.0;
    for (const WeightedCurve& term : terms)
        sum += static_cast<long double>(term.weight) * cases::exact(term.curve, z, behind);
    return static_cast<double>(sum);
}

std::vector<std::vector<Segment>> hair(base::Random& random, int rays, int hits, double opacity) {
    std::vector<std::vector<Segment>> segments;
    for (int i = 0; i < rays; ++i)
        segments.push_back(cases::random_surfaces(random, static_cast<int>(random.below(hits + 1)), 5, 15, opacity));
    return segments;
}

TEST(Visibility, NothingHitMeansLitEverywhere) {
    EXPECT_TRUE(visibility_of(make_rays({{}, {}}, false)).empty());
    EXPECT_TRUE(visibility_of(make_rays({{}, {}}, true)).empty());
    EXPECT_TRUE(visibility_of(make_rays({{{1, 1, 1.0f}}}, false)).empty()) << "a surface that absorbs nothing";
    EXPECT_TRUE(visibility_of(make_rays({}, false)).empty());
}

TEST(Visibility, OfSurfacesIsTheMeanOfTheRaysOnBothSidesOfEveryStep) {
    base::Random random(1);
    for (const double opacity : {0.2, 0.9, 1.0})
        for (const int count : {1, 3, 16, 200}) {
            const auto rays = make_rays(hair(random, count, 12, opacity), false);
            const Curve out = visibility_of(rays);
            ASSERT_TRUE(is_visibility(out));
            for (std::size_t s = 0; s < rays.segments(); s += 3)
                for (const bool behind : {false, true})
                    ASSERT_NEAR(cases::exact(out, rays.z_front[s], behind), cases::exact(rays, rays.z_front[s], behind),
                                6e-8);
        }
}

TEST(Visibility, EachStepIsOnePairOfVertices) {
    const Curve out = visibility_of(make_rays({{{1, 1, 0.5f}, {2, 2, 0}}, {{2, 2, 0}, {3, 3, 0.5f}}}, false));
    EXPECT_EQ(out, (Curve{{1, 1}, {1, 0.75f}, {2, 0.75f}, {2, 0}}));
}

// Subtracting weights of 1/255 from 1 in float ends at 1e-6 or below 0, and shadows glow or turn negative.
TEST(Visibility, BehindOpaqueSurfacesIsExactlyZero) {
    base::Random random(2);
    for (const int count : {3, 7, 255, 1000}) {
        std::vector<std::vector<Segment>> segments = hair(random, count, 10, 0.5);
        for (auto& ray : segments) ray.push_back({20, 20, 0.0f});
        EXPECT_EQ(visibility_of(make_rays(segments, false)).back().value, 0.0f);
        EXPECT_EQ(visibility_of(make_rays(segments, true)).back().value, 0.0f);
        segments[0].push_back({1, 30, 0.5f});  // which takes the general path
        EXPECT_EQ(visibility_of(make_rays(segments, true)).back().value, 0.0f);
    }
}

// Sums in the order of the rays would make the map depend on how the rays were captured.
TEST(Visibility, OfSurfacesIsTheSameInEveryOrderOfTheRays) {
    base::Random random(3);
    auto segments = hair(random, 64, 10, 0.7);
    const Curve expected = visibility_of(make_rays(segments, false));
    for (int round = 0; round < 20; ++round) {
        std::swap(segments[random.below(64)], segments[random.below(64)]);
        ASSERT_EQ(visibility_of(make_rays(segments, false)), expected);
    }
}

TEST(Visibility, OfMediaIsTheSameInEveryOrderOfTheRaysUpToRounding) {
    base::Random random(4);
    std::vector<std::vector<Segment>> segments;
    for (int i = 0; i < 20; ++i) segments.push_back(cases::random_media(random, 4, 1, 9));
    const Curve expected = visibility_of(make_rays(segments, true));
    std::reverse(segments.begin(), segments.end());
    const Curve reversed = visibility_of(make_rays(segments, true));
    ASSERT_EQ(reversed.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        ASSERT_EQ(reversed[i].z, expected[i].z);
        ASSERT_NEAR(reversed[i].value, expected[i].value, 6.1e-8);
    }
}

TEST(Visibility, ScalingDepthsByAPowerOfTwoScalesDepthsAlone) {
    base::Random random(5);
    for (const bool media : {false, true}) {
        auto segments = hair(random, 16, 6, 0.7);
        if (media) segments[0] = cases::random_media(random, 5, 5, 15);
        const Curve out = visibility_of(make_rays(segments, media));
        for (auto& ray : segments)
            for (Segment& s : ray) s = {s.front * 1024, s.back * 1024, s.through};
        const Curve scaled = visibility_of(make_rays(segments, media));
        ASSERT_EQ(scaled.size(), out.size());
        for (std::size_t i = 0; i < out.size(); ++i) {
            ASSERT_EQ(scaled[i].z, out[i].z * 1024);
            ASSERT_EQ(scaled[i].value, out[i].value);
        }
    }
}

TEST(Visibility, WithMediaMatchesTheOracleWithinTheLinearisation) {
    base::Random random(6);
    for (int round = 0; round < 15; ++round) {
        auto segments = hair(random, 12, 3, 0.8);
        for (auto& ray : segments)
            for (const Segment& medium : cases::random_media(random, static_cast<int>(random.below(5)), 4, 16))
                ray.push_back(medium);
        const auto rays = make_rays(segments, true);
        for (const double linearisation : {0.05, 0.001}) {
            const Curve out = visibility_of(rays, linearisation);
            ASSERT_TRUE(is_visibility(out));
            for (int i = 0; i < 300; ++i) {
                const double z = random.uniform(3, 17);
                ASSERT_NEAR(cases::exact(out, z), cases::exact(rays, z), linearisation + 1e-6);
            }
        }
    }
}

TEST(Visibility, WithoutLinearisationIsExactAtTheEndsOfSegments) {
    const Curve out = visibility_of(make_rays({{{1, 3, 0.25f}}}, true), kInfinity);
    EXPECT_EQ(out, (Curve{{1, 1}, {3, 0.25f}}));
}

TEST(Visibility, TakesOnlyTheChosenRays) {
    const auto rays = make_rays({{{1, 1, 0}}, {{2, 2, 0.5f}}, {{3, 3, 0}}}, false);
    SweepScratch scratch;
    Curve out;
    visibility(rays, 1, 1, kInfinity, scratch, out);
    EXPECT_EQ(out, (Curve{{2, 1}, {2, 0.5f}}));
    EXPECT_GT(scratch.bytes(), 0u);
}

Curve weighted_visibility(const rays::LightRays& rays, const std::vector<WeightedRay>& chosen, int channel = 0) {
    SweepScratch scratch;
    Curve out{{9, 9}};
    visibility(rays, chosen, 1e-4, scratch, out, channel);
    return out;
}

double weighted_exact(const rays::LightRays& rays, const std::vector<WeightedRay>& chosen, double z, bool behind) {
    if (behind) z = std::nextafter(z, kInfinity);
    double sum = 0.0;
    for (const WeightedRay& r : chosen) sum += r.weight * rays::transmittance(rays, r.ray, 0, z);
    return sum;
}

TEST(Visibility, OfWeightedSurfacesIsTheWeightedMeanOnBothSidesOfEveryStep) {
    base::Random random(9);
    for (const int count : {1, 5, 64, 500}) {
        const auto rays = make_rays(hair(random, count, 12, 0.9), false);
        std::vector<WeightedRay> chosen;
        double total = 0.0;
        for (int i = 0; i < count; ++i)
            if (i % 3 != 1) chosen.push_back({static_cast<std::size_t>(i), std::exp(-8.0 * random.uniform())});
        for (const WeightedRay& r : chosen) total += r.weight;
        for (WeightedRay& r : chosen) r.weight /= total;
        const Curve out = weighted_visibility(rays, chosen);
        ASSERT_TRUE(is_visibility(out));
        for (std::size_t s = 0; s < rays.segments(); s += 2)
            for (const bool behind : {false, true})
                ASSERT_NEAR(cases::exact(out, rays.z_front[s], behind),
                            weighted_exact(rays, chosen, rays.z_front[s], behind), 6.1e-8);
    }
}

// Rounded weights must not leave a glow behind opaque surfaces.
TEST(Visibility, BehindWeightedOpaqueSurfacesIsExactlyZero) {
    base::Random random(10);
    std::vector<std::vector<Segment>> segments = hair(random, 49, 10, 0.5);
    std::vector<WeightedRay> chosen;
    for (std::size_t i = 0; i < segments.size(); ++i) {
        segments[i].push_back({20, 20, 0.0f});
        chosen.push_back({i, (1.0 + static_cast<double>(i)) / 1225.0});
    }
    EXPECT_EQ(weighted_visibility(make_rays(segments, false), chosen).back().value, 0.0f);
    EXPECT_EQ(weighted_visibility(make_rays(segments, true), chosen).back().value, 0.0f);
    segments[0].push_back({1, 30, 0.5f});
    EXPECT_EQ(weighted_visibility(make_rays(segments, true), chosen).back().value, 0.0f);
}

TEST(Visibility, EqualWeightsGiveThePlainMean) {
    base::Random random(11);
    const auto rays = make_rays(hair(random, 16, 12, 0.9), false);
    std::vector<WeightedRay> chosen;
    for (std::size_t i = 0; i < 16; ++i) chosen.push_back({i, 1.0 / 16});
    EXPECT_EQ(weighted_visibility(rays, chosen), visibility_of(rays));
}

TEST(Visibility, OfAChannelIsThatOfTheRaysOfThatChannel) {
    base::Random random(12);
    for (const bool media : {false, true}) {
        auto segments = hair(random, 8, 6, 0.9);
        if (media) segments[2] = cases::random_media(random, 4, 5, 15);
        auto rays = make_rays(segments, media);
        rays.channels = 3;
        rays.transmittance.clear();
        for (std::size_t i = 0; i < 3 * rays.segments(); ++i)
            rays.transmittance.push_back(cases::number(random, 0.1, 1.0));
        std::vector<WeightedRay> chosen;
        for (std::size_t i = 0; i < 8; ++i) chosen.push_back({i, (1.0 + static_cast<double>(i)) / 36});
        SweepScratch scratch;
        Curve out;
        for (int c = 0; c < 3; ++c) {
            const auto one = rays::channel(rays, c);
            visibility(rays, 0, 8, 1e-4, scratch, out, c);
            EXPECT_EQ(out, visibility_of(one));
            EXPECT_EQ(weighted_visibility(rays, chosen, c), weighted_visibility(one, chosen));
        }
    }
}

// The published update in float drifts by 1e-4 over a million vertices, ends above 0 and rises on the way.
TEST(WeightedSum, OfAMillionVerticesDoesNotDrift) {
    base::Random random(7);
    std::vector<Curve> curves;
    for (int i = 0; i < 250; ++i) {
        Curve curve;
        float z = cases::number(random, 1e-3, 1), value = 1.0f;
        while (curve.size() < 4000) {
            curve.push_back({z, value});
            value = curve.size() >= 3999 ? 0.0f : value * cases::number(random, 0.997, 1.0);
            if (random.below(3) > 0)
                z += random.below(50) == 0 ? cases::number(random, 0, 1000) : cases::number(random, 0, 1e-3);
        }
        curves.push_back(std::move(curve));
    }
    std::vector<WeightedCurve> terms;
    for (const Curve& curve : curves) terms.push_back({curve, 1.0 / 250});
    const Curve out = sum_of(terms);
    ASSERT_TRUE(is_visibility(out));
    EXPECT_EQ(out.back().value, 0.0f);
    for (int i = 0; i < 1500; ++i) {
        const Curve& curve = curves[random.below(250)];
        const float z = curve[random.below(4000)].z;
        for (const bool behind : {false, true})
            ASSERT_NEAR(cases::exact(out, z, behind), direct_sum(terms, z, behind), 1e-6);
    }
}

// The steepest slopes a float can hold, active together with gentle ones, near and far.
TEST(WeightedSum, LayersOneFloatApartAtDepths1eMinus3And1e6LeaveNoTrace) {
    std::vector<Curve> curves;
    for (const float start : {1e-45f, 1e-3f, 1.0f, 1e6f}) {
        Curve curve;
        float z = start;
        for (int i = 0; i <= 100; ++i, z = std::nextafter(z, 1e30f))
            curve.push_back({z, 1.0f - 0.01f * static_cast<float>(i)});
        curves.push_back(curve);
    }
    curves.push_back({{-10.0f, 1.0f}, {2e6f, 0.0f}});
    std::vector<WeightedCurve> terms;
    for (const Curve& curve : curves) terms.push_back({curve, 0.2});
    const Curve out = sum_of(terms);
    EXPECT_TRUE(is_visibility(out));
    for (const Curve& curve : curves)
        for (const Vertex& v : curve) ASSERT_NEAR(cases::exact(out, v.z), direct_sum(terms, v.z, false), 1e-6) << v.z;
}

// While a steep term is active, a flat sum wavers by the rounding of slope * depth: the last digit of a float, upwards
// too.
TEST(WeightedSum, OfTermsThatDoNotRiseNeverRisesByRounding) {
    base::Random random(8);
    for (int round = 0; round < 300; ++round) {
        std::vector<Curve> curves(3);
        const float far_depth = cases::number(random, 1e5, 1e6);
        for (float z = far_depth, value = 1.0f; curves[0].size() < 60; z = std::nextafter(z, 2e6f)) {
            curves[0].push_back({z, value});
            value *= cases::number(random, 0.5, 1.0);
        }
        for (const Vertex& v : curves[0]) curves[1].push_back({v.z, 0.5f});
        curves[2] = {{1e-3f, 1.0f}, {1e-3f, cases::number(random, 0, 1)}};
        const double weight = random.uniform();
        ASSERT_TRUE(is_visibility(
            sum_of({{curves[0], weight}, {curves[1], 0.7 - 0.7 * weight}, {curves[2], 0.3 - 0.3 * weight}})));
    }
}

TEST(WeightedSum, TermsMayRise) {
    const Curve rising{{0, 0.25f}, {1, 0.75f}, {1, 1}}, falling{{0, 1}, {2, 0}};
    const std::vector<WeightedCurve> terms{{rising, 0.5}, {falling, 0.5}};
    const Curve out = sum_of(terms);
    for (const float z : {-1.0f, 0.0f, 0.5f, 1.0f, 1.5f, 2.0f, 3.0f})
        EXPECT_NEAR(cases::exact(out, z), direct_sum(terms, z, false), 1e-7);
}

TEST(WeightedSum, TermsWithoutVerticesAreLit) {
    const Curve wall{{2, 1}, {2, 0}};
    EXPECT_TRUE(sum_of({}).empty());
    EXPECT_TRUE(sum_of({{{}, 1.0}}).empty());
    EXPECT_EQ(sum_of({{wall, 0.25}, {{}, 0.75}}), (Curve{{2, 1}, {2, 0.75f}}));
}

TEST(WeightedSum, AContinuousVertexIsNotDoubled) {
    const Curve a{{0, 1}, {1, 0.5f}, {3, 0}}, b{{0, 1}, {2, 0.3f}, {3, 0}};
    EXPECT_EQ(sum_of({{a, 0.5}, {b, 0.5}}).size(), 4u);
}

TEST(WeightedSum, AConstantBelowOneKeepsItsValue) {
    const Curve half{{5, 0.5f}};
    EXPECT_EQ(evaluate(sum_of({{half, 1.0}}), 0.0f), 0.5f);
}

}  // namespace
}  // namespace shadowbench::curves
