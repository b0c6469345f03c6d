#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "cases.h"
#include "curves/compress.h"
#include "curves/norms.h"

namespace shadowbench::curves {
namespace {

constexpr double kRounding = 2.0 * 0x1p-24;  // of a float near 1, and of one between two

using cases::channel;
using cases::ColourCase;

std::vector<ColourVertex> compress(const ColourCase& c) {
    std::vector<ColourVertex> out(c.vertices());
    out.resize(compress(c.views(), c.tolerance, out.data()));
    return out;
}

ColourCase next_pass(const std::vector<ColourVertex>& vertices, float tolerance) {
    return {{channel(vertices, 0), channel(vertices, 1), channel(vertices, 2)}, tolerance};
}

double error(const std::vector<ColourVertex>& vertices, const std::array<Curve, 3>& curves) {
    double worst = 0.0;
    for (int c = 0; c < 3; ++c) worst = std::max(worst, distance(channel(vertices, c), curves[c], 0.0, 0.0).max);
    return worst;
}

RC_GTEST_PROP(CompressColour, EveryChannelStaysWithinTheToleranceOnBothSidesOfEveryStep, ()) {
    const ColourCase c = *cases::any_three();
    const auto compressed = compress(c);
    for (int k = 0; k < 3; ++k) RC_ASSERT(is_visibility(channel(compressed, k)));
    RC_ASSERT(error(compressed, c.curve) <= c.tolerance + kRounding);
}

RC_GTEST_PROP(CompressColour, DepthsAreThoseOfTheThreeAndNotMore, ()) {
    const ColourCase c = *cases::any_three();
    std::vector<float> depths, kept;
    for (const Curve& curve : c.curve)
        for (const Vertex& v : curve) depths.push_back(v.z);
    std::sort(depths.begin(), depths.end());
    for (const ColourVertex& v : compress(c)) kept.push_back(v.z);
    RC_ASSERT(std::includes(depths.begin(), depths.end(), kept.begin(), kept.end()));
}

// Otherwise a grey scene would change when a colour is added elsewhere.
RC_GTEST_PROP(CompressColour, ThreeEqualFunctionsGiveTheVerticesOfOne, ()) {
    const cases::Case c = *cases::any_case();
    const auto three = compress({{c.curve, c.curve, c.curve}, c.tolerance});
    const Curve one = compress(c.curve, c.tolerance);
    for (int k = 0; k < 3; ++k) RC_ASSERT(channel(three, k) == one);
}

RC_GTEST_PROP(CompressColour, AgainAtTheSameToleranceTakesNoMoreVerticesAndStaysWithinItOfTheFirst, ()) {
    const ColourCase c = *cases::any_three();
    const auto once = compress(c);
    const ColourCase again = next_pass(once, c.tolerance);
    const auto twice = compress(again);
    RC_ASSERT(twice.size() <= once.size());
    RC_ASSERT(error(twice, again.curve) <= c.tolerance + kRounding);
}

RC_GTEST_PROP(CompressColour, ScalingDepthsByAPowerOfTwoScalesDepthsAlone, ()) {
    const ColourCase c = *cases::any_three();
    const int power = *cases::full_range(rc::gen::inRange(-30, 31));
    ColourCase scaled = c;
    for (Curve& curve : scaled.curve) RC_PRE(cases::scale_depths(curve, power));
    const auto expected = compress(c), out = compress(scaled);
    for (int k = 0; k < 3; ++k) {
        Curve one = channel(expected, k);
        cases::scale_depths(one, power);
        RC_ASSERT(channel(out, k) == one);
    }
}

TEST(CompressColour, AStepInOneChannelIsAStepForAllAtOneDepth) {
    const Curve red{{2, 1}, {2, 0}}, green{{0, 1}, {4, 0}};
    const auto out = compress({{red, green, Curve{}}, 0.01f});
    EXPECT_EQ(channel(out, 0), (Curve{{0, 1}, {2, 1}, {2, 0}, {4, 0}}));
    EXPECT_EQ(channel(out, 1), (Curve{{0, 1}, {2, 0.5f}, {2, 0.5f}, {4, 0}}));
    EXPECT_EQ(channel(out, 2), (Curve{{0, 1}, {2, 1}, {2, 1}, {4, 1}}));
}

TEST(CompressColour, FunctionsLitInAllChannelsNeedNoVertex) {
    EXPECT_TRUE(compress({{Curve{}, {}, {}}, 0.0f}).empty());
    EXPECT_TRUE(compress({{Curve{{1, 1}}, {}, {{2, 1}, {3, 1}}}, 0.0f}).empty());
    EXPECT_EQ(compress({{Curve{{1, 1}}, {}, {{2, 0.5f}}}, 0.0f}).size(), 1u) << "one channel is darker throughout";
}

}  // namespace
}  // namespace shadowbench::curves
