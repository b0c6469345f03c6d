// The truth of objects that move while the shutter is open scatters about its closed form as its stated errors say.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>

#include <nlohmann/json.hpp>

#include "bench/half_space.h"
#include "bench/reference.h"
#include "bench/run.h"
#include "document/document.h"
#include "rays/scenes.h"

namespace shadowbench::bench {
namespace {

using base::Vec2d;
using base::Vec3d;
using techniques::Query;
using testing::half_space_in_cube;

TEST(MovingTruth, AHalfSpaceInACubeIsKnown) {
    EXPECT_NEAR(half_space_in_cube({1, 1, 1}, 1), 1.0 / 6, 1e-15);
    EXPECT_NEAR(half_space_in_cube({-1, -1, -1}, -1), 5.0 / 6, 1e-15);
    EXPECT_NEAR(half_space_in_cube({0.3, -0.8, 0.1}, -0.2), 0.5, 1e-12) << "through the middle";
    EXPECT_NEAR(half_space_in_cube({1, 1, 1}, 7), 1, 1e-12);
}

// A strip across the map between two parallel edges, at z = 0 of the world: n . p in [low, high] + speed t.
struct Strip {
    Vec2d n;
    double low, high, speed;
};

scene::Object quad_of(const Strip& s, const Vec2d& drift) {
    const Vec2d along(-s.n.y, s.n.x);
    const auto at = [&](double across, double on) {
        const Vec2d p = s.n * across + along * on;
        return base::Vec3f(static_cast<float>(p.x), static_cast<float>(p.y), 0.0f);
    };
    const base::Vec3f corner = at(s.low, -6);
    scene::Object object = rays::testing::quad(corner, at(s.high, -6) - corner, at(s.low, 6) - corner);
    object.motion = {static_cast<float>(drift.x), static_cast<float>(drift.y), 0.0f};
    return object;
}

// The share of the strip in the box [x0, x1] x [y0, y1] of the world and the shutter time.
double coverage(const Strip& s, const Vec2d& low, const Vec2d& high) {
    const auto below = [&](double edge) {  // n . (low + u (high - low)) - speed t < edge
        return half_space_in_cube({s.n.x * (high.x - low.x), s.n.y * (high.y - low.y), -s.speed}, edge - s.n.dot(low));
    };
    return below(s.high) - below(s.low);
}

TEST(MovingTruth, TenThousandTruthsOfAMovingQuadScatterAsTheirStatedErrorsSay) {
    constexpr int resolution = 8, wanted = 10000;
    double sum = 0.0, squares = 0.0, stated = 0.0;
    int truths = 0, held = 0;
    for (std::uint64_t seed = 0; truths < wanted; ++seed) {
        ASSERT_LT(seed, 5000u);
        base::Random random(base::hash(seed, 17));
        Strip s;
        double angle = random.uniform(0.0, 6.2831853);
        if (std::abs(std::sin(2 * angle)) < 0.02) angle += 0.05;  // the closed form divides by both parts of n
        s.n = {std::cos(angle), std::sin(angle)};
        s.low = random.uniform(-1.2, 0.6);
        s.high = s.low + random.uniform(0.1, 1.0);
        s.speed = std::exp(random.uniform(std::log(0.02), std::log(3.0)));
        if (random.uniform() < 0.5) s.low -= s.speed, s.high -= s.speed;
        const double slide = random.uniform(-1, 1);  // along its own edges, which changes nothing

        scene::Scene scene;
        scene.objects.push_back(quad_of(s, s.n * s.speed + Vec2d(-s.n.y, s.n.x) * slide));
        const scene::Light light =
            seed % 2 ? rays::testing::directional() : rays::testing::spot({0, 0, 2}, random.uniform(20, 60));
        scene::RaySettings settings = rays::testing::rays(resolution, seed % 3 ? 1024 : 1000);
        settings.seed = seed;
        const rays::LightView view = rays::make_light_view(light, scene, settings.resolution, "/lights/0");
        const Vec3d zero = rays::to_light(view, {0, 0, 0}), one = rays::to_light(view, {1, 1, 0});
        const Vec2d scale(one.x - zero.x, one.y - zero.y);

        std::vector<Query> queries;
        std::vector<double> expected;
        for (int pixel = 0; pixel < resolution * resolution; ++pixel) {
            // The footprints share no rays: each is one pixel or a part of one.
            const double width = pixel % 2 ? 1.0 : random.uniform(0.3, 1.0), free = 0.5 * (1.0 - width);
            const Vec2d middle(pixel % resolution + 0.5 + random.uniform(-free, free),
                               pixel / resolution + 0.5 + random.uniform(-free, free));
            const Vec2d a = (middle - Vec2d(0.5 * width) - Vec2d(zero.x, zero.y)) / scale,
                        b = (middle + Vec2d(0.5 * width) - Vec2d(zero.x, zero.y)) / scale;
            const double covered =
                coverage(s, {std::min(a.x, b.x), std::min(a.y, b.y)}, {std::max(a.x, b.x), std::max(a.y, b.y)});
            if (covered < 0.1 || covered > 0.9) continue;  // with few differing rays the stated error is unreliable
            queries.push_back({static_cast<float>(middle.x), static_cast<float>(middle.y),
                               static_cast<float>(zero.z + 1.0), static_cast<float>(width)});
            expected.push_back(1.0 - covered);
        }
        if (queries.empty()) continue;
        const Truth truth = reference_visibility(scene, view, settings, queries, {});
        for (std::size_t q = 0; q < queries.size(); ++q) {
            const double off = truth.value[q] - expected[q];
            sum += off;
            squares += off * off;
            stated += truth.standard_error[q] * truth.standard_error[q];
            held += std::abs(off) <= 2.36462 * truth.standard_error[q];  // 95 % of Student's t, 7 degrees of freedom
        }
        truths += static_cast<int>(queries.size());
    }
    RecordProperty("held", held);
    RecordProperty("ratio", std::to_string(squares / stated));
    // The share has a standard deviation of 0.22 % if it is 95 %.
    EXPECT_GE(held, 0.93 * truths);
    EXPECT_LE(held, 0.97 * truths);
    EXPECT_NEAR(squares / stated, 1.0, 0.1);
    EXPECT_LT(std::abs(sum), 4.0 * std::sqrt(squares)) << "no bias to either side";
}

// Moving quads, spheres, particles and layers, and one receiver.
nlohmann::json shutter_times() {
    std::ifstream file(std::filesystem::path(SHADOWBENCH_SOURCE_DIR) / "tests" / "bench" / "shutter_times.json");
    return nlohmann::json::parse(file);
}

TEST(MovingTruth, IsTheSameAtEverySeedAndForTracedRays) {
    nlohmann::json document = shutter_times();
    for (const char* setting : {"timing.repetitions=1", "timing.lookups=64", "reference.spread_seeds=0"})
        document::set_value(document, setting);
    for (const int seed : {1, 35, 36, 37, 1234567}) {
        document::set_value(document, "reference.seed=" + std::to_string(seed));
        const results::LightResult light = run(document, {}, {}).variants.at(0).lights.at(0);
        ASSERT_EQ(light.cells.size(), 1u);
        const results::Cell& traced = light.cells[0];
        ASSERT_EQ(traced.status, results::CellStatus::ok) << traced.reason;
        EXPECT_GT(light.reference.error_max, 0.0);
        EXPECT_LT(light.reference.error_max, 0.015);
        // Three channels; there are 64 times as many shadow rays as rays of the truth.
        EXPECT_LT(traced.lookup->norms.max, 4.0 * light.reference.error_max) << "seed " << seed;
    }
}

}  // namespace
}  // namespace shadowbench::bench
