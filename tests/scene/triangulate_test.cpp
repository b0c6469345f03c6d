#include "scene/polygon/triangulate.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace shadowbench::scene {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;
using Triangle = std::array<std::uint32_t, 3>;

Polygon from(Polygon polygon, std::size_t first) {
    const auto turn = [&](auto& list) {
        if (!list.empty()) std::rotate(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(first), list.end());
    };
    turn(polygon.positions);
    turn(polygon.uv);
    return polygon;
}

Vec3d vector_area(const Polygon& polygon, const Triangulation& result) {
    Vec3d sum(0, 0, 0);
    for (const Triangle& t : result.triangles) {
        const Vec3d a(polygon.positions[t[0]]), b(polygon.positions[t[1]]), c(polygon.positions[t[2]]);
        sum += (b - a).cross(c - a) * 0.5;
    }
    return sum;
}

double area(const Polygon& polygon, const Triangulation& result) {
    double sum = 0.0;
    for (const Triangle& t : result.triangles) {
        const Vec3d a(polygon.positions[t[0]]), b(polygon.positions[t[1]]), c(polygon.positions[t[2]]);
        sum += (b - a).cross(c - a).length() * 0.5;
    }
    return sum;
}

// As a set of positions, so that lists that begin elsewhere compare equal.
std::vector<std::array<Vec3f, 3>> places(const Polygon& polygon, const Triangulation& result) {
    const auto less = [](const Vec3f& a, const Vec3f& b) {
        return std::array{a.x, a.y, a.z} < std::array{b.x, b.y, b.z};
    };
    std::vector<std::array<Vec3f, 3>> list;
    for (const Triangle& t : result.triangles) {
        std::array<Vec3f, 3> corners{polygon.positions[t[0]], polygon.positions[t[1]], polygon.positions[t[2]]};
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end(), less), corners.end());
        list.push_back(corners);
    }
    std::sort(list.begin(), list.end(), [&](const auto& a, const auto& b) {
        return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), less);
    });
    return list;
}

const Polygon square{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {}};

TEST(Triangulate, AFlatConvexPolygonIsTheFanAroundItsFirstCorner) {
    for (std::size_t first = 0; first < 4; ++first)
        EXPECT_THAT(triangulate(from(square, first)).triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}));
    EXPECT_THAT(triangulate({{{0, 0, 0}, {2, 0, 0}, {3, 1, 1}, {2, 2, 2}, {0, 2, 2}}, {}}).triangles,
                ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}, Triangle{0, 3, 4}));
}

TEST(Triangulate, ATriangleStaysAsItIs) {
    EXPECT_THAT(triangulate({{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}, {}}).triangles, ElementsAre(Triangle{0, 1, 2}));
}

TEST(Triangulate, AnArrowOfFourCornersIsSplitAtItsInnerOne) {
    const Polygon arrow{{{0, 0, 0}, {4, 2, 0}, {0, 4, 0}, {1, 2, 0}}, {}};
    for (std::size_t first = 0; first < 4; ++first) {
        const Triangulation result = triangulate(from(arrow, first));
        EXPECT_EQ(result.triangles.size(), 2u);
        EXPECT_EQ(area(from(arrow, first), result), 6.0);
        EXPECT_EQ(vector_area(from(arrow, first), result), Vec3d(0, 0, 6));
    }
}

TEST(Triangulate, KeepsTheWayThePolygonTurns) {
    Polygon l{{{2, 1, 0}, {2, 1, -1}, {1, 1, -1}, {1, 1, -2}, {0, 1, -2}, {0, 1, 0}}, {}};
    EXPECT_EQ(vector_area(l, triangulate(l)), Vec3d(0, 3, 0));
    std::reverse(l.positions.begin(), l.positions.end());
    EXPECT_EQ(vector_area(l, triangulate(l)), Vec3d(0, -3, 0));
}

TEST(Triangulate, AQuadThatIsNotFlatIsSplitAlongItsShorterDiagonalFromEveryCorner) {
    const Polygon bent{{{0, 0, 0}, {2, 0, 1}, {3, 2, 0}, {0, 2, 1}}, {}};
    const auto expected = places(bent, triangulate(bent));
    for (std::size_t first = 0; first < 4; ++first) {
        const Polygon turned = from(bent, first);
        EXPECT_EQ(places(turned, triangulate(turned)), expected);
    }
    for (const Triangle& t : triangulate(bent).triangles) {
        EXPECT_NE(std::count(t.begin(), t.end(), 1u), 0);
        EXPECT_NE(std::count(t.begin(), t.end(), 3u), 0);
    }
}

