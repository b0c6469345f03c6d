#include "scene/polygon/sweep_polygon.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

namespace shadowbench::scene {
namespace {

using Outline = std::vector<GridPoint>;

double area(const Sweep& sweep, const Outline& outline) {
    double twice = 0.0;
    for (const Triple& t : sweep.triangles)
        twice += static_cast<double>(turn(outline[t[0]], outline[t[1]], outline[t[2]]));
    return twice / 2.0;
}

double signed_area(const Outline& outline) {
    double twice = 0.0;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const GridPoint &a = outline[i], &b = outline[(i + 1) % outline.size()];
        twice +=
            static_cast<double>(a.x) * static_cast<double>(b.y) - static_cast<double>(b.x) * static_cast<double>(a.y);
    }
    return twice / 2.0;
}

// The winding number from the crossings of a ray to the right; the point must not lie on an edge.
int winding(const Outline& outline, double x, double y) {
    int number = 0;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const GridPoint &a = outline[i], &b = outline[(i + 1) % outline.size()];
        const double ax = static_cast<double>(a.x), ay = static_cast<double>(a.y);
        const double bx = static_cast<double>(b.x), by = static_cast<double>(b.y);
        if ((ay <= y) == (by <= y) || ax + (y - ay) / (by - ay) * (bx - ax) <= x) continue;
        number += by > ay ? 1 : -1;
    }
    return number;
}

int covers(const Sweep& sweep, const Outline& outline, double x, double y) {
    return static_cast<int>(std::count_if(sweep.triangles.begin(), sweep.triangles.end(), [&](const Triple& t) {
        return winding({outline[t[0]], outline[t[1]], outline[t[2]]}, x, y) != 0;
    }));
}

bool any_cross(const Outline& outline) {
    const std::size_t n = outline.size();
    const auto sign = [](std::int64_t value) { return (value > 0) - (value < 0); };
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < i; ++j) {
            const GridPoint &a = outline[i], &b = outline[(i + 1) % n], &c = outline[j], &d = outline[(j + 1) % n];
            if (sign(turn(a, b, c)) * sign(turn(a, b, d)) < 0 && sign(turn(c, d, a)) * sign(turn(c, d, b)) < 0)
                return true;
        }
    return false;
}

std::string text(const Outline& outline) {
    std::string result;
    for (const GridPoint& p : outline) result += "(" + std::to_string(p.x) + "," + std::to_string(p.y) + ") ";
    return result;
}

Outline turned(Outline outline, std::size_t by) {
    std::rotate(outline.begin(), outline.begin() + static_cast<std::ptrdiff_t>(by), outline.end());
    return outline;
}

void expect_covered_once(const Sweep& sweep, const Outline& outline, int samples, std::mt19937& random) {
    const auto [left, right] = std::minmax_element(outline.begin(), outline.end());
    const auto by_y = [](const GridPoint& a, const GridPoint& b) { return a.y < b.y; };
    const auto [low, high] = std::minmax_element(outline.begin(), outline.end(), by_y);
    std::uniform_real_distribution<double> x(static_cast<double>(left->x) - 0.5, static_cast<double>(right->x) + 0.5);
    std::uniform_real_distribution<double> y(static_cast<double>(low->y) - 0.5, static_cast<double>(high->y) + 0.5);
    for (int i = 0; i < samples; ++i) {
        const double at_x = x(random), at_y = y(random);
        ASSERT_EQ(covers(sweep, outline, at_x, at_y), winding(outline, at_x, at_y) != 0 ? 1 : 0)
            << at_x << ", " << at_y << " in " << text(outline);
    }
}

TEST(SweepPolygon, TakesAnLFromEveryCorner) {
    const Outline l{{2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}, {0, 0}};
    std::mt19937 random(1);
    for (std::size_t by = 0; by < l.size(); ++by) {
        const Sweep sweep = sweep_polygon(turned(l, by), 0.0);
        EXPECT_EQ(sweep.triangles.size(), 4u);
        EXPECT_EQ(area(sweep, turned(l, by)), 3.0);
        EXPECT_EQ(sweep.overlap, 0.0);
        expect_covered_once(sweep, turned(l, by), 100, random);
    }
}

