// Anisotropic filtering of deep shadow maps: footprints that are parallelograms, answered by several probes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "techniques/built.h"
#include "techniques/deep/deep.h"
#include "techniques/deep/probes.h"
#include "techniques/deep_levels.h"

namespace shadowbench::techniques {
namespace {

using nlohmann::json;
using rays::testing::directional;
using rays::testing::quad;
using testing::build;
using testing::Built;

const Technique& deep() {
    return find("deep", "");
}

float shaped(const Map& map, const Query& q, const Footprint& f) {
    float v = -1.0f;
    map.lookup_shaped({&q, 1}, {&f, 1}, {&v, 1});
    return v;
}

// The edges of a rectangle `length` by `width`, its long axis at this angle.
Footprint turned(double length, double width, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    return {static_cast<float>(length * c), static_cast<float>(length * s), static_cast<float>(-width * s),
            static_cast<float>(width * c)};
}

std::vector<curves::Curve> functions_of(const DeepLevel& level) {
    std::vector<curves::Curve> functions;
    for (int y = 0; y < level.height; ++y)
        for (int x = 0; x < level.width; ++x) functions.push_back(testing::curve_of(level, x, y, 0));
    return functions;
}

// The mean of a map's functions over a parallelogram by many points of it, in double.
double brute_force(const std::vector<curves::Curve>& functions, int width, const Query& q, const Footprint& f) {
    constexpr int points = 100;
    double sum = 0.0;
    for (int j = 0; j < points; ++j)
        for (int i = 0; i < points; ++i) {
            const double s = (i + 0.5) / points - 0.5, t = (j + 0.5) / points - 0.5;
            const int x = static_cast<int>(std::floor(q.x + s * f.ux + t * f.vx));
            const int y = static_cast<int>(std::floor(q.y + s * f.uy + t * f.vy));
            sum += curves::evaluate(functions[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + x], q.z);
        }
    return sum / (points * points);
}

struct Moments {
    double xx = 0, xy = 0, yy = 0;
};

// Of the probes: squares of their width at their places, about the query.
Moments moments(const Probes& probes) {
    Moments m;
    for (int i = 0; i < probes.count; ++i) {
        const Query p = probes.at({0, 0, 0, 0}, i);
        const double own = static_cast<double>(probes.width) * probes.width / 12.0;
        m.xx += (static_cast<double>(p.x) * p.x + own) / probes.count;
        m.xy += static_cast<double>(p.x) * p.y / probes.count;
        m.yy += (static_cast<double>(p.y) * p.y + own) / probes.count;
    }
    return m;
}

// A uniform parallelogram with the edges u and v has the covariance (u u^T + v v^T) / 12.
Moments moments(const Footprint& f) {
    return {(static_cast<double>(f.ux) * f.ux + static_cast<double>(f.vx) * f.vx) / 12.0,
            (static_cast<double>(f.ux) * f.uy + static_cast<double>(f.vx) * f.vy) / 12.0,
            (static_cast<double>(f.uy) * f.uy + static_cast<double>(f.vy) * f.vy) / 12.0};
}

TEST(DeepProbes, HaveTheSecondMomentsOfTheirParallelogram) {
    base::Random random(3);
    int several = 0;
    for (int i = 0; i < 2000; ++i) {
        const auto edge = [&] { return static_cast<float>(random.uniform(-20, 20)); };
        const Footprint f{edge(), edge(), edge(), edge()};
        Probes probes;
        ASSERT_TRUE(probes_of(f, 1000000, probes));
        if (probes.width < 1.001f) continue;  // widened to a pixel
        several += probes.count > 1;
        const Moments wanted = moments(f), found = moments(probes);
        const double scale = wanted.xx + wanted.yy;
        ASSERT_NEAR(found.xx, wanted.xx, 1e-5 * scale) << f.ux << " " << f.uy << " " << f.vx << " " << f.vy;
        ASSERT_NEAR(found.xy, wanted.xy, 1e-5 * scale);
        ASSERT_NEAR(found.yy, wanted.yy, 1e-5 * scale);
        const double gap = std::hypot(probes.step_x, probes.step_y);
        ASSERT_LE(gap, probes.width * (1.0 + 1e-5)) << "no gaps";
    }
    EXPECT_GT(several, 1000);
}

TEST(DeepProbes, AreAsManyAsTheLongAxisIsLongerThanTheShortOne) {
    const auto count = [](const Footprint& f, int most = 100) {
        Probes probes;
        EXPECT_TRUE(probes_of(f, most, probes));
        return std::pair(probes.count, probes.width);
    };
    EXPECT_EQ(count({3, 0, 0, 3}), std::pair(1, 3.0f)) << "a square";
    EXPECT_EQ(count({0, -3, 3, 0}), std::pair(1, 3.0f)) << "the same, turned by a right angle";
    EXPECT_EQ(count({8, 0, 0, 2}), std::pair(4, 2.0f));
    EXPECT_EQ(count({0, 2, 8, 0}), std::pair(4, 2.0f));
    EXPECT_EQ(count({8, 0, 0, 2}, 2), std::pair(2, 4.0f)) << "fewer are wider: no gaps";
    EXPECT_EQ(count({8, 0, 0, 2}, 1), std::pair(1, 8.0f)) << "one covers the long axis";
    EXPECT_EQ(count({9, 0, 0, 2}), std::pair(5, 2.0f)) << "rounded up";
    EXPECT_EQ(count({8, 0, 0, 0.01f}), std::pair(8, 1.0f)) << "never narrower than a pixel";
    EXPECT_EQ(count({0.5f, 0, 0, 0.1f}), std::pair(1, 0.5f)) << "inside a pixel";
    EXPECT_EQ(count({6, 6, 6, 6}), std::pair(12, 1.0f)) << "edges that are parallel: a line as long as both";
    const auto [many, width] = count({1, 0, 7, 1});     // sheared: the axes are not the edges
    const double longer = (std::sqrt(53.0) + 7.0) / 2;  // of the eigenvalues of [[50, 7], [7, 1]]: product 1, sum 51
    EXPECT_EQ(many, static_cast<int>(std::ceil(longer)));
    EXPECT_EQ(width, 1.0f);
    Probes probes;
    EXPECT_FALSE(probes_of({}, 8, probes));
    EXPECT_FALSE(probes_of({std::numeric_limits<float>::infinity(), 0, 0, 1}, 8, probes));
    EXPECT_FALSE(probes_of({1, 0, 0, std::numeric_limits<float>::quiet_NaN()}, 8, probes));
}

// Whole numbers of probes tile a rectangle along the map's axes: nothing is approximated.
TEST(DeepProbes, OverARectangleAlongTheAxesGiveItsExactMean) {
    const Built b = build(deep(), testing::hairy_scene(true), directional(), rays::testing::rays(32, 4),
                          R"({"probes": 16, "tolerance": 0.01})");
    base::Random random(8);
    for (const auto& [f, half_x, half_y] : {std::tuple{Footprint{8, 0, 0, 2}, 4.0, 1.0},
                                            {Footprint{0, 2, 8, 0}, 4.0, 1.0},
                                            {Footprint{0, 12, 3, 0}, 1.5, 6.0}})
        for (int i = 0; i < 50; ++i) {
            const Query q{static_cast<float>(random.uniform(6, 26)), static_cast<float>(random.uniform(6, 26)),
                          static_cast<float>(random.uniform(0.5, 1.6)), 1.0f};
            double sum = 0.0;
            for (int y = 0; y < 32; ++y)
                for (int x = 0; x < 32; ++x) {
                    const auto part = [](double at, double place, double half) {
                        return std::max(std::min(at + 1, place + half) - std::max(at, place - half), 0.0);
                    };
                    const double area = part(x, q.x, half_x) * part(y, q.y, half_y);
                    if (area > 0.0) sum += area * curves::evaluate(testing::curve_of(levels(*b.map)[0], x, y, 0), q.z);
                }
            ASSERT_NEAR(shaped(*b.map, q, f), sum / (4.0 * half_x * half_y), 3e-6) << q.x << " " << q.y;
        }
}

// A half plane in shade, at any angle of the footprint: the share of light is the part of the parallelogram beyond the
// edge, a closed form for a rectangle parallel to it.
TEST(DeepProbes, FollowAnEdgeAlongAndAcrossTheirLongAxis) {
    scene::Scene scene;
    scene.objects.push_back(quad({-1, -1, 0}, {1, 0, 0}, {0, 2, 0}));  // x < 32 of 64 pixels
    const Built b = build(deep(), scene, directional(), rays::testing::rays(64, 1), R"({"probes": 16})");
    for (const float x : {27.0f, 29.5f, 31.0f, 32.0f, 33.25f, 36.0f}) {
        const auto beyond = [&](double width) { return std::clamp((x + 0.5 * width - 32.0) / width, 0.0, 1.0); };
        EXPECT_NEAR(shaped(*b.map, {x, 32, 5, 1}, {12, 0, 0, 3}), beyond(12), 1e-5) << x;
        EXPECT_NEAR(shaped(*b.map, {x, 32, 5, 1}, {0, 12, 3, 0}), beyond(3), 1e-5) << x;
        EXPECT_NEAR(shaped(*b.map, {x, 32, 5, 1}, {0, 3, 12, 0}), beyond(12), 1e-5) << x;
    }
}

// What it is for: nearer to the exact mean over a turned, thin footprint than one square lookup is, with and without
// mip levels.
TEST(DeepProbes, AreNearerToTheExactMeanThanOneSquare) {
    for (const char* mip : {"none", "nearest", "blend"}) {
        const auto map = [&](int probes) {
            return build(deep(), testing::hairy_scene(true), directional(), rays::testing::rays(64, 4),
                         json{{"probes", probes}, {"mip", mip}, {"tolerance", 0.002}}.dump().c_str());
        };
        const Built many = map(16), few = map(2), one = map(1), square = map(0);
        const Built exact =
            build(deep(), testing::hairy_scene(true), directional(), rays::testing::rays(64, 4), R"({"tolerance": 0})");
        const auto functions = functions_of(levels(*exact.map)[0]);
        base::Random random(12);
        double sum[4] = {};
        for (int i = 0; i < 150; ++i) {
            const Footprint f = turned(18, 3, random.uniform(0, 3.14));
            const Query q{static_cast<float>(random.uniform(16, 48)), static_cast<float>(random.uniform(16, 48)),
                          static_cast<float>(random.uniform(0.6, 1.5)), std::sqrt(18.0f * 3.0f)};  // equal areas
            const double truth = brute_force(functions, 64, q, f);
            const Map* const maps[] = {many.map.get(), few.map.get(), one.map.get(), square.map.get()};
            for (int m = 0; m < 4; ++m) sum[m] += std::pow(shaped(*maps[m], q, f) - truth, 2.0);
        }
        EXPECT_LT(sum[0], 0.25 * sum[2]) << mip << ": half the error of a square as wide as the long axis";
        EXPECT_LT(sum[0], 0.25 * sum[3]) << mip << ": half the error of a square of the same area";
        EXPECT_LT(sum[0], sum[1]) << mip << ": more probes";
        EXPECT_LT(sum[1], sum[2]) << mip << ": more probes";
    }
}

TEST(DeepProbes, AnswerSquaresAndUnknownFootprintsAsLookupsWithoutFootprints) {
    for (const char* parameters : {R"({"probes": 8})", R"({"probes": 8, "mip": "nearest", "kernel": "tent"})",
                                   R"({"probes": 1, "mip": "blend"})", R"({"probes": 8, "kernel": "pixels"})"}) {
        const Built b =
            build(deep(), testing::hairy_scene(true), directional(), rays::testing::rays(32, 4), parameters);
        base::Random random(2);
        for (int i = 0; i < 200; ++i) {
            const float w = std::exp(static_cast<float>(random.uniform(-1, 4)));
            const Query q{static_cast<float>(random.uniform(-1, 33)), static_cast<float>(random.uniform(-1, 33)), 1.0f,
                          w};
            ASSERT_EQ(shaped(*b.map, {q.x, q.y, q.z, 1.0f}, {w, 0, 0, w}), b.lookup(q.x, q.y, q.z, w)) << parameters;
            ASSERT_EQ(shaped(*b.map, q, {}), b.lookup(q.x, q.y, q.z, w)) << parameters;
        }
    }
    const Built b = build(deep(), testing::hairy_scene(true), directional(), rays::testing::rays(32, 4));
    EXPECT_EQ(shaped(*b.map, {16, 16, 1, 2}, {20, 0, 0, 1}), b.lookup(16, 16, 1, 2)) << "without probes, as asked";
}

// Cut to the map, as every footprint is: the parts outside do not count as lit.
TEST(DeepProbes, AtTheBorderOnlyCountInsideTheMap) {
    scene::Scene scene;
    scene.objects.push_back(quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}));  // all in shade
    for (const char* parameters : {R"({"probes": 16})", R"({"probes": 16, "mip": "blend"})"}) {
        const Built b = build(deep(), scene, directional(), rays::testing::rays(16, 1), parameters);
        for (const float x : {0.01f, 0.5f, 8.0f, 15.99f})
            for (const double angle : {0.0, 0.8, 1.5707, 2.4}) {
                EXPECT_EQ(shaped(*b.map, {x, 0.3f, 5, 1}, turned(20, 2, angle)), 0.0f) << x << " " << angle;
                EXPECT_EQ(shaped(*b.map, {x, 15.9f, 5, 1}, turned(200, 2, angle)), 0.0f) << x << " " << angle;
            }
        EXPECT_EQ(shaped(*b.map, {-0.1f, 8, 5, 1}, turned(20, 2, 0)), 1.0f) << "outside: lit";
        // A diagonal through a corner, whose two probes both lie outside.
        EXPECT_EQ(shaped(*b.map, {0.2f, 0.2f, 5, 1}, turned(4, 2, 2.356)), 0.0f);
    }
}

TEST(DeepProbes, TouchTheLinesOfAllProbes) {
    const Built b = build(deep(), testing::hairy_scene(true), directional(), rays::testing::rays(64, 4),
                          R"({"probes": 16, "tolerance": 0.001})");
    std::vector<const void*> lines, one;
    const Query q{32, 32, 1, 2};
    b.map->touched_shaped(q, {24, 0, 0, 2}, lines);
    b.map->touched(q, one);
    EXPECT_GT(lines.size(), 3 * one.size());
    std::sort(one.begin(), one.end());
    EXPECT_FALSE(one.empty());
    std::vector<const void*> unknown;
    b.map->touched_shaped(q, {}, unknown);
    EXPECT_EQ(unknown, one);
}

}  // namespace
}  // namespace shadowbench::techniques
