#include "curves/compress_published.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "cases.h"
#include "curves/norms.h"

namespace shadowbench::curves {
namespace {

using cases::Case;

double error(CurveView a, CurveView b) {
    return distance(a, b, 0.0, 0.0).max;
}

// The largest rise from any depth to a deeper one.
float rise_of(CurveView curve) {
    float rise = 0.0f, least = std::numeric_limits<float>::infinity();
    for (const Vertex& v : curve) {
        rise = std::max(rise, v.value - least);
        least = std::min(least, v.value);
    }
    return rise;
}

// The published method keeps its guarantee, also at the last segment.
RC_GTEST_PROP(CompressPublished, StaysWithinTheToleranceOnBothSidesOfEveryStep, ()) {
    const Case c = *cases::any_case();
    RC_ASSERT(error(compress_published(c.curve, c.tolerance), c.curve) <= c.tolerance + cases::rounding_of(c.curve));
}

RC_GTEST_PROP(CompressPublished, StaysWithinTheToleranceOfAFunctionThatRises, ()) {
    Case c = *cases::any_case();
    for (Vertex& v : c.curve) v.value = 1.0f - v.value;
    const double slack = cases::rounding_of({});  // of values up to 1: the largest of these is the last
    RC_ASSERT(error(compress_published(c.curve, c.tolerance), c.curve) <= c.tolerance + slack);
}

// The faults that the header names, with their bounds.
RC_GTEST_PROP(CompressPublished, RisesByTwiceTheToleranceAtMostFallsBelow0ByItAndNeverPasses1, ()) {
    const Case c = *cases::any_case();
    const Curve out = compress_published(c.curve, c.tolerance);
    const double slack = cases::rounding_of(c.curve);
    RC_ASSERT(rise_of(out) <= 2.0 * (c.tolerance + slack));
    for (const Vertex& v : out) {
        RC_ASSERT(v.value >= -c.tolerance - slack);
        RC_ASSERT(v.value <= 1.0f);
    }
}

RC_GTEST_PROP(CompressPublished, StartsAtTheFirstVertexAndKeepsDepthsOfTheInputAlone, ()) {
    const Case c = *cases::any_case();
    const Curve out = compress_published(c.curve, c.tolerance);
    RC_ASSERT(out.size() <= c.curve.size());
    RC_ASSERT(out.empty() == c.curve.empty());
    if (out.empty()) return;
    RC_ASSERT(out.front() == c.curve.front());
    const auto less = [](const Vertex& a, const Vertex& b) { return a.z < b.z; };
    RC_ASSERT(std::includes(c.curve.begin(), c.curve.end(), out.begin(), out.end(), less));
}

RC_GTEST_PROP(CompressPublished, IntoTheInputsOwnMemoryGivesTheSame, ()) {
    const Case c = *cases::any_case();
    Curve in_place = c.curve;
    in_place.resize(compress_published(in_place, c.tolerance, in_place.data()));
    RC_ASSERT(in_place == compress_published(c.curve, c.tolerance));
}

RC_GTEST_PROP(CompressPublished, ScalingDepthsByAPowerOfTwoScalesDepthsAlone, ()) {
    const Case c = *cases::any_case();
    const int power = *cases::full_range(rc::gen::inRange(-30, 31));
    Curve scaled = c.curve, expected = compress_published(c.curve, c.tolerance);
    RC_PRE(cases::scale_depths(scaled, power));
    cases::scale_depths(expected, power);
    RC_ASSERT(compress_published(scaled, c.tolerance) == expected);
}

RC_GTEST_PROP(CompressPublished, EveryChannelOfThreeStaysWithinTheTolerance, ()) {
    const cases::ColourCase c = *cases::any_three();
    std::vector<ColourVertex> out(c.vertices());
    out.resize(compress_published(c.views(), c.tolerance, out.data()));
    for (int channel = 0; channel < 3; ++channel)
        RC_ASSERT(error(cases::channel(out, channel), c.curve[channel]) <= c.tolerance + 2.0 * 0x1p-24);
}

// For equal functions with at most two vertices at a depth: three read both sides of a step, one reads every vertex.
RC_GTEST_PROP(CompressPublished, ThreeEqualFunctionsGiveTheVerticesOfOne, ()) {
    const Case c = *cases::any_case();
    Curve curve;
    for (const Vertex& v : c.curve) {
        const bool within = curve.size() > 1 && curve[curve.size() - 2].z == v.z;
        if (within)
            curve.back() = v;
        else if (curve.empty() || !(curve.back() == v))
            curve.push_back(v);
    }
    std::vector<ColourVertex> three(3 * curve.size());
    three.resize(compress_published({curve, curve, curve}, c.tolerance, three.data()));
    for (int channel = 0; channel < 3; ++channel)
        RC_ASSERT(cases::channel(three, channel) == compress_published(curve, c.tolerance));
}

// By hand: from (0, 1) the windows at 1, 2 and 3 leave the slopes [-1/3, -0.8/3]; the window at 4 would leave none.
TEST(CompressPublished, EndsASegmentAtTheLastVertexPassedWithTheMiddleSlope) {
    const Curve curve{{0, 1}, {1, 0.7f}, {2, 0.4f}, {3, 0.1f}, {4, 0.1f}, {8, 0.1f}};
    const Curve out = compress_published(curve, 0.1f);
    ASSERT_EQ(out.size(), 3u);
    EXPECT_EQ(out[1].z, 3.0f);
    EXPECT_NEAR(out[1].value, 1.0 - 3.0 * 0.5 * (0.8 / 3 + 1.0 / 3), 1e-6);
    EXPECT_EQ(out[2].z, 8.0f);
}

TEST(CompressPublished, AStepAtTheOriginIsVertical) {
    EXPECT_EQ(compress_published(Curve{{2, 1}, {2, 0}}, 0.02f), (Curve{{2, 1}, {2, 0}}));
    EXPECT_EQ(compress_published(Curve{{2, 1}, {2, 0.9f}, {2, 0.4f}, {2, 0}, {3, 0}}, 0.02f),
              (Curve{{2, 1}, {2, 0}, {3, 0}}));
    EXPECT_EQ(compress_published(Curve{{2, 1}, {2, 0.99f}, {3, 0.99f}}, 0.02f).size(), 2u) << "within the tolerance";
}

// The faults that compress() corrects, each at its worst.
TEST(CompressPublished, FallsBelow0AndRisesAgainAfterAnSFall) {
    const Curve curve{{0, 1}, {1, 0.95f}, {2, 0.6f}, {3, 0.2f}, {4, 0}, {5, 0}, {9, 0}};
    const Curve out = compress_published(curve, 0.1f);
    EXPECT_LT(out[out.size() - 2].value, -0.09f);
    EXPECT_GT(rise_of(out), 0.09f);
    EXPECT_TRUE(is_visibility(compress(curve, 0.1f)));
    EXPECT_EQ(compress(curve, 0.1f).back().value, 0.0f);
}

TEST(CompressPublished, LeavesLightBehindAnOpaqueSurface) {
    const Curve curve{{0, 1}, {1, 0.95f}, {10, 0}};
    EXPECT_NEAR(compress_published(curve, 0.05f).back().value, 0.025f, 1e-6f);
    EXPECT_EQ(compress(curve, 0.05f).back().value, 0.0f);
}

TEST(CompressPublished, TakesFunctionsThatRise) {
    const Curve curve{{0, 0.5f}, {1, 0.7f}, {1, 0.9f}, {2, 0.2f}};
    for (const float tolerance : {0.0f, 0.01f, 0.05f, 0.3f})
        EXPECT_LE(error(compress_published(curve, tolerance), curve), tolerance + 0x1p-24);
}

// Input that breaks the contract must not hang or write past the output.
TEST(CompressPublished, EndsOnFunctionsThatAreNotNumbers) {
    const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
    const float values[] = {0.0f, 1.0f, 0.5f, nan, infinity, -infinity};
    base::Random random(6);
    for (int round = 0; round < 2000; ++round) {
        Curve curve;
        for (int i = 0; i < 8; ++i) curve.push_back({values[random.below(6)], values[random.below(6)]});
        const std::size_t count = curve.size();
        ASSERT_LE(compress_published(curve, 0.02f, curve.data()), count);
    }
}

TEST(CompressPublished, NoVerticesStayNone) {
    EXPECT_TRUE(compress_published(Curve{}, 0.02f).empty());
    ColourVertex unused;
    EXPECT_EQ(compress_published({Curve{}, Curve{}, Curve{}}, 0.02f, &unused), 0u);
}

}  // namespace
}  // namespace shadowbench::curves
