#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "curves/norms.h"
#include "curves/sweep.h"
#include "techniques/avsm/stream.h"
#include "techniques/built.h"

namespace shadowbench::techniques {
namespace {

using ::testing::ElementsAre;
using ::testing::Pair;

constexpr float far_plane = 100.0f;

struct Segment {
    float front, back, through;
};

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
        // Nodes at one depth may come about differently: the function is what counts.
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

TEST(AvsmStream, NothingIsAddedBehindAnOpaqueSurface) {
    EXPECT_THAT(run(8, {{5, 5, 0.0f}, {6, 7, 0.5f}, {8, 8, 0.5f}, {5, 6, 0.1f}}),
                ElementsAre(Pair(5.0f, 1.0f), Pair(5.0f, 0.0f), Pair(far_plane, 0.0f)));
}

double mean_curve_error(const testing::Built& b) {
    double sum = 0.0;
    curves::SweepScratch scratch;
    curves::Curve exact, stored;
    rays::testing::for_each_ray(b.rays, [&](const rays::LightRays& tile, std::size_t ray, int i, int j) {
        curves::visibility(tile, ray, 1, 1e-5, scratch, exact);
        b.map->stored(i, j, 0, {}, stored);
        sum += curves::distance(stored, exact, 0, 4).max;
    });
    return sum;
}

TEST(Avsm, MoreNodesLeaveLessError) {
    for (const bool media : {false, true}) {
        double before = std::numeric_limits<double>::infinity();
        for (const int nodes : {2, 4, 8, 16, 64}) {
            const auto b =
                testing::build(find("avsm", ""), testing::hairy_scene(media), rays::testing::directional(),
                               rays::testing::rays(24, 4), ("{\"nodes\": " + std::to_string(nodes) + "}").c_str());
            const double error = mean_curve_error(b);
            if (nodes <= 16)
                EXPECT_LT(error, before) << nodes;
            else
                EXPECT_LE(error, before) << "everything fits, and what is left is that media are not linear";
            before = error;
        }
    }
}

TEST(Avsm, BilinearLookupsBlendFourTexels) {
    const auto b = testing::build(find("avsm", ""), testing::hairy_scene(true), rays::testing::directional(),
                                  rays::testing::rays(16, 1), R"({"filter": "bilinear"})");
    const auto point = testing::build(find("avsm", ""), testing::hairy_scene(true), rays::testing::directional(),
                                      rays::testing::rays(16, 1), R"({"filter": "point"})");
    for (const auto& [x, y] : {std::pair{8.5f, 8.5f}, {8.75f, 6.0f}, {3.2f, 9.9f}, {0.1f, 15.9f}}) {
        const float fx = std::clamp(x - 0.5f, 0.0f, 15.0f), fy = std::clamp(y - 0.5f, 0.0f, 15.0f);
        const int i = static_cast<int>(fx), j = static_cast<int>(fy);
        const float wx = fx - static_cast<float>(i), wy = fy - static_cast<float>(j);
        const auto at = [&](int dx, int dy) {
            return point.lookup(static_cast<float>(std::min(i + dx, 15)) + 0.5f,
                                static_cast<float>(std::min(j + dy, 15)) + 0.5f, 1.0f);
        };
        const float expected =
            (1 - wy) * ((1 - wx) * at(0, 0) + wx * at(1, 0)) + wy * ((1 - wx) * at(0, 1) + wx * at(1, 1));
        EXPECT_NEAR(b.lookup(x, y, 1.0f), expected, 1e-6f);
    }
}

TEST(Avsm, BytesAreEightANodeWhateverTheScene) {
    for (const int nodes : {2, 4, 8, 12, 64}) {
        const auto b =
            testing::build(find("avsm", ""), testing::hairy_scene(false), rays::testing::directional(),
                           rays::testing::rays(16, 4), ("{\"nodes\": " + std::to_string(nodes) + "}").c_str());
        EXPECT_EQ(b.map->bytes(), 16u * 16 * 4 * nodes * 8) << "table 1 counts 8 bytes a node";
    }
}

}  // namespace
}  // namespace shadowbench::techniques
