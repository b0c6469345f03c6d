#include "curves/norms.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "cases.h"

namespace shadowbench::curves {
namespace {

TEST(Norms, EqualFunctionsHaveNoDistance) {
    const Curve curve{{1, 1}, {2, 0.5f}, {2, 0.25f}};
    const Distance none = distance(curve, curve, -INFINITY, INFINITY);
    EXPECT_EQ(none.max, 0.0);
    EXPECT_EQ(none.l1, 0.0);
    EXPECT_EQ(none.l2, 0.0);
    EXPECT_EQ(distance({}, Curve{{3, 1}}, 0, 1).max, 0.0);
}

// Sampling at depths would miss a limit that is reached on one side of a step only.
TEST(Norms, TheMaximumCountsBothSidesOfAStep) {
    const Curve wall{{2, 1}, {2, 0}}, ramp{{1, 1}, {3, 0}};
    const Distance d = distance(wall, ramp, 0, 4);
    EXPECT_EQ(d.max, 0.5);
    EXPECT_DOUBLE_EQ(d.l1, 0.5);
    EXPECT_DOUBLE_EQ(d.l2, std::sqrt(1.0 / 6.0));
    EXPECT_EQ(distance(Curve{{2, 1}, {2, 0}}, Curve{{2, 1}, {2, 1}}, 0, 2).max, 1.0);
}

// The mean of the end values would be 0 here.
TEST(Norms, FunctionsThatCrossDoNotCancel) {
    const Distance d = distance(Curve{{0, 1}, {1, 0}}, Curve{{0, 0.5f}}, 0, 1);
    EXPECT_DOUBLE_EQ(d.l1, 0.25);
    EXPECT_DOUBLE_EQ(d.l2, std::sqrt(1.0 / 12.0));
}

TEST(Norms, OnlyTheIntegralsAreBounded) {
    const Curve dark{{5, 0.25f}};
    const Distance d = distance(dark, {}, 1, 3);
    EXPECT_EQ(d.max, 0.75);
    EXPECT_DOUBLE_EQ(d.l1, 1.5);
    EXPECT_EQ(distance(Curve{{5, 1}, {5, 0}}, {}, 1, 3).max, 1.0) << "max is over all depths";
    EXPECT_EQ(distance(Curve{{5, 1}, {5, 0}}, {}, 1, 3).l1, 0.0);
    EXPECT_EQ(distance(dark, {}, 3, 3).l1, 0.0);
}

TEST(Norms, AnEndlessDifferenceIsInfiniteNotNaN) {
    EXPECT_TRUE(std::isinf(distance(Curve{{5, 0.5f}}, {}, 0, INFINITY).l1));
    EXPECT_EQ(distance(Curve{{5, 1}, {6, 0}}, Curve{{5, 1}, {5, 0}}, 0, INFINITY).l1, 0.5);
}

// std::max(0, NaN) is 0: a broken curve would pass as perfect.
TEST(Norms, ANaNIsFarAwayNotNear) {
    const Curve broken{{0, 1}, {1, std::numeric_limits<float>::quiet_NaN()}, {2, 0}};
    EXPECT_TRUE(std::isinf(distance(broken, Curve{{0, 1}, {2, 0}}, 0, 2).max));
}

TEST(Norms, MatchDenseSampling) {
    base::Random random(4);
    for (int round = 0; round < 40; ++round) {
        Curve curves[2];
        for (Curve& curve : curves)
            for (float z = 0, value = 1; curve.size() < 12;
                 z += random.below(3) == 0 ? 0.0f : cases::number(random, 0, 1)) {
                curve.push_back({z, value});
                value *= cases::number(random, 0.5, 1);
            }
        const Distance d = distance(curves[0], curves[1], 1.0, 6.0);
        double max = 0.0, l1 = 0.0, l2 = 0.0;
        constexpr int kSamples = 40000;
        for (int i = 0; i < kSamples; ++i) {
            const double z = 1.0 + 5.0 * (i + 0.5) / kSamples;
            const double difference = std::abs(cases::exact(curves[0], z) - cases::exact(curves[1], z));
            l1 += difference * 5.0 / kSamples;
            l2 += difference * difference * 5.0 / kSamples;
        }
        for (const Curve& curve : curves)
            for (const Vertex& v : curve)
                for (const bool behind : {false, true})
                    max = std::max(
                        max, std::abs(cases::exact(curves[0], v.z, behind) - cases::exact(curves[1], v.z, behind)));
        ASSERT_NEAR(d.max, max, 1e-12);
        ASSERT_NEAR(d.l1, l1, 1e-3);
        ASSERT_NEAR(d.l2, std::sqrt(l2), 1e-3);
    }
}

RC_GTEST_PROP(Norms, AreSymmetricAndObeyTheTriangleInequality, ()) {
    const Curve a = *cases::any_function(), b = *cases::any_function(), c = *cases::any_function();
    const Distance ab = distance(a, b, -10, 10), ba = distance(b, a, -10, 10);
    RC_ASSERT(ab.max == ba.max);
    RC_ASSERT(ab.l1 == ba.l1);
    RC_ASSERT(ab.l1 <= ab.max * 20.0 + 1e-12);
    RC_ASSERT(distance(a, c, -10, 10).max <= ab.max + distance(b, c, -10, 10).max + 1e-12);
}

}  // namespace
}  // namespace shadowbench::curves
