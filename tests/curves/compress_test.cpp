#include "curves/compress.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "base/random.h"
#include "cases.h"
#include "curves/norms.h"
#include "curves/slope_windows.h"

namespace shadowbench::curves {
namespace {

using cases::Case;

constexpr double kRounding = 0x1p-24;  // of a float near 1

double error(CurveView a, CurveView b) {
    return distance(a, b, 0.0, 0.0).max;
}

bool is_subset_of_depths(const Curve& part, const Curve& whole) {
    const auto less = [](const Vertex& a, const Vertex& b) { return a.z < b.z; };
    return std::includes(whole.begin(), whole.end(), part.begin(), part.end(), less);
}

RC_GTEST_PROP(Compress, StaysWithinTheToleranceOnBothSidesOfEveryStep, ()) {
    const Case c = *cases::any_case();
    RC_ASSERT(error(compress(c.curve, c.tolerance), c.curve) <= c.tolerance + cases::rounding_of(c.curve));
}

// Invented depths make surfaces shade themselves; more vertices than the input would overrun the caller's memory.
RC_GTEST_PROP(Compress, GivesAVisibilityFunctionOfTheInputsDepthsThatIsNotLonger, ()) {
    const Case c = *cases::any_case();
    const Curve compressed = compress(c.curve, c.tolerance);
    RC_ASSERT(compressed.size() <= c.curve.size());
    RC_ASSERT(is_visibility(compressed));
    RC_ASSERT(is_subset_of_depths(compressed, c.curve));
}

RC_GTEST_PROP(Compress, AToleranceOfZeroKeepsTheFunction, ()) {
    const Curve curve = (*cases::any_case()).curve;
    const Curve compressed = compress(curve, 0.0f);
    RC_ASSERT(error(compressed, curve) <= cases::rounding_of(curve));
    for (const Vertex& v : compressed) {  // what is kept is kept exactly
        RC_ASSERT(evaluate(compressed, v.z) == evaluate(curve, v.z));
        RC_ASSERT(evaluate_behind(compressed, v.z) == evaluate_behind(curve, v.z));
    }
}

// Greedy compression is not idempotent: where the first pass bends within its tolerance, the second may go straight.
RC_GTEST_PROP(Compress, AgainAtTheSameToleranceTakesNoMoreVerticesAndStaysWithinItOfTheFirst, ()) {
    const Case c = *cases::any_case();
    const Curve once = compress(c.curve, c.tolerance), twice = compress(once, c.tolerance);
    RC_ASSERT(twice.size() <= once.size());
    RC_ASSERT(error(twice, once) <= c.tolerance + cases::rounding_of(once));
    RC_ASSERT(error(twice, c.curve) <= 2.0 * c.tolerance + 2.0 * cases::rounding_of(c.curve));
}

RC_GTEST_PROP(Compress, AgainAtAToleranceOfZeroGivesTheSameFunction, ()) {
    const Curve once = compress((*cases::any_case()).curve, 0.0f);
    RC_ASSERT(error(compress(once, 0.0f), once) <= 0x1p-48);
}

RC_GTEST_PROP(Compress, IntoTheInputsOwnMemoryGivesTheSame, ()) {
    const Case c = *cases::any_case();
    Curve in_place = c.curve;
    in_place.resize(compress(in_place, c.tolerance, in_place.data()));
    RC_ASSERT(in_place == compress(c.curve, c.tolerance));
}

// Metres or millimetres: a tolerance has no unit of depth.
RC_GTEST_PROP(Compress, ScalingDepthsByAPowerOfTwoScalesDepthsAlone, ()) {
    const Case c = *cases::any_case();
    const int power = *cases::full_range(rc::gen::inRange(-30, 31));
    Curve scaled = c.curve, expected = compress(c.curve, c.tolerance);
    RC_PRE(cases::scale_depths(scaled, power));
    cases::scale_depths(expected, power);
    RC_ASSERT(compress(scaled, c.tolerance) == expected);
}

// The light behind everything is what the ground receives, so it must not be biased.
RC_GTEST_PROP(Compress, EndsAtTheExactValueWhenOneSegmentReachesTheEnd, ()) {
    const Curve curve = (*cases::any_case()).curve;
    RC_PRE(!curve.empty());
    const Curve compressed = compress(curve, 1.0f);
    RC_ASSERT(evaluate_behind(compressed, curve.back().z) == curve.back().value);
    RC_ASSERT(compressed.size() <= 2u);
}

#if defined(__SSE2__)
// Blocks are only faster. Were their slopes off by a bit, or were a step cut in two, maps would depend on the machine.
TEST(SlopeWindows, OfBlocksAreThoseOfVerticesOneByOne) {
    base::Random random(5);
    std::size_t blocks = 0, failures = 0, steps = 0;
    for (int trial = 0; trial < 2000; ++trial) {
        Curve curve{{0.25f, 1.0f}};
        for (int i = 0; i < 40; ++i) {
            const Vertex last = curve.back();
            const float fall = random.below(8) == 0 ? 0.03f : static_cast<float>(random.uniform(0.0, 0.002));
            curve.push_back({random.below(3) == 0 ? last.z : last.z + static_cast<float>(random.uniform(0.0, 0.1)),
                             std::max(0.0f, last.value - fall)});
        }
        std::size_t first = 1;
        while (curve[first].z == curve[0].z) ++first;
        constexpr double epsilon = 0.02;
        Slopes expected{-1e9, 1e9}, slopes = expected, tried = expected;
        std::size_t count = 0;
        for (std::size_t i = first; i < curve.size(); ++i) {
            const double inverse = 1.0 / (static_cast<double>(curve[i].z) - curve[0].z);
            tried.low = std::max(tried.low, (std::max(curve[i].value - epsilon, 0.0) - 1.0) * inverse);
            tried.high = std::min(tried.high, (curve[i].value + epsilon - 1.0) * inverse);
            if ((i - first) % 4 != 3) continue;
            const bool cut = i + 1 < curve.size() && curve[i + 1].z == curve[i].z;
            steps += cut;
            failures += !cut && tried.low > tried.high;
            if (cut || tried.low > tried.high) break;
            expected = tried;
            count += 4;
        }
        blocks += count / 4;
        ASSERT_EQ(narrow_by_blocks(curve, first, curve[0].z, 1.0, epsilon, slopes), count) << trial;
        ASSERT_EQ(slopes.low, expected.low) << trial;
        ASSERT_EQ(slopes.high, expected.high) << trial;
    }
    EXPECT_GT(std::min({blocks, failures, steps}), 100u) << "all three ways out were taken";
}
#endif

TEST(Compress, NoVerticesStayNone) {
    EXPECT_TRUE(compress(Curve{}, 0.02f).empty());
}

TEST(Compress, AFunctionThatIsLitEverywhereNeedsNoVertex) {
    EXPECT_TRUE(compress(Curve{{1, 1}}, 0.02f).empty());
    EXPECT_TRUE(compress(Curve{{1, 1}, {1, 1}, {2, 1}, {3, 1}}, 0.0f).empty());
}

TEST(Compress, AConstantBelowOneNeedsOneVertex) {
    EXPECT_EQ(compress(Curve{{1, 0.5f}, {2, 0.5f}, {2, 0.5f}, {9, 0.5f}}, 0.02f).size(), 1u);
    EXPECT_EQ(evaluate(compress(Curve{{1, 0.5f}, {2, 0.5f}}, 0.02f), -3.0f), 0.5f);
}

TEST(Compress, AWallStaysAWall) {
    const Curve wall{{2, 1}, {2, 0}};
    EXPECT_EQ(compress(wall, 0.02f), wall);
    EXPECT_EQ(compress(Curve{{1, 1}, {2, 1}, {2, 0}, {3, 0}}, 0.02f), wall) << "flat parts need no vertices";
}

// A step above twice the tolerance cannot be crossed by any segment: two vertices at one depth.
TEST(Compress, ALargeStepAmidSmallOnesStandsWhereItWas) {
    Curve curve;
    for (int i = 0; i < 100; ++i) curve.push_back({static_cast<float>(i), 1.0f - 0.002f * static_cast<float>(i)});
    for (int i = 99; i < 200; ++i) curve.push_back({static_cast<float>(i), 0.6f - 0.002f * static_cast<float>(i)});
    const Curve compressed = compress(curve, 0.01f);
    EXPECT_EQ(compressed.size(), 4u);
    EXPECT_LE(error(compressed, curve), 0.01 + kRounding);
    EXPECT_EQ(compressed[1].z, 99.0f);
    EXPECT_EQ(compressed[2].z, 99.0f);
}

// One vertex per segment: ending segments at the front side of each step would take two.
TEST(Compress, ManySmallStepsBecomeALine) {
    Curve curve;
    for (int i = 0; i < 1000; ++i) {
        curve.push_back({static_cast<float>(i), 1.0f - 0.001f * static_cast<float>(i)});
        curve.push_back({static_cast<float>(i), 1.0f - 0.001f * static_cast<float>(i + 1)});
    }
    EXPECT_LE(compress(curve, 0.01f).size(), 2u);
}

// The middle of the allowed slopes may be above 0 on a flat part that follows a fall; the published rule rises there.
TEST(Compress, DoesNotRiseAfterAFall) {
    base::Random random(5);
    for (int round = 0; round < 300; ++round) {
        Curve curve;
        float value = 1.0f;
        for (int i = 0; i < 60; ++i) {
            curve.push_back({static_cast<float>(i), value});
            if (random.below(5) == 0) value -= std::min(value, cases::number(random, 0, 0.1));
        }
        ASSERT_TRUE(is_visibility(compress(curve, 0.03f)));
    }
}

TEST(Compress, ManyVerticesAtOneDepthAreOneStep) {
    EXPECT_EQ(compress(Curve{{1, 1}, {1, 0.9f}, {1, 0.7f}, {1, 0.1f}, {1, 0}}, 0.02f), (Curve{{1, 1}, {1, 0}}));
}

// 1 / dz overflows a float here, and slopes reach 1e45.
TEST(Compress, DenormalDistancesKeepTheirSteps) {
    const float tiny = std::numeric_limits<float>::denorm_min();
    const Curve curve{{0, 1}, {tiny, 0.5f}, {2 * tiny, 0.1f}, {1, 0.1f}, {1e30f, 0}};
    for (const float tolerance : {0.0f, 0.02f, 0.2f})
        EXPECT_LE(error(compress(curve, tolerance), curve), tolerance + kRounding);
}

TEST(Compress, LayersOneFloatApartFarFromTheLight) {
    Curve curve;
    float z = 1e6f, value = 1.0f;
    for (int i = 0; i < 200; ++i, z = std::nextafter(z, 2e6f), value *= 0.97f) {
        curve.push_back({z, value});
        curve.push_back({z, value * 0.97f});
    }
    for (const float tolerance : {0.0f, 0.001f, 0.02f})
        EXPECT_LE(error(compress(curve, tolerance), curve), tolerance + kRounding);
}

TEST(Compress, AToleranceThatIsNotANumberOrNegativeKeepsTheFunction) {
    const Curve curve{{1, 1}, {2, 0.9f}, {3, 0.2f}};
    EXPECT_EQ(compress(curve, -1.0f), curve);
    EXPECT_EQ(compress(curve, std::numeric_limits<float>::quiet_NaN()), curve);
}

// Input that breaks the contract must not hang or write past the output.
TEST(Compress, EndsOnFunctionsThatRiseOrAreNotNumbers) {
    const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
    const float values[] = {0.0f, 1.0f, 0.5f, nan, infinity, -infinity};
    base::Random random(6);
    for (int round = 0; round < 2000; ++round) {
        Curve curve;
        for (int i = 0; i < 8; ++i) curve.push_back({values[random.below(6)], values[random.below(6)]});
        const std::size_t count = curve.size();
        ASSERT_LE(compress(curve, 0.02f, curve.data()), count);
    }
}

}  // namespace
}  // namespace shadowbench::curves
