#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "cases.h"
#include "curves/compress.h"
#include "curves/norms.h"

namespace shadowbench::curves {
namespace {

constexpr double kRounding = 0x1p-24;  // of a float near 1

using Curves = std::array<Curve, 3>;

std::vector<ColourVertex> compress(const Curves& curves, float tolerance) {
    std::vector<ColourVertex> out(curves[0].size() + curves[1].size() + curves[2].size());
    out.resize(compress({curves[0], curves[1], curves[2]}, tolerance, out.data()));
    return out;
}

Curve channel(const std::vector<ColourVertex>& vertices, int c) {
    Curve curve;
    for (const ColourVertex& v : vertices) curve.push_back({v.z, v.value[c]});
    return curve;
}

rc::Gen<Curves> any_three() {
    return rc::gen::apply(
        [](const Curve& r, const Curve& g, const Curve& b) {
            return Curves{r, g, b};
        },
        cases::any_function(), cases::any_function(), cases::any_function());
}

RC_GTEST_PROP(CompressColour, EveryChannelStaysWithinTheToleranceOnBothSidesOfEveryStep, ()) {
    const Curves curves = *any_three();
    const float tolerance = *cases::any_tolerance();
    const auto compressed = compress(curves, tolerance);
    for (int c = 0; c < 3; ++c) {
        const Curve one = channel(compressed, c);
        RC_ASSERT(is_visibility(one));
        RC_ASSERT(distance(one, curves[c], 0.0, 0.0).max <= tolerance + 2.0 * kRounding);
    }
}

RC_GTEST_PROP(CompressColour, DepthsAreThoseOfTheThreeAndNotMore, ()) {
    const Curves curves = *any_three();
    std::vector<float> depths, kept;
    for (const Curve& curve : curves)
        for (const Vertex& v : curve) depths.push_back(v.z);
    std::sort(depths.begin(), depths.end());
    for (const ColourVertex& v : compress(curves, *cases::any_tolerance())) kept.push_back(v.z);
    RC_ASSERT(std::includes(depths.begin(), depths.end(), kept.begin(), kept.end()));
}

// Else a grey scene would change when a colour is added elsewhere.
RC_GTEST_PROP(CompressColour, ThreeEqualFunctionsGiveTheVerticesOfOne, ()) {
    const Curve curve = *cases::any_function();
    const float tolerance = *cases::any_tolerance();
    const auto three = compress({curve, curve, curve}, tolerance);
    const Curve one = compress(curve, tolerance);
    for (int c = 0; c < 3; ++c) RC_ASSERT(channel(three, c) == one);
}

TEST(CompressColour, AStepInOneChannelIsAStepForAllAtOneDepth) {
    const Curve red{{2, 1}, {2, 0}}, green{{0, 1}, {4, 0}};
    const auto out = compress({red, green, Curve{}}, 0.01f);
    EXPECT_EQ(channel(out, 0), (Curve{{0, 1}, {2, 1}, {2, 0}, {4, 0}}));
    EXPECT_EQ(channel(out, 1), (Curve{{0, 1}, {2, 0.5f}, {2, 0.5f}, {4, 0}}));
    EXPECT_EQ(channel(out, 2), (Curve{{0, 1}, {2, 1}, {2, 1}, {4, 1}}));
}

TEST(CompressColour, WhatIsLitInAllChannelsNeedsNoVertex) {
    EXPECT_TRUE(compress({Curve{}, {}, {}}, 0.0f).empty());
    EXPECT_TRUE(compress({Curve{{1, 1}}, {}, {{2, 1}, {3, 1}}}, 0.0f).empty());
    EXPECT_EQ(compress({Curve{{1, 1}}, {}, {{2, 0.5f}}}, 0.0f).size(), 1u) << "one channel is darker throughout";
}

}  // namespace
}  // namespace shadowbench::curves
