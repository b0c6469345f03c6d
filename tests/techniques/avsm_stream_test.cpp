// The streaming compression of one texel.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "techniques/any_rays.h"
#include "techniques/avsm/stream.h"
#include "techniques/avsm/texel.h"
#include "techniques/one_ray.h"

namespace shadowbench::techniques {
namespace {

using ::testing::ElementsAre;
using ::testing::Pair;

constexpr float far_plane = 100.0f;

using testing::Segment;

template <class Stream>
std::vector<std::pair<float, float>> nodes(const Stream& stream) {
    std::vector<std::pair<float, float>> result;
    stream.for_each([&](float depth, float value) { result.emplace_back(depth, value); });
    return result;
}

std::vector<std::pair<float, float>> run(int capacity, const std::vector<Segment>& segments) {
    TransmittanceStream<64> stream(capacity, far_plane);
    for (const Segment& s : segments) stream.insert(s.front, s.back, s.through);
    return nodes(stream);
}

TEST(AvsmStream, StartsClear) {
    EXPECT_THAT(run(4, {}), ElementsAre(Pair(far_plane, 1.0f)));
}

TEST(AvsmStream, ASurfaceIsAStepOfTwoNodes) {
    EXPECT_THAT(run(4, {{5, 5, 0.25f}}), ElementsAre(Pair(5.0f, 1.0f), Pair(5.0f, 0.25f), Pair(far_plane, 0.25f)));
}

TEST(AvsmStream, SegmentsThatTouchShareANode) {
    EXPECT_THAT(run(8, {{1, 2, 0.5f}, {2, 3, 0.5f}}),
                ElementsAre(Pair(1.0f, 1.0f), Pair(2.0f, 0.5f), Pair(3.0f, 0.25f), Pair(far_plane, 0.25f)));
}

TEST(AvsmStream, TheOrderOfSegmentsDoesNotMatterWhileEverythingFits) {
    const std::vector<Segment> sorted = {{1, 3, 0.9f}, {2, 2, 0.5f}, {2, 4, 0.8f}, {3, 3, 0.5f}, {6, 6, 0.1f}};
    std::vector<Segment> segments = sorted;
    const auto expected = run(64, sorted);
    base::Random random(1);
    for (int i = 0; i < 50; ++i) {
        for (std::size_t k = segments.size(); k > 1; --k) std::swap(segments[k - 1], segments[random.below(k)]);
        const auto found = run(64, segments);
        // Nodes at one depth may arise differently: only the function counts.
        curves::Curve a, b;
        for (const auto& [z, t] : expected) a.push_back({z, t});
        for (const auto& [z, t] : found) b.push_back({z, t});
        // Between nodes the streams join by lines what is exponential, at nodes that differ with the order: a chord
        // over a transmittance of 0.8 is at most 0.0062 off.
        for (const float z : {0.5f, 1.0f, 1.999f, 2.0f, 3.0f, 3.0001f, 4.0f, 5.0f, 6.0f, 6.1f, 50.0f})
            EXPECT_NEAR(curves::evaluate(a, z), curves::evaluate(b, z), 0.0062) << z;
        EXPECT_NEAR(curves::evaluate(b, 50.0f), 0.9 * 0.5 * 0.8 * 0.5 * 0.1, 1e-7) << "what passes in all is exact";
    }
}

TEST(AvsmStream, AMediumInsideAnotherFollowsItsOwnCurve) {
    const auto found = run(64, {{2, 2, 0.5f}, {1, 3, 0.25f}});  // the surface's nodes lie in the middle of the medium
    EXPECT_THAT(found, ElementsAre(Pair(1.0f, 1.0f), Pair(2.0f, 0.5f), Pair(2.0f, 0.25f), Pair(3.0f, 0.125f),
                                   Pair(far_plane, 0.125f)));
}

TEST(AvsmStream, CoincidentSurfacesMultiplyWithoutNewNodes) {
    EXPECT_THAT(run(64, {{5, 5, 0.5f}, {5, 5, 0.5f}, {5, 5, 0.5f}}),
                ElementsAre(Pair(5.0f, 1.0f), Pair(5.0f, 0.125f), Pair(far_plane, 0.125f)));
}

TEST(AvsmStream, DropsTheNodeThatChangesTheAreaLeast) {
    // Figure 2 of the paper: of the two inner nodes the one with the smaller triangle goes.
    TransmittanceStream<8> stream(3, far_plane);
    stream.append(0, 1.0f);
    stream.append(40, 0.9f);
    stream.append(80, 0.2f);
    // Triangles: (0,1) (40,.9) (80,.2): 2 A = |80 * -0.7 + 40 * 0.8| = 24; (40,.9) (80,.2) (100,.2): 2 A = 14.
    EXPECT_THAT(nodes(stream), ElementsAre(Pair(0.0f, 1.0f), Pair(40.0f, 0.9f), Pair(far_plane, 0.2f)));
}

TEST(AvsmStream, NeverHoldsMoreThanItsNodesAndKeepsFirstAndLast) {
    for (const int capacity : {2, 3, 4, 8, 16, 33, 64})
        for (int seed = 0; seed < 50; ++seed) {
            base::Random random(base::hash(capacity, seed));
            TransmittanceStream<64> stream(capacity, far_plane);
            float first = far_plane;
            double total = 1.0;
            std::vector<float> ends = {far_plane};
            for (int i = 0; i < 200; ++i) {
                Segment s{static_cast<float>(random.uniform(0, 90)), 0, static_cast<float>(random.uniform(0.9, 1))};
                s.back = random.uniform() < 0.5 ? s.front : s.front + static_cast<float>(random.uniform(0, 5));
                if (random.uniform() < 0.1 && i) s.front = s.back = ends.back();
                if (s.back >= far_plane) continue;
                stream.insert(s.front, s.back, s.through);
                if (s.through < 1.0f) first = std::min(first, s.front);
                total *= s.through;
                ends.push_back(s.front);
                ends.push_back(s.back);
            }
            const auto found = nodes(stream);
            ASSERT_EQ(static_cast<int>(found.size()), stream.size());
            ASSERT_LE(stream.size(), capacity);
            EXPECT_EQ(found.front(), (std::pair{first, 1.0f})) << "where darkness begins";
            EXPECT_EQ(found.back().first, far_plane);
            EXPECT_NEAR(found.back().second, total, 1e-5 * total) << "what passes in all";
            for (std::size_t i = 0; i < found.size(); ++i) {
                EXPECT_THAT(ends, ::testing::Contains(found[i].first)) << "nodes never move";
                if (i) {
                    EXPECT_GE(found[i].first, found[i - 1].first);
                    EXPECT_LE(found[i].second, found[i - 1].second);
                }
            }
        }
}

// The same for nasty segments in the order in which they are drawn, checked after each of them, and for values only.
template <Sampling sampling>
void check_stream(int capacity, const std::vector<Segment>& segments) {
    constexpr float far_depth = 1e32f;
    TransmittanceStream<64, sampling> stream(capacity, far_depth);
    float first = far_depth;
    double total = 1.0;
    std::vector<float> ends = {far_depth};
    for (const Segment& s : segments) {
        stream.insert(s.front, s.back, s.through);
        if (s.through < 1.0f) first = std::min(first, s.front);
        total *= s.through;
        ends.push_back(s.front);
        ends.push_back(s.back);
        const auto found = nodes(stream);
        RC_ASSERT(static_cast<int>(found.size()) == stream.size());
        RC_ASSERT(stream.size() <= capacity);
        RC_ASSERT(found.front().first == first);
        RC_ASSERT(found.front().second == (first < far_depth ? 1.0f : static_cast<float>(total)));
        RC_ASSERT(found.back().first == far_depth);
        RC_ASSERT(std::abs(found.back().second - total) <= 1e-5 * total + 1e-37);
        for (std::size_t i = 0; i < found.size(); ++i) {
            RC_ASSERT(std::count(ends.begin(), ends.end(), found[i].first) > 0);
            RC_ASSERT(found[i].second >= 0.0f);
            if (i == 0) continue;
            RC_ASSERT(found[i].first >= found[i - 1].first);
            RC_ASSERT(found[i].second <= found[i - 1].second);
        }
    }
}

RC_GTEST_PROP(AvsmStream, HoldsItsPromisesAfterEverySegmentInAnyOrder, ()) {
    const std::vector<Segment> segments = *testing::any_segments();
    const int capacity = *rc::gen::element(2, 3, 4, 8, 16, 64);
    if (*rc::gen::arbitrary<bool>())
        check_stream<Sampling::linear>(capacity, segments);
    else
        check_stream<Sampling::exponential>(capacity, segments);
}

TEST(AvsmStream, NothingIsAddedBehindAnOpaqueSurface) {
    EXPECT_THAT(run(8, {{5, 5, 0.0f}, {6, 7, 0.5f}, {8, 8, 0.5f}, {5, 6, 0.1f}}),
                ElementsAre(Pair(5.0f, 1.0f), Pair(5.0f, 0.0f), Pair(far_plane, 0.0f)));
}

// The product of all segments at z, in double.
double product(const std::vector<Segment>& segments, double z) {
    return rays::transmittance(testing::ray_of(segments), 0, 0, z);
}

void shuffle(std::vector<Segment>& segments, base::Random& random) {
    for (std::size_t k = segments.size(); k > 1; --k) std::swap(segments[k - 1], segments[random.below(k)]);
}

TEST(AvsmStream, OverlappingMediaInAnyOrderGiveTheExactProductWithExponentialSampling) {
    for (int seed = 0; seed < 300; ++seed) {
        base::Random random(seed);
        std::vector<Segment> segments = testing::random_segments(base::hash(seed), 30, 1, 90);
        if (seed % 3 == 0) segments[0] = {segments[0].front, segments[0].front, 0.0f};  // a wall
        if (seed % 5 == 0) segments[1].back = segments[1].front = segments[2].front;    // ends at one depth
        if (seed % 7 == 0) segments[3] = segments[4];
        if (seed % 11 == 0) segments[5].front = segments[6].back;
        if (segments[5].front > segments[5].back) segments[5].back = segments[5].front;
        shuffle(segments, random);
        TransmittanceStream<64, Sampling::exponential> stream(64, far_plane);
        for (const Segment& s : segments) stream.insert(s.front, s.back, s.through);
        const auto found = nodes(stream);
        ASSERT_LE(found.size(), 61u) << "everything fits";
        std::vector<float> texel;
        for (const auto& node : found) texel.push_back(node.first);
        for (const auto& node : found) texel.push_back(node.second);
        const auto count = static_cast<int>(found.size());
        const TexelEvaluator evaluate = texel_evaluator(count, Sampling::exponential);
        for (float z = 0.0f; z < far_plane; z += 0.37f)
            EXPECT_NEAR(evaluate(texel.data(), count, z), product(segments, z), 1e-5) << "z " << z << " seed " << seed;
        for (const Segment& s : segments)
            for (const float z :
                 {s.front, std::nextafter(s.front, far_plane), s.back, std::nextafter(s.back, far_plane)})
                EXPECT_NEAR(evaluate(texel.data(), count, z), product(segments, z), 1e-5)
                    << "z " << z << " seed " << seed;
    }
}

TEST(AvsmStream, SurfacesAndWholeStepsInAnyOrderGiveTheExactProductWithLinearSampling) {
    for (int seed = 0; seed < 300; ++seed) {
        // Media of a grid: their ends lie on whole numbers, so that no node falls inside a medium. Surfaces there too.
        base::Random random(seed);
        std::vector<Segment> segments;
        for (int i = 0; i < 60; ++i) {
            const auto front = static_cast<float>(1 + random.below(25));
            const float back = random.uniform() < 0.5 ? front : front + 1;
            const auto through = static_cast<float>(random.uniform(0.5, 1.0));
            segments.push_back({front, back, front == back && random.uniform() < 0.02 ? 0.0f : through});
        }
        const auto found = run(64, segments);
        ASSERT_LT(found.size(), 64u);
        curves::Curve curve;
        for (const auto& [z, t] : found) curve.push_back({z, t});
        for (int z = 0; z < 30; ++z) {
            EXPECT_NEAR(curves::evaluate(curve, static_cast<float>(z)), product(segments, z), 1e-5) << z;
            const float behind = std::nextafter(static_cast<float>(z), far_plane);
            EXPECT_NEAR(curves::evaluate_behind(curve, static_cast<float>(z)), product(segments, behind), 1e-5) << z;
        }
    }
}

}  // namespace
}  // namespace shadowbench::techniques
