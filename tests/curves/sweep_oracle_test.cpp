// Sums and sweeps beside oracles in extended precision, on rays and functions that are hard on them.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "cases.h"
#include "curves/norms.h"
#include "curves/sweep.h"
#include "rays/extended_oracle.h"

namespace shadowbench::curves {
namespace {

using cases::make_rays;
using cases::Segment;
using rays::testing::Side;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Curve visibility_of(const rays::LightRays& rays, double linearisation) {
    SweepScratch scratch;
    Curve out;
    visibility(rays, 0, rays.rays(), linearisation, scratch, out);
    return out;
}

bool is_sorted(const Curve& curve) {
    return std::is_sorted(curve.begin(), curve.end(), [](const Vertex& a, const Vertex& b) { return a.z < b.z; });
}

rays::LightRays adversarial_pixel(std::uint64_t seed, int count, std::uint64_t most, bool media) {
    base::Random random(seed);
    cases::DepthPalette palette(random);
    std::vector<std::vector<Segment>> segments;
    for (int i = 0; i < count; ++i) segments.push_back(cases::adversarial_ray(random, palette, most, media));
    return make_rays(std::move(segments), media);
}

rc::Gen<rays::LightRays> any_pixel(bool media) {
    return rc::gen::apply(
        [=](std::uint64_t seed, int count, std::uint64_t most) { return adversarial_pixel(seed, count, most, media); },
        cases::full_range(rc::gen::inRange<std::uint64_t>(0, 1u << 20)), cases::full_range(rc::gen::inRange(1, 7)),
        cases::full_range(rc::gen::inRange<std::uint64_t>(0, 9)));
}

double error_at(const rays::LightRays& rays, const Curve& curve, float z, Side side) {
    const auto exact = rays::testing::extended_visibility(rays, 0, rays.rays(), 0, z, side);
    return std::abs(static_cast<double>(cases::exact(curve, z, side == Side::behind) - exact));
}

// The largest distance from the oracle at every depth where a segment begins or ends, on both sides, and between.
double oracle_error(const rays::LightRays& rays, const Curve& curve, bool between) {
    double worst = 0.0;
    std::vector<float> depths;
    for (std::size_t s = 0; s < rays.segments(); ++s)
        if (rays.transmittance[s] < 1.0f) depths.insert(depths.end(), {rays.z_front[s], rays.back(s)});
    std::sort(depths.begin(), depths.end());
    const std::size_t count = depths.size();
    for (std::size_t i = 1; between && i < count; ++i)
        for (const float share : {0.1f, 0.5f, 0.8f})
            depths.push_back(depths[i - 1] + (depths[i] - depths[i - 1]) * share);
    for (const float z : depths)
        for (const Side side : {Side::front, Side::behind}) worst = std::max(worst, error_at(rays, curve, z, side));
    return worst;
}

// The same at some of many depths.
double sampled_error(const rays::LightRays& rays, const Curve& curve, base::Random& random) {
    double worst = 0.0;
    for (int i = 0; i < 12; ++i) {
        const float z = rays.z_front[random.below(rays.segments())];
        for (const Side side : {Side::front, Side::behind}) worst = std::max(worst, error_at(rays, curve, z, side));
    }
    return worst;
}

RC_GTEST_PROP(VisibilityOracle, SurfacesAreSummedToTheLastDigitOfAFloat, ()) {
    const rays::LightRays rays = *any_pixel(false);
    const Curve out = visibility_of(rays, 1e-4);
    RC_ASSERT(is_visibility(out));
    RC_ASSERT(is_sorted(out));
    RC_ASSERT(oracle_error(rays, out, true) <= 0x1p-24);
}

RC_GTEST_PROP(VisibilityOracle, MediaAreSummedWithinTheirLinearisation, ()) {
    const rays::LightRays rays = *any_pixel(true);
    const double linearisation = *rc::gen::element(0.01, 1e-4);
    const Curve out = visibility_of(rays, linearisation);
    RC_ASSERT(is_visibility(out));
    RC_ASSERT(is_sorted(out));
    RC_ASSERT(oracle_error(rays, out, true) <= linearisation + 1e-6);
}

RC_GTEST_PROP(VisibilityOracle, AtTheEndsOfSegmentsMediaAreExact, ()) {
    const rays::LightRays rays = *any_pixel(true);
    const Curve out = visibility_of(rays, kInfinity);
    RC_ASSERT(is_visibility(out));
    RC_ASSERT(rays.rays() > 1 || oracle_error(rays, out, false) <= 1e-6);
}

RC_GTEST_PROP(VisibilityOracle, ScalingDepthsByAPowerOfTwoScalesDepthsAlone, ()) {
    rays::LightRays rays = *any_pixel(*rc::gen::arbitrary<bool>());
    const int power = *cases::full_range(rc::gen::inRange(1, 31));
    Curve expected = visibility_of(rays, 0.001);
    for (float z : rays.z_front) RC_PRE(z == 0.0f || z > 1e-30f);  // between denormals other floats lie
    for (float z : rays.z_back) RC_PRE(z == 0.0f || z > 1e-30f);
    for (float& z : rays.z_front) z = std::ldexp(z, power);
    for (float& z : rays.z_back) z = std::ldexp(z, power);
    RC_PRE(cases::scale_depths(expected, power));
    RC_ASSERT(visibility_of(rays, 0.001) == expected);
}

// 10^6 vertices of surfaces, half of them at depths that several rays share.
TEST(VisibilityOracle, AMillionVerticesOfSurfacesStayMonotoneAndExact) {
    base::Random random(1);
    std::vector<std::vector<Segment>> segments(100);
    for (auto& ray : segments) ray = cases::random_surfaces(random, 5000, 1e-3, 5000, 2e-3);
    const rays::LightRays rays = make_rays(std::move(segments), false);
    const Curve out = visibility_of(rays, kInfinity);
    EXPECT_GT(out.size(), 700'000u);
    EXPECT_TRUE(is_visibility(out));
    EXPECT_TRUE(is_sorted(out));
    EXPECT_LE(sampled_error(rays, out, random), 0x1p-24);
}

TEST(VisibilityOracle, AMillionVerticesOfMediaStayMonotoneAndExact) {
    base::Random random(2);
    std::vector<std::vector<Segment>> segments(100);
    for (auto& ray : segments)
        for (int i = 0; i < 5000; ++i) {
            const float front = cases::number(random, 1e-3, 5000);
            const double length = std::exp(random.uniform(-9, 3));
            ray.push_back({front, static_cast<float>(front + length), cases::number(random, 0.9985, 1)});
        }
    const rays::LightRays rays = make_rays(std::move(segments), true);
    const Curve out = visibility_of(rays, 1e-4);
    EXPECT_GT(out.size(), 950'000u);
    EXPECT_TRUE(is_visibility(out));
    EXPECT_TRUE(is_sorted(out));
    EXPECT_LE(sampled_error(rays, out, random), 1e-6);
}

struct Term {
    Curve curve;
    double weight;
};

std::ostream& operator<<(std::ostream& stream, const Term& term) {
    stream << term.weight << " of";
    for (const Vertex& v : term.curve) stream << ", " << v.z << ' ' << v.value;
    return stream;
}

// One to five functions; weights that sum to 1, one of them perhaps far above the others.
rc::Gen<std::vector<Term>> any_terms() {
    const auto term = rc::gen::apply(
        [](Curve curve, int weight) {
            return Term{std::move(curve), std::exp2(-weight)};
        },
        rc::gen::oneOf(cases::any_function(), cases::any_adversarial_function(0.05f)),
        cases::full_range(rc::gen::inRange(0, 20)));
    return rc::gen::map(
        rc::gen::mapcat(cases::full_range(rc::gen::inRange<std::size_t>(1, 6)),
                        [=](std::size_t count) { return rc::gen::container<std::vector<Term>>(count, term); }),
        [](std::vector<Term> terms) {
            double sum = 0.0;
            for (const Term& t : terms) sum += t.weight;
            for (Term& t : terms) t.weight /= sum;
            return terms;
        });
}

Curve sum_of(const std::vector<Term>& terms) {
    std::vector<WeightedCurve> weighted;
    for (const Term& t : terms) weighted.push_back({t.curve, t.weight});
    SweepScratch scratch;
    Curve out;
    weighted_sum(weighted, scratch, out);
    return out;
}

double direct_sum(const std::vector<Term>& terms, double z, bool behind) {
    long double sum = 0.0L;
    for (const Term& t : terms) sum += static_cast<long double>(t.weight) * cases::exact(t.curve, z, behind);
    return static_cast<double>(sum);
}

RC_GTEST_PROP(WeightedSumOracle, IsTheSumOfItsTermsOnBothSidesOfEveryDepth, ()) {
    const auto terms = *any_terms();
    const Curve out = sum_of(terms);
    RC_ASSERT(is_visibility(out));
    RC_ASSERT(is_sorted(out));
    for (const Term& t : terms)
        for (const Vertex& v : t.curve)
            for (const bool behind : {false, true})
                RC_ASSERT(std::abs(cases::exact(out, v.z, behind) - direct_sum(terms, v.z, behind)) <= 2e-7);
}

RC_GTEST_PROP(WeightedSumOracle, TheOrderOfTheTermsChangesTheLastDigitOfAFloatAtMost, ()) {
    auto terms = *any_terms();
    const Curve out = sum_of(terms);
    std::reverse(terms.begin(), terms.end());
    RC_ASSERT(distance(sum_of(terms), out, 0.0, 0.0).max <= 2e-7);
}

RC_GTEST_PROP(WeightedSumOracle, ScalingDepthsByAPowerOfTwoScalesDepthsAlone, ()) {
    auto terms = *any_terms();
    const int power = *cases::full_range(rc::gen::inRange(-30, 31));
    Curve expected = sum_of(terms);
    for (Term& t : terms) RC_PRE(cases::scale_depths(t.curve, power));
    cases::scale_depths(expected, power);
    RC_ASSERT(sum_of(terms) == expected);
}

}  // namespace
}  // namespace shadowbench::curves