TEST(SweepPolygon, LeavesAHoleOutThatABridgeJoins) {
    const Outline outline{{0, 0}, {9, 0}, {9, 9}, {0, 9}, {0, 0}, {3, 3}, {3, 6}, {6, 6}, {6, 3}, {3, 3}};
    const Sweep sweep = sweep_polygon(outline, 0.0);
    EXPECT_EQ(area(sweep, outline), 81.0 - 9.0);
    EXPECT_EQ(sweep.overlap, 0.0);
}

// The bridge is passed whole one way and in two parts the other way.
TEST(SweepPolygon, ABridgeMayHaveACornerOnOneOfItsSides) {
    const Outline outline{{0, 0}, {9, 0}, {9, 9}, {0, 9}, {0, 0}, {2, 2}, {3, 3}, {3, 6}, {6, 6}, {6, 3}, {3, 3}};
    const Sweep sweep = sweep_polygon(outline, 0.0);
    EXPECT_EQ(area(sweep, outline), 81.0 - 9.0);
    EXPECT_EQ(sweep.overlap, 0.0);
}

TEST(SweepPolygon, ReportsAreasCoveredTwiceOrTurnedOver) {
    const Outline square{{0, 0}, {4, 0}, {4, 4}, {0, 4}};
    EXPECT_EQ(sweep_polygon(square, 0.0).overlap, 0.0);
    EXPECT_EQ(sweep_polygon({{0, 0}, {0, 4}, {4, 4}, {4, 0}}, 0.0).overlap, 32.0);
    Outline twice = square;
    twice.insert(twice.end(), square.begin(), square.end());
    EXPECT_EQ(sweep_polygon(twice, 0.0).overlap, 32.0);
    // Two triangles that meet in a corner, one of them the other way round.
    EXPECT_EQ(sweep_polygon({{0, 0}, {2, 2}, {4, 4}, {4, 0}, {2, 2}, {0, 4}}, 0.0).overlap, 8.0);
}

TEST(SweepPolygon, NamesTheEdgesThatCross) {
    const Sweep sweep = sweep_polygon({{0, 0}, {4, 4}, {4, 0}, {0, 4}}, 0.0);
    ASSERT_TRUE(sweep.crossing);
    EXPECT_EQ(std::min(sweep.crossing->first, sweep.crossing->second), 0u);
    EXPECT_EQ(std::max(sweep.crossing->first, sweep.crossing->second), 2u);
    EXPECT_TRUE(sweep.triangles.empty());
}

// A corner that should be on a slanted edge, but lies beyond it by rounding.
TEST(SweepPolygon, LeadsAnEdgeThroughACornerThatLiesJustBeyondIt) {
    const Outline outline{{0, 0}, {9000, 3001}, {0, 9000}, {6000, 2000}};
    EXPECT_TRUE(sweep_polygon(outline, 0.1).crossing);
    const Sweep sweep = sweep_polygon(outline, 1.0);
    EXPECT_FALSE(sweep.crossing);
    EXPECT_NEAR(area(sweep, outline), std::abs(signed_area(outline)), 9500.0);
    EXPECT_LT(sweep.overlap, 2.0 * 9500.0);
}

TEST(SweepPolygon, AnOutlineWithoutAreaHasNoTriangles) {
    for (const Outline& outline : {Outline{{1, 1}, {1, 1}, {1, 1}}, Outline{{0, 0}, {1, 1}, {3, 3}},
                                   Outline{{0, 0}, {5, 0}, {5, 5}, {5, 0}}, Outline{{0, 0}, {3, 0}, {1, 0}, {2, 0}}})
        EXPECT_TRUE(sweep_polygon(outline, 0.0).triangles.empty()) << text(outline);
}