// If the texture is not spread evenly, a ray's hit depends on the diagonal.
TEST(Triangulate, AQuadOfAnUnevenTextureIsSplitAlikeFromEveryCorner) {
    const Polygon uneven{{{0, 0, 0}, {2, 0, 0}, {3, 2, 0}, {0, 2, 0}}, {{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    const auto expected = places(uneven, triangulate(uneven));
    for (std::size_t first = 0; first < 4; ++first)
        EXPECT_EQ(places(from(uneven, first), triangulate(from(uneven, first))), expected);
    const Polygon even{square.positions, {{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    for (std::size_t first = 0; first < 4; ++first)
        EXPECT_THAT(triangulate(from(even, first)).triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}));
}

TEST(Triangulate, APolygonWithoutAreaHasNoTriangles) {
    for (const std::vector<Vec3f>& corners :
         std::vector<std::vector<Vec3f>>{{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}},
                                         {{0, 0, 0}, {1, 2, 3}, {2, 4, 6}, {1, 2, 3}},
                                         {{0, 0, 0}, {0.1f, 0.2f, 0.3f}, {0.1f, 0.2f, 0.3f}, {0, 0, 0}},
                                         {{0, 0, 0}, {5, 0, 1}, {5, 5, 2}, {5, 0, 1}}}) {
        const Triangulation result = triangulate({corners, {}});
        EXPECT_THAT(result.triangles, IsEmpty());
        EXPECT_EQ(result.fault, "");
    }
}

TEST(Triangulate, CornersMayRepeatAndLieOnOneLine) {
    const Polygon repeated{{{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0.5f, 1, 0}, {0, 1, 0}, {0, 0, 0}}, {}};
    for (std::size_t first = 0; first < repeated.positions.size(); ++first) {
        const Polygon turned = from(repeated, first);
        EXPECT_EQ(vector_area(turned, triangulate(turned)), Vec3d(0, 0, 1));
        EXPECT_EQ(area(turned, triangulate(turned)), 1.0);
    }
}

TEST(Triangulate, NamesTheEdgesWhereAPolygonCrossesItself) {
    const Triangulation bow_tie = triangulate({{{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}, {}});
    EXPECT_THAT(bow_tie.triangles, IsEmpty());
    EXPECT_EQ(bow_tie.fault, "crosses itself: its edge from corner 1 to 2 meets the one from corner 3 to 4");
    // With and without an area that is left over, flat on an axis or not.
    for (const float more : {0.0f, 0.25f})
        for (const float tilt : {0.0f, 0.3f}) {
            const Triangulation result =
                triangulate({{{0.1f, 0, 0}, {1.3f, 1 + more, tilt * (1 + more)}, {1.3f, 0, 0}, {0.1f, 1, tilt}}, {}});
            EXPECT_THAT(result.fault, HasSubstr("crosses itself")) << more << ' ' << tilt;
        }
}

TEST(Triangulate, APolygonThatCoversAPartTwiceIsAtFault) {
    Polygon twice = square;
    twice.positions.insert(twice.positions.end(), square.positions.begin(), square.positions.end());
    EXPECT_THAT(triangulate(twice).fault, HasSubstr("twice"));
}

// A frame, moved and turned in space: rounding to float makes edges that ran through corners cross there.
class TurnedFrame : public testing::TestWithParam<int> {
protected:
    Vec3f place(double x, double y) const {
        std::mt19937 random(static_cast<unsigned>(GetParam()));
        std::normal_distribution<double> normal;
        const auto draw = [&] { return Vec3d(normal(random), normal(random), normal(random)); };
        const Vec3d u = draw().normalized(), v = u.cross(draw()).normalized(), origin = draw() * 10.0;
        return Vec3f(origin + u * x + v * y);
    }
};

TEST_P(TurnedFrame, AHoleJoinedByABridgeStaysAHole) {
    const std::vector<Vec2d> outline{{0, 0}, {9, 0}, {9, 9}, {0, 9}, {0, 0}, {3, 3}, {3, 6}, {6, 6}, {6, 3}, {3, 3}};
    Polygon frame;
    for (const Vec2d& at : outline) frame.positions.push_back(place(at.x, at.y));
    for (std::size_t first = 0; first < outline.size(); ++first) {
        const Triangulation result = triangulate(from(frame, first));
        EXPECT_EQ(result.fault, "");
        EXPECT_NEAR(area(from(frame, first), result), 72.0, 1e-4);
        EXPECT_EQ(places(from(frame, first), result), places(frame, triangulate(frame)));
    }
}

// The hole touches the outer edge with one corner, which does not belong to that edge.
TEST_P(TurnedFrame, AHoleThatTouchesTheOuterEdgeStaysAHole) {
    const std::vector<Vec2d> outline{{0, 0}, {9, 3}, {9, 9}, {0, 9}, {0, 0}, {4, 4}, {6, 2}, {2, 4}, {4, 4}};
    Polygon frame;
    for (const Vec2d& at : outline) frame.positions.push_back(place(at.x, at.y));
    const Triangulation result = triangulate(frame);
    EXPECT_EQ(result.fault, "");
    EXPECT_NEAR(area(frame, result), 67.5 - 2.0, 1e-4);
}

TEST_P(TurnedFrame, StarsAreCoveredWhereverTheirListBegins) {
    std::mt19937 random(static_cast<unsigned>(GetParam()));
    std::uniform_real_distribution<double> radius(0.05, 1.0);
    const int corners = 5 + GetParam() * 3;
    Polygon star;
    std::vector<Vec2d> flat;
    for (int i = 0; i < corners; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / corners, r = radius(random);
        flat.emplace_back(r * std::cos(angle), r * std::sin(angle));
        star.positions.push_back(place(flat.back().x, flat.back().y));
    }
    double twice = 0.0;
    for (std::size_t i = 0; i < flat.size(); ++i) {
        const Vec2d &a = flat[i], &b = flat[(i + 1) % flat.size()];
        twice += a.x * b.y - a.y * b.x;
    }
    for (std::size_t first = 0; first < flat.size(); ++first) {
        const Polygon turned = from(star, first);
        const Triangulation result = triangulate(turned);
        ASSERT_EQ(result.fault, "");
        EXPECT_EQ(result.triangles.size(), flat.size() - 2);
        EXPECT_NEAR(area(turned, result), twice / 2.0, 1e-5);
        EXPECT_NEAR(vector_area(turned, result).length(), twice / 2.0, 1e-5);
    }
}

double cross(const Vec2d& a, const Vec2d& b, const Vec2d& c) {
    return (b - a).cross(c - a);
}

// Corners at random, and edges that cross exchanged until none do.
std::vector<Vec2d> simple_outline(std::size_t corners, std::mt19937& random) {
    std::uniform_real_distribution<double> at(0.0, 1.0);
    std::vector<Vec2d> p(corners);
    for (Vec2d& corner : p) corner = {at(random), at(random)};
    const auto meet = [&](std::size_t i, std::size_t j) {
        const Vec2d &a = p[i], &b = p[i + 1], &c = p[j], &d = p[(j + 1) % corners];
        return (cross(a, b, c) > 0) != (cross(a, b, d) > 0) && (cross(c, d, a) > 0) != (cross(c, d, b) > 0);
    };
    for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t i = 0; i < corners; ++i)
            for (std::size_t j = i + 2; j < corners; ++j)
                if ((j + 1) % corners != i && meet(i, j)) {
                    std::reverse(p.begin() + static_cast<std::ptrdiff_t>(i + 1),
                                 p.begin() + static_cast<std::ptrdiff_t>(j + 1));
                    changed = true;
                }
    }
    return p;
}

// With corners on their edges, repeated ones, and spikes there and back: floats round all of them off their lines.
TEST_P(TurnedFrame, SimpleOutlinesWithCornersOnTheirEdgesAreCovered) {
    std::mt19937 random(static_cast<unsigned>(GetParam()));
    std::uniform_real_distribution<double> draw(0.0, 1.0);
    for (std::size_t corners = 4; corners < 24; ++corners) {
        const std::vector<Vec2d> outline = simple_outline(corners, random);
        Polygon polygon;
        double twice = 0.0;
        const auto add = [&](const Vec2d& at) { polygon.positions.push_back(place(at.x, at.y)); };
        for (std::size_t i = 0; i < corners; ++i) {
            const Vec2d &a = outline[i], &b = outline[(i + 1) % corners];
            const Vec2d between = a + (b - a) * draw(random);
            twice += a.x * b.y - a.y * b.x;
            add(a);
            if (draw(random) < 0.1) add(a);
            if (draw(random) < 0.3) add(between);
            if (draw(random) >= 0.1) continue;
            add(b);
            add(between);
        }
        const Triangulation result = triangulate(polygon);
        ASSERT_EQ(result.fault, "");
        EXPECT_NEAR(area(polygon, result), std::abs(twice) / 2.0, 5e-5);
    }
}

INSTANTIATE_TEST_SUITE_P(Places, TurnedFrame, testing::Range(0, 30));

// The width of this face is just resolved by floats far from the origin.
TEST(Triangulate, NarrowFacesFarAwayAreKept) {
    const Polygon narrow{{{1000, 0, 0}, {1001, 0, 0}, {1001, 0, 1e-5f}, {1000, 0, 1e-5f}}, {}};
    EXPECT_NEAR(area(narrow, triangulate(narrow)), 1e-5, 1e-9);
}

TEST(Triangulate, TheLargestAndTheSmallestCoordinatesAreTaken) {
    for (const float size : {1e18f, 1e-18f, 1e-40f}) {
        Polygon l{{{2, 1, 0}, {2, 1, -1}, {1, 1, -1}, {1, 1, -2}, {0, 1, -2}, {0, 1, 0}}, {}};
        for (Vec3f& at : l.positions) at *= size / 2;
        const double scale = static_cast<double>(size) / 2;
        EXPECT_NEAR(area(l, triangulate(l)) / (scale * scale), 3.0, 1e-3) << size;
    }
}

}  // namespace
}  // namespace shadowbench::scene
