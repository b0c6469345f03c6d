// Scenes whose filtered visibility has a closed form, which the truth and the techniques must find.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "bench/reference.h"
#include "rays/scenes.h"
#include "techniques/built.h"

namespace shadowbench::bench {
namespace {

using techniques::Query;
using techniques::testing::build;
using techniques::testing::slab;

// The area of the disc x^2 + y^2 <= r^2 inside [x0, x1] x [y0, y1]. Between the places where the circle meets the box,
// each boundary of the region is a constant or the circle, whose integral is (x s + r^2 asin(x / r)) / 2 with s =
// sqrt(r^2 - x^2).
double disc_in_box(double r, double x0, double x1, double y0, double y1) {
    const auto s = [&](double x) { return std::sqrt(std::max(r * r - x * x, 0.0)); };
    const auto circle = [&](double x) { return 0.5 * (x * s(x) + r * r * std::asin(std::clamp(x / r, -1.0, 1.0))); };
    std::vector<double> cuts = {x0, x1, -r, r};
    for (const double y : {y0, y1}) {
        cuts.push_back(s(y));
        cuts.push_back(-s(y));
    }
    for (double& c : cuts) c = std::clamp(c, x0, x1);
    std::sort(cuts.begin(), cuts.end());
    double area = 0.0;
    for (std::size_t i = 1; i < cuts.size(); ++i) {
        const double a = cuts[i - 1], b = cuts[i], middle = 0.5 * (a + b), h = s(middle);
        if (std::abs(middle) >= r || std::min(y1, h) <= std::max(y0, -h)) continue;
        area += (h < y1 ? circle(b) - circle(a) : y1 * (b - a)) + (-h > y0 ? circle(b) - circle(a) : -y0 * (b - a));
    }
    return area;
}

TEST(Analytic, TheAreaOfADiscInABoxIsRightInKnownCases) {
    EXPECT_NEAR(disc_in_box(1, -2, 2, -2, 2), std::acos(-1.0), 1e-12);
    EXPECT_NEAR(disc_in_box(1, 0, 2, 0, 2), std::acos(-1.0) / 4, 1e-12);
    EXPECT_NEAR(disc_in_box(2, -1, 1, -1, 1), 4, 1e-12);
    EXPECT_EQ(disc_in_box(1, 0.8, 2, 0.8, 2), 0.0);
    double sum = 0.0;  // an arbitrary place, by counting
    for (int i = 0; i < 1000; ++i)
        for (int j = 0; j < 1000; ++j)
            sum += std::hypot(0.1 + 0.7 * (i + 0.5) / 1000, -0.9 + 1.4 * (j + 0.5) / 1000) <= 0.8;
    EXPECT_NEAR(disc_in_box(0.8, 0.1, 0.8, -0.9, 0.5), sum * 0.7e-3 * 1.4e-3, 2e-4);
}

Truth truth_of(const scene::Scene& scene, const scene::Light& light, const scene::RaySettings& settings,
               const std::vector<Query>& queries) {
    const rays::LightView view = rays::make_light_view(light, scene, settings.resolution, "/lights/0");
    return reference_visibility(scene, view, settings, queries, [](std::size_t, std::size_t) {});
}

TEST(Analytic, TheEdgeOfAnOpaqueDiscIsFilteredToItsCoverage) {
    constexpr double radius = 0.6;
    constexpr int resolution = 32;
    scene::Scene scene;
    scene.objects.emplace_back();
    scene.objects[0].shape = scene::Spheres{{{0, 0, 0}}, {static_cast<float>(radius)}};
    std::vector<Query> queries;
    std::vector<double> expected;
    for (int i = 0; i < 300; ++i) {
        base::Random random(i);
        const double around = random.uniform(0, 6.2831853), away = 16 + random.uniform(-3, 3) - 16 + radius * 16;
        const Query q{static_cast<float>(16 + away * std::cos(around)),
                      static_cast<float>(16 + away * std::sin(around)), 5.0f,
                      static_cast<float>(random.uniform(0.5, 4))};
        const double h = q.width / 32.0, x = q.x / 16.0 - 1, y = q.y / 16.0 - 1;  // map pixels to world
        queries.push_back(q);
        expected.push_back(1.0 - disc_in_box(radius, x - h, x + h, y - h, y + h) / (4 * h * h));
    }
    const auto settings = rays::testing::rays(resolution, 400);
    const Truth truth = truth_of(scene, rays::testing::directional(), settings, queries);
    int partly = 0, halved = 0, outside = 0;
    for (std::size_t i = 0; i < queries.size(); ++i) {
        partly += expected[i] > 0.02 && expected[i] < 0.98;
        if (expected[i] < 0.1 || expected[i] > 0.9) continue;  // with few differing rays, intervals are unreliable
        ++halved;
        outside += std::abs(truth.value[i] - expected[i]) > 2.36462 * truth.standard_error[i] + 1e-5;
    }
    EXPECT_GT(partly, 100) << "the test must look at edges";
    EXPECT_GT(halved, 50);
    EXPECT_LT(outside, 0.05 * halved + 4 * std::sqrt(0.05 * 0.95 * halved)) << "95 % intervals";

    // Shadow rays: their number gives their worst standard error.
    const auto traced = build(techniques::find("ray_traced", ""), scene, rays::testing::directional(),
                              rays::testing::rays(resolution, 1), R"({"samples": 400})");
    const auto filtered =
        build(techniques::find("pcf", ""), scene, rays::testing::directional(), rays::testing::rays(resolution, 64),
              R"({"num_samples": 400, "res_factor": 1, "min_size": 0})");
    const auto exact = build(techniques::find("uncompressed", ""), scene, rays::testing::directional(), settings);
    for (std::size_t i = 0; i < queries.size(); ++i) {
        const double sigma = 3 * std::sqrt(expected[i] * (1 - expected[i]) / 400) + 2e-3;
        const auto ask = [&](const auto& b) { return b.lookup(queries[i].x, queries[i].y, 5.0f, queries[i].width); };
        EXPECT_NEAR(ask(traced), expected[i], sigma);
        EXPECT_NEAR(ask(exact), expected[i], sigma);
        // The depth map holds 8 x 8 samples a pixel, the resolution of a region's border.
        EXPECT_NEAR(ask(filtered), expected[i], sigma + 0.06 / std::min(queries[i].width, 1.0f));
    }
}

TEST(Analytic, LayeredSlabsMultiply) {
    struct Layer {
        float extinction;
        double front, back;
    };
    const std::array<Layer, 3> layers = {
        {{0.5f, 0.9, 0.5}, {4.0f, 0.4, 0.1}, {1.0f, 0.2, -0.8}}};  // the last two overlap
    scene::Scene scene;
    for (const Layer& l : layers) scene.objects.push_back(slab(l.extinction, l.front, l.back, 0.01));
    for (const auto& light : {rays::testing::directional(), rays::testing::spot({0, 0, 4}, 20)}) {
        const auto settings = rays::testing::rays(8, 16);
        const auto exact = build(techniques::find("uncompressed", ""), scene, light, settings);
        const auto traced = build(techniques::find("ray_traced", ""), scene, light, settings);
        const auto deep = build(techniques::find("deep", ""), scene, light, settings, R"({"tolerance": 0.01})");
        const auto avsm = build(techniques::find("avsm", ""), scene, light, settings, R"({"nodes": 16})");
        std::vector<Query> queries;
        std::vector<double> expected;
        for (double depth = 0.85; depth > -1; depth -= 0.0637) {
            const double z = to_light(exact.rays.view, {0, 0, depth}).z;
            queries.push_back({4.0f, 4.0f, static_cast<float>(z), 1.0f});
            double optical_depth = 0.0;
            for (const Layer& l : layers)
                optical_depth += l.extinction * std::clamp(l.front - depth, 0.0, l.front - l.back);
            // The mean over the pixel's rays of exp(-s optical_depth): s differs by less than 0.02 over this pixel.
            expected.push_back(std::exp(-optical_depth * length_per_depth(exact.rays.view, 4.25, 4.25)));
        }
        const Truth truth = truth_of(scene, light, settings, queries);
        for (std::size_t i = 0; i < queries.size(); ++i) {
            const auto ask = [&](const auto& b) { return b.lookup(queries[i].x, queries[i].y, queries[i].z); };
            EXPECT_NEAR(truth.value[i], expected[i], 5e-4);
            EXPECT_NEAR(ask(exact), expected[i], 5e-4);
            EXPECT_NEAR(ask(traced), expected[i], 5e-4);
            EXPECT_NEAR(ask(deep), expected[i], 0.01 + 5e-4);
            EXPECT_NEAR(ask(avsm), expected[i], 0.02);
        }
    }
}

TEST(Analytic, RandomOpaqueLayersTransmitAsProbabilitySays) {
    // Each of n layers covers each cell of a 24 x 24 grid independently with probability p. Behind k layers (1 - p)^k
    // of the light is left, within the standard deviation of 576 such draws.
    constexpr int n = 6, cells = 24;
    constexpr double p = 0.3;
    base::Random random(12);
    scene::Scene scene;
    for (int layer = 0; layer < n; ++layer) {
        scene::Mesh mesh;
        for (int y = 0; y < cells; ++y)
            for (int x = 0; x < cells; ++x) {
                if (random.uniform() >= p) continue;
                const float size = 2.0f / cells, x0 = -1 + size * static_cast<float>(x),
                            y0 = -1 + size * static_cast<float>(y);
                const float z = -0.1f * static_cast<float>(layer);
                const int first = static_cast<int>(mesh.positions.size());
                for (const auto& [i, j] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}})
                    mesh.positions.emplace_back(x0 + size * static_cast<float>(i), y0 + size * static_cast<float>(j),
                                                z);
                mesh.triangles.emplace_back(first, first + 1, first + 2);
                mesh.triangles.emplace_back(first, first + 2, first + 3);
            }
        scene::Object object;
        object.shape = mesh;
        scene.objects.push_back(object);
    }
    const auto settings = rays::testing::rays(cells, 4);
    for (const char* id : {"deep", "avsm", "uncompressed", "shadow_map"}) {
        const auto b = build(techniques::find(id, ""), scene, rays::testing::directional(), settings);
        const double first_depth = to_light(b.rays.view, {0, 0, 0}).z;
        for (int k = 1; k <= n; ++k) {
            const double z = first_depth + 0.1 * (k - 1) + 0.05, expected = std::pow(1 - p, k);
            double sum = 0.0;
            for (int y = 0; y < cells; ++y)
                for (int x = 0; x < cells; ++x)
                    sum += b.lookup(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, static_cast<float>(z));
            EXPECT_NEAR(sum / (cells * cells), expected, 3 * std::sqrt(expected * (1 - expected) / (cells * cells)))
                << id << k;
        }
    }
}

}  // namespace
}  // namespace shadowbench::bench