// Few grid points: corners that coincide, edges that overlap or run through corners are the rule.
TEST(SweepPolygon, EveryOutlineOfFewGridPointsIsCoveredOnceOrCrossesItself) {
    std::mt19937 random(7);
    int done = 0, crossed = 0;
    for (int i = 0; i < 60'000; ++i) {
        std::uniform_int_distribution<std::int64_t> at(0, 2 + i % 4);
        Outline outline(static_cast<std::size_t>(3 + random() % 10));
        for (GridPoint& p : outline) p = {at(random), at(random)};
        const Sweep sweep = sweep_polygon(outline, 0.0);
        if (sweep.crossing) {
            ++crossed;
            ASSERT_TRUE(any_cross(outline)) << text(outline);
            continue;
        }
        ++done;
        expect_covered_once(sweep, outline, 20, random);
        if (sweep.overlap > 0.0) continue;
        ASSERT_EQ(area(sweep, outline), signed_area(outline)) << text(outline);
    }
    EXPECT_GT(done, 10'000);
    EXPECT_GT(crossed, 10'000);
}

// Corners in a random order, and edges that cross exchanged until none do: simple outlines of every shape.
Outline simple_outline(std::size_t corners, std::mt19937& random) {
    std::uniform_int_distribution<std::int64_t> at(0, 1000);
    Outline outline(corners);
    for (GridPoint& p : outline) p = {at(random), at(random)};
    const auto cross = [&](std::size_t i, std::size_t j) {
        const GridPoint &a = outline[i], &b = outline[(i + 1) % corners], &c = outline[j],
                        &d = outline[(j + 1) % corners];
        return (turn(a, b, c) > 0) != (turn(a, b, d) > 0) && (turn(c, d, a) > 0) != (turn(c, d, b) > 0);
    };
    for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t i = 0; i < corners; ++i)
            for (std::size_t j = i + 2; j < corners; ++j)
                if ((j + 1) % corners != i && cross(i, j)) {
                    std::reverse(outline.begin() + static_cast<std::ptrdiff_t>(i + 1),
                                 outline.begin() + static_cast<std::ptrdiff_t>(j + 1));
                    changed = true;
                }
    }
    if (signed_area(outline) < 0.0) std::reverse(outline.begin(), outline.end());
    return outline;
}

TEST(SweepPolygon, SimpleOutlinesAreCoveredOnceFromEveryCorner) {
    std::mt19937 random(3);
    for (int i = 0; i < 100; ++i) {
        const Outline outline = simple_outline(static_cast<std::size_t>(5 + i % 40), random);
        for (std::size_t by = 0; by < outline.size(); ++by) {
            const Outline from = turned(outline, by);
            const Sweep sweep = sweep_polygon(from, 0.0);
            ASSERT_FALSE(sweep.crossing) << text(from);
            ASSERT_EQ(sweep.overlap, 0.0);
            ASSERT_EQ(area(sweep, from), signed_area(from)) << text(from);
        }
        expect_covered_once(sweep_polygon(outline, 0.0), outline, 200, random);
    }
}

// Comparing every corner or edge with every other one would take hours here.
TEST(SweepPolygon, TakesAHundredThousandCorners) {
    constexpr int corners = 100'000;
    std::mt19937 random(5);
    std::uniform_real_distribution<double> radius(0.2, 1.0);
    Outline star, comb{{-1000, -1000}}, nested;
    for (int i = 0; i < corners; ++i) {
        const double angle = 2.0 * M_PI * i / corners, r = 5e8 * radius(random);
        star.push_back(
            {static_cast<std::int64_t>(r * std::cos(angle)), static_cast<std::int64_t>(r * std::sin(angle))});
        comb.push_back({i % 2 == 0 ? 0 : 500'000'000, 5000 * i});
        nested.push_back({i % 2 == 0 ? i : 1'000'000'000 - i, 0});
    }
    comb.push_back({-1000, 5000 * corners});
    std::reverse(comb.begin(), comb.end());
    nested.push_back({500'000'000, -7});
    for (Outline outline : {star, comb}) {
        if (signed_area(outline) < 0.0) std::reverse(outline.begin(), outline.end());
        const Sweep sweep = sweep_polygon(outline, 0.0);
        ASSERT_FALSE(sweep.crossing);
        EXPECT_EQ(sweep.overlap, 0.0);
        EXPECT_NEAR(area(sweep, outline), signed_area(outline), 1e-9 * signed_area(outline));
    }
    EXPECT_FALSE(sweep_polygon(nested, 0.0).crossing);
}

}  // namespace
}  // namespace shadowbench::scene
