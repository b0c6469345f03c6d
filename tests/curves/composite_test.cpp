#include "curves/composite.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "cases.h"
#include "rays/extended_oracle.h"

namespace shadowbench::curves {
namespace {

using cases::make_rays;
using cases::Segment;

void composite(const rays::LightRays& rays, std::size_t ray, int channel, std::vector<Node>& out) {
    OpenMedia open;
    curves::composite(rays, ray, channel, open, out);
}

std::vector<Node> nodes_of(std::vector<Segment> segments, bool media = true) {
    std::vector<Node> nodes;
    composite(make_rays({std::move(segments)}, media), 0, 0, nodes);
    return nodes;
}

// Joins nodes as the header says: log(value) is linear.
double join(const std::vector<Node>& nodes, double z) {
    std::size_t i = 0;
    while (i < nodes.size() && nodes[i].z < z) ++i;
    if (nodes.empty()) return 1.0;
    if (i == 0) return nodes.front().value;
    if (i == nodes.size()) return nodes.back().value;
    const Node a = nodes[i - 1], b = nodes[i];
    if (z == b.z || a.value == 0.0) return b.value;
    return a.value * std::exp(std::log(b.value / a.value) * ((z - a.z) / (b.z - a.z)));
}

TEST(Composite, AnEmptyRayHasNoNodes) {
    EXPECT_TRUE(nodes_of({}).empty());
    EXPECT_TRUE(nodes_of({}, false).empty());
}

TEST(Composite, SurfacesAreStepsAndThoseAtOneDepthAreOneStep) {
    for (const bool media : {false, true}) {
        const auto nodes = nodes_of({{1, 1, 0.5f}, {2, 2, 0.5f}, {2, 2, 0.25f}}, media);
        ASSERT_EQ(nodes.size(), 4u);
        EXPECT_EQ(nodes[0].value, 1.0);
        EXPECT_EQ(nodes[1].value, 0.5);
        EXPECT_EQ(nodes[2].z, 2.0);
        EXPECT_EQ(nodes[3].value, 0.0625);
    }
}

TEST(Composite, NothingIsSeenBehindAnOpaqueSurface) {
    for (const bool media : {false, true}) {
        const auto nodes = nodes_of({{1, 1, 0.0f}, {2, 2, 0.5f}}, media);
        ASSERT_EQ(nodes.size(), 2u);
        EXPECT_EQ(nodes.back().value, 0.0);
    }
}

TEST(Composite, SegmentsThatAbsorbNothingLeaveNoNodes) {
    EXPECT_TRUE(nodes_of({{1, 1, 1.0f}, {1, 4, 1.0f}, {2, 2, 1.0f}}).empty());
}

// Extinction is constant between the ends, and the surface shades strictly behind its own depth.
TEST(Composite, ASurfaceInsideAMediumMultipliesIt) {
    const auto nodes = nodes_of({{0, 2, 0.25f}, {1, 1, 0.5f}});
    ASSERT_EQ(nodes.size(), 4u);
    EXPECT_NEAR(nodes[1].value, 0.5, 1e-15);
    EXPECT_NEAR(nodes[2].value, 0.25, 1e-15);
    EXPECT_EQ(nodes[3].value, 0.125);  // exact: products of what is closed, no exponential
}

TEST(Composite, RandomRaysMatchTheOracleEverywhere) {
    base::Random random(1);
    for (int round = 0; round < 60; ++round) {
        auto segments = cases::random_media(random, static_cast<int>(random.below(12)), 0, 10);
        const auto surfaces = cases::random_surfaces(random, static_cast<int>(random.below(6)), 0, 10, 1.0);
        segments.insert(segments.end(), surfaces.begin(), surfaces.end());
        const auto rays = make_rays({segments}, true);
        std::vector<Node> nodes;
        composite(rays, 0, 0, nodes);
        for (const Node& node : nodes) ASSERT_NEAR(join(nodes, node.z), rays::transmittance(rays, 0, 0, node.z), 1e-14);
        for (int i = 0; i < 200; ++i) {
            const double z = random.uniform(-1, 11);
            ASSERT_NEAR(join(nodes, z), rays::transmittance(rays, 0, 0, z), 1e-12);
        }
        for (std::size_t i = 1; i < nodes.size(); ++i) {
            ASSERT_LE(nodes[i].value, nodes[i - 1].value);
            ASSERT_GE(nodes[i].z, nodes[i - 1].z);
        }
    }
}

// The worst case is a medium a few floats thick far behind the depth where another began: see the header.
RC_GTEST_PROP(Composite, AdversarialRaysMatchTheOracleInExtendedPrecision, ()) {
    base::Random random(*cases::full_range(rc::gen::inRange<std::uint64_t>(0, 1u << 20)));
    cases::DepthPalette palette(random);
    const auto most = *cases::full_range(rc::gen::inRange<std::uint64_t>(1, 16));
    const bool media = *rc::gen::arbitrary<bool>();
    const auto rays = make_rays({cases::adversarial_ray(random, palette, most, media)}, media);
    std::vector<Node> nodes;
    composite(rays, 0, 0, nodes);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (i > 0) RC_ASSERT(nodes[i].value <= nodes[i - 1].value && nodes[i].z >= nodes[i - 1].z);
        const auto exact = rays::testing::extended_transmittance(rays, 0, 0, nodes[i].z);
        RC_ASSERT(std::abs(join(nodes, nodes[i].z) - exact) <= 2e-9L);
    }
    for (int i = 0; i < 30; ++i) {
        const double z = palette.depth();
        RC_ASSERT(std::abs(join(nodes, z) - rays::testing::extended_transmittance(rays, 0, 0, z)) <= 2e-9L);
    }
}

// A medium 10^40 times as dense leaves errors in the sums of extinctions that would drown the others.
TEST(Composite, AMediumOneDenormalThickLeavesNoErrorInThoseAroundIt) {
    const float tiny = std::numeric_limits<float>::denorm_min();
    const auto rays = make_rays({{{0, tiny, 0.5f}, {0, 3 * tiny, 0.7f}, {0, 1, 0.5f}, {tiny, 2, 0.8f}}}, true);
    std::vector<Node> nodes;
    composite(rays, 0, 0, nodes);
    for (const double z : {1e-6, 0.5, 1.0, 1.5, 2.0})
        EXPECT_NEAR(join(nodes, z), rays::transmittance(rays, 0, 0, z), 1e-12) << z;
}

// A running sum of extinctions keeps the rounding error of the thin dense layer (1e7 per unit) and would show it in the
// thousands of faint segments behind it.
TEST(Composite, ADenseSegmentLeavesNoErrorInFaintOnesBehindIt) {
    std::vector<Segment> segments{{1.0f, std::nextafter(1.0f, 2.0f), 0.5f}, {0.5f, 5000.0f, 0.999f}};
    for (int i = 0; i < 4000; ++i)
        segments.push_back({2.0f + static_cast<float>(i), 3.0f + static_cast<float>(i), 0.9999f});
    const auto rays = make_rays({segments}, true);
    std::vector<Node> nodes;
    composite(rays, 0, 0, nodes);
    for (std::size_t i = 0; i < nodes.size(); i += 37)
        ASSERT_NEAR(nodes[i].value / rays::transmittance(rays, 0, 0, nodes[i].z), 1.0, 1e-12);
}

TEST(Composite, AMediumThatLetsNothingThroughEndsAtExactlyZero) {
    const auto nodes = nodes_of({{1, 2, 0.0f}, {3, 3, 0.5f}});
    ASSERT_EQ(nodes.size(), 3u);
    EXPECT_EQ(nodes[1].value, double{std::numeric_limits<float>::min()});
    EXPECT_EQ(nodes[2].value, 0.0);
}

// exp(-10000) is 0 in double: one more node must show how steeply the function falls on the way.
TEST(Composite, AnOpticalDepthOf10000InOneStepKeepsItsShape) {
    const std::vector<Segment> segments(115, {1.0f, 2.0f, std::numeric_limits<float>::min()});
    const auto rays = make_rays({segments}, true);
    std::vector<Node> nodes;
    composite(rays, 0, 0, nodes);
    for (double z = 1.0; z < 1.06; z += 1e-4) ASSERT_NEAR(join(nodes, z), rays::transmittance(rays, 0, 0, z), 1e-10);
    Curve curve;
    linearise(nodes, 0.001, curve);
    EXPECT_TRUE(is_visibility(curve));
    for (double z = 1.0; z < 2.1; z += 1e-5)
        ASSERT_NEAR(cases::exact(curve, z), rays::transmittance(rays, 0, 0, z), 0.0011);
}

TEST(Composite, TakesTheChannelAskedFor) {
    auto rays = make_rays({{{1, 1, 0}}}, false);
    rays.channels = 3;
    rays.transmittance = {0.25f, 0.5f, 0.75f};
    std::vector<Node> nodes;
    composite(rays, 0, 2, nodes);
    EXPECT_EQ(nodes.back().value, 0.75);
}

double chord_error(const std::vector<Node>& nodes, const Curve& curve) {
    double worst = 0.0;
    for (std::size_t i = 1; i < curve.size(); ++i)
        for (int k = 1; k < 16; ++k) {
            const double z = curve[i - 1].z + (static_cast<double>(curve[i].z) - curve[i - 1].z) * k / 16;
            worst = std::max(worst, std::abs(cases::exact(curve, z) - join(nodes, z)));
        }
    return worst;
}

TEST(Linearise, ErrsByAtMostWhatIsAskedFor) {
    base::Random random(2);
    for (int round = 0; round < 40; ++round) {
        std::vector<Node> nodes;
        composite(make_rays({cases::random_media(random, 1 + static_cast<int>(random.below(8)), 1, 50)}, true), 0, 0,
                  nodes);
        for (const double error : {0.2, 0.01, 0.0003}) {
            Curve curve;
            linearise(nodes, error, curve);
            ASSERT_LE(chord_error(nodes, curve), error + 1e-6);
            ASSERT_TRUE(is_visibility(curve));
        }
    }
}

// Where a piece of the exponential is as short as a float is apart from the next, vertices have to stand on the floats
// there are: without them the chord passes at 0.5 where the function is 0.
TEST(Linearise, ErrsNoMoreInMediaAFewFloatsThick) {
    for (const float front : {0.0f, 1e-3f, 1.0f, 1e6f})
        for (const double through : {1e-38, 1e-6, 0.1, 0.6})
            for (const int floats : {2, 3, 7, 20, 100, 1000})
                for (const double error : {0.01, 1e-4}) {
                    std::vector<float> depths{front};
                    while (static_cast<int>(depths.size()) <= floats)
                        depths.push_back(std::nextafter(depths.back(), 2e6f));
                    const std::vector<Node> nodes{{front, 1.0}, {depths.back(), through}};
                    Curve curve;
                    linearise(nodes, error, curve);
                    ASSERT_TRUE(is_visibility(curve));
                    for (const float z : depths)
                        ASSERT_NEAR(evaluate(curve, z), join(nodes, z), error + 1e-6)
                            << front << ' ' << through << ' ' << floats;
                }
}

// From 1 to exp(-20) within 0.01, the integral of sqrt(T / 0.08) over optical depth asks for 6.4 pieces, and one to the
// end. Equal pieces of optical depth would be 71.
TEST(Linearise, SpendsVerticesWhereTheFunctionBends) {
    Curve curve;
    linearise(std::vector<Node>{{0.0, 1.0}, {1.0, std::exp(-20.0)}}, 0.01, curve);
    EXPECT_LE(curve.size(), 10u);
    EXPECT_LE(chord_error({{0.0, 1.0}, {1.0, std::exp(-20.0)}}, curve), 0.01);
}

TEST(Linearise, WithoutALimitKeepsOnlyTheNodes) {
    Curve curve{{-1.0f, 1.0f}};  // existing vertices stay
    linearise(std::vector<Node>{{0.0, 1.0}, {1.0, 0.01}}, std::numeric_limits<double>::infinity(), curve);
    ASSERT_EQ(curve.size(), 3u);
    EXPECT_EQ(curve[2].value, 0.01f);
}

// Between 1e6 and 1e6 + 1/4 lie three floats: no more vertices fit, and no two may be at one depth.
TEST(Linearise, StopsWhereNoFloatIsLeftBetween) {
    Curve curve;
    linearise(std::vector<Node>{{1e6, 1.0}, {1e6 + 0.25, 0.0}}, 1e-4, curve);
    EXPECT_LE(curve.size(), 5u);
    for (std::size_t i = 1; i < curve.size(); ++i) EXPECT_LT(curve[i - 1].z, curve[i].z);
    EXPECT_TRUE(is_visibility(curve));
}

// Pieces of a few floats: rounded to the nearest, some of them would be longer than they may be, by a quarter and more.
TEST(Linearise, ErrsByNoMoreWhereFloatsAreFew) {
    for (const int floats : {3, 16, 100, 256, 1000, 10'000})
        for (const double depth : {0.1, 1.0, 5.0, 80.0})
            for (const double error : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6}) {
                const double length = floats * 0x1p-23;
                const std::vector<Node> nodes{{1.0, 1.0}, {1.0 + length, std::exp(-depth)}};
                Curve curve;
                linearise(nodes, error, curve);
                double worst = 0.0;
                for (int i = 0; i <= floats; ++i) {
                    const float z = 1.0f + static_cast<float>(i) * 0x1p-23f;
                    worst = std::max(worst, std::abs(evaluate(curve, z) - std::exp(-depth * (z - 1.0) / length)));
                }
                EXPECT_LE(worst, error + 0x1p-23) << floats << " floats, depth " << depth;
            }
}

TEST(Linearise, AnErrorOfZeroStillEnds) {
    Curve curve;
    linearise(std::vector<Node>{{0.0, 1.0}, {1.0, 0.0}}, 0.0, curve);
    EXPECT_LT(curve.size(), 5000u);
}

}  // namespace
}  // namespace shadowbench::curves
