#include "curves/curve.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "cases.h"

namespace shadowbench::curves {
namespace {

TEST(Curve, NoVertexMeansLitEverywhere) {
    EXPECT_EQ(evaluate({}, 5.0f), 1.0f);
    EXPECT_EQ(evaluate_behind({}, 5.0f), 1.0f);
}

// A surface would shade itself if a lookup at its own depth saw the value behind the step.
TEST(Curve, AStepShadesOnlyWhatIsStrictlyBehindIt) {
    const Curve curve{{2.0f, 1.0f}, {2.0f, 0.25f}};
    EXPECT_EQ(evaluate(curve, 1.0f), 1.0f);
    EXPECT_EQ(evaluate(curve, 2.0f), 1.0f);
    EXPECT_EQ(evaluate_behind(curve, 2.0f), 0.25f);
    EXPECT_EQ(evaluate(curve, std::nextafter(2.0f, 3.0f)), 0.25f);
    EXPECT_EQ(evaluate(curve, 1e30f), 0.25f);
}

TEST(Curve, ManyVerticesAtOneDepthAreOneStepFromTheFirstToTheLast) {
    const Curve curve{{2.0f, 0.9f}, {2.0f, 0.8f}, {2.0f, 0.5f}, {2.0f, 0.1f}};
    EXPECT_EQ(evaluate(curve, 2.0f), 0.9f);
    EXPECT_EQ(evaluate_behind(curve, 2.0f), 0.1f);
}

TEST(Curve, IsConstantOutsideItsVerticesAndLinearBetween) {
    const Curve curve{{1.0f, 0.75f}, {3.0f, 0.25f}};
    EXPECT_EQ(evaluate(curve, -1e9f), 0.75f);
    EXPECT_EQ(evaluate(curve, 2.0f), 0.5f);
    EXPECT_EQ(evaluate(curve, 1e9f), 0.25f);
}

// In float, z - left.z and the product lose digits: the value could leave the range of its two vertices.
RC_GTEST_PROP(Curve, BothLimitsMatchTheDefinition, ()) {
    const Curve curve = *cases::any_function();
    for (const Vertex& vertex : curve)
        for (const float z :
             {std::nextafter(vertex.z, -1e38f), vertex.z, std::nextafter(vertex.z, 1e38f), vertex.z + 0.3f}) {
            RC_ASSERT(std::abs(evaluate(curve, z) - cases::exact(curve, z)) <= 0x1p-24);
            RC_ASSERT(std::abs(evaluate_behind(curve, z) - cases::exact(curve, z, true)) <= 0x1p-24);
            RC_ASSERT(evaluate(curve, z) >= evaluate_behind(curve, z));
        }
}

// 1 + (v - 1) is not v for a small v.
TEST(Curve, AVertexHasExactlyItsValue) {
    const Curve curve{{1.0f, 1.0f}, {2.0f, 1e-30f}, {3.0f, 1e-38f}};
    for (const Vertex& v : curve) {
        EXPECT_EQ(evaluate(curve, v.z), v.value);
        EXPECT_EQ(evaluate_behind(curve, v.z), v.value);
    }
}

TEST(Curve, IsVisibilityRefusesRisesRangesAndNaN) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_TRUE(is_visibility({}));
    EXPECT_TRUE(is_visibility(Curve{{0, 1}, {1, 0}}));
    EXPECT_FALSE(is_visibility(Curve{{0, 0.5f}, {1, 0.6f}}));
    EXPECT_TRUE(is_visibility(Curve{{0, 0.5f}, {1, 0.6f}}, 0.2f));
    EXPECT_FALSE(is_visibility(Curve{{0, 1.1f}}));
    EXPECT_FALSE(is_visibility(Curve{{0, -0.1f}}));
    EXPECT_FALSE(is_visibility(Curve{{0, nan}}));
}

}  // namespace
}  // namespace shadowbench::curves
