// The truth of footprints so narrow that no captured ray falls into them, compared with closed forms: their own traced
// rays see edges inside the footprint, media and motion.
#include "bench/reference_traced.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>

#include "base/parallel.h"
#include "bench/half_covered.h"
#include "bench/half_space.h"
#include "bench/reference.h"
#include "rays/scenes.h"

namespace shadowbench::bench {
namespace {

using base::Vec2d;
using base::Vec3d;
using base::Vec3f;
using techniques::Query;
using testing::half_space_in_cube;

constexpr int resolution = 12, samples = 128;
constexpr double pixel = 2.0 / resolution;  // world length: the map spans [-1, 1]^2

// Where n . p < d + speed t, in map pixels; t is the time in the shutter.
struct HalfPlane {
    Vec2d n;
    double d, speed = 0.0;
};

// An edge at some angle through some place; no part of n is near 0, since the closed form divides by both.
HalfPlane any_half_plane(base::Random& random) {
    const double angle = random.uniform(0.05, 1.52) + 1.57079632679 * static_cast<double>(random.below(4));
    const Vec2d n(std::cos(angle), std::sin(angle));
    return {n, n.dot(Vec2d(random.uniform(3, 9), random.uniform(3, 9)))};
}

// The surface over a half plane of the map of rays::testing::directional(). It ends 20 pixels away from the edge.
scene::Object surface(const HalfPlane& half, double height, float opacity) {
    const Vec2d across = half.n, along(-half.n.y, half.n.x);
    const auto world = [&](double u, double v) {
        const Vec2d p = (across * u + along * v) * pixel - Vec2d(1, 1);
        return Vec3f(static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(height));
    };
    const Vec3f corner = world(half.d - 20, -20);
    scene::Object object =
        rays::testing::quad(corner, world(half.d, -20) - corner, world(half.d - 20, 20) - corner, opacity);
    const Vec2d motion = across * (half.speed * pixel);
    object.motion = {static_cast<float>(motion.x), static_cast<float>(motion.y), 0.0f};
    return object;
}

rays::LightView view_of(const scene::Scene& scene) {
    return rays::make_light_view(rays::testing::directional(), scene, {resolution, resolution}, "/lights/0");
}

scene::RaySettings settings_of(std::uint64_t seed) {
    scene::RaySettings settings = rays::testing::rays(resolution, samples);
    settings.seed = seed;
    return settings;
}

// The share of the footprint and the shutter that the surface covers.
double covered(const HalfPlane& half, const Query& q) {
    const double width = q.width;
    const Vec2d low(q.x - 0.5 * width, q.y - 0.5 * width);
    if (half.speed != 0.0)
        return half_space_in_cube({half.n.x * width, half.n.y * width, -half.speed}, half.d - half.n.dot(low));
    const Vec2d high = low + Vec2d(width, width);
    return testing::area(testing::clip({low, {high.x, low.y}, high, {low.x, high.y}}, half.n, half.d)) /
           (width * width);
}

// Eight footprints about 1 / 200 of a pixel wide, across the edge wherever it is while the shutter is
// open. Much narrower ones would show that Embree's single precision places edges up to some 1e-6 of a pixel away.
std::vector<Query> footprints(const HalfPlane& half, base::Random& random, float z) {
    std::vector<Query> queries;
    for (int i = 0; i < 8; ++i) {
        const double width = random.uniform(4e-3, 8e-3), edge = half.d + half.speed * random.uniform(0.2, 0.8);
        const Vec2d p =
            half.n * (edge + random.uniform(-0.4, 0.4) * width) +
            Vec2d(-half.n.y, half.n.x) * (Vec2d(-half.n.y, half.n.x).dot(Vec2d(6, 6)) + random.uniform(-1, 1));
        queries.push_back({static_cast<float>(p.x), static_cast<float>(p.y), z, static_cast<float>(width)});
    }
    return queries;
}

using Complete = std::function<void(scene::Scene&, HalfPlane&, base::Random&)>;

// How 3,000 truths scatter about their closed forms.
struct Scatter {
    int held = 0, cases = 0;  // in their 95 % intervals; all
    double sum = 0.0, squares = 0.0, stated = 0.0, largest = 0.0;

    double ratio() const { return squares / stated; }
};

// `behind` is the share of the light that passes where the surface, of this opacity, is not. A case counts if a set is
// expected to have 5 rays on either side, as in truth_coverage_test.cpp.
Scatter scatter_of(std::uint64_t key, double behind, float opacity, const Complete& complete) {
    Scatter scatter;
    for (std::uint64_t seed = 0; scatter.cases < 3000 && seed < 2000; ++seed) {
        base::Random random(base::hash(seed, key));
        HalfPlane half = any_half_plane(random);
        scene::Scene scene;
        complete(scene, half, random);
        scene.objects.push_back(surface(half, 0.8, opacity));
        const rays::LightView view = view_of(scene);
        const std::vector<Query> queries =
            footprints(half, random, static_cast<float>(rays::to_light(view, {0, 0, -0.9}).z));
        const Truth truth = reference_visibility(scene, view, settings_of(seed), queries, {});
        EXPECT_EQ(truth.degrees, 7);
        for (std::size_t q = 0; q < queries.size(); ++q) {
            const double share = covered(half, queries[q]);
            if (std::min(share, 1.0 - share) * samples / 8 < 5.0) continue;
            if (truth.standard_error[q] == 0.5) continue;  // one captured ray fell into it
            const double off = truth.value[q] - behind * (1.0 - opacity * share);
            scatter.held += std::abs(off) <= 2.36462 * truth.standard_error[q];
            scatter.sum += off;
            scatter.squares += off * off;
            scatter.stated += truth.standard_error[q] * truth.standard_error[q];
            scatter.largest = std::max(scatter.largest, std::abs(off));
            ++scatter.cases;
        }
    }
    EXPECT_GE(scatter.cases, 3000);
    EXPECT_LT(std::abs(scatter.sum), 4.0 * std::sqrt(scatter.squares)) << "no bias to either side";
    EXPECT_NEAR(scatter.ratio(), 1.0, 0.15) << "squared errors over those stated: the rule of truth_coverage_test.cpp";
    return scatter;
}

// 93 to 97 % of the intervals hold the closed form: the rule of truth_coverage_test.cpp.
void expect_coverage(const Scatter& scatter) {
    ::testing::Test::RecordProperty("held", scatter.held);
    EXPECT_GE(scatter.held, 0.93 * scatter.cases);
    EXPECT_LE(scatter.held, 0.97 * scatter.cases);
}

TEST(TracedTruth, KnowsAnEdgeInsideItsFootprint) {
    expect_coverage(scatter_of(201, 1.0, 1.0f, [](scene::Scene&, HalfPlane&, base::Random&) {}));
}

TEST(TracedTruth, KnowsAnEdgeAboveAMedium) {
    const auto with_medium = [](scene::Scene& scene, HalfPlane&, base::Random&) {
        scene::Object medium;  // of density 2, one unit thick
        medium.shape = rays::testing::slab();
        medium.extinction = Vec3f(0.3f);
        scene.objects.push_back(medium);
    };
    expect_coverage(scatter_of(202, std::exp(-0.3 * 2.0), 0.6f, with_medium));
}

// Place and time both decide what a ray sees.
TEST(TracedTruth, KnowsAnEdgeThatMovesInsideItsFootprint) {
    expect_coverage(scatter_of(203, 1.0, 1.0f, [](scene::Scene&, HalfPlane& half, base::Random& random) {
        half.speed = random.uniform(2e-3, 8e-3);
    }));
}

// Almost only the time decides. The 16 rays of a set have one time in each 16th of the shutter, so what a set sees is
// exact up to one ray. It takes two values, too few for Student's t; the stated errors are right on average.
TEST(TracedTruth, KnowsAnEdgeThatMovesFarAcrossItsFootprint) {
    const Scatter scatter = scatter_of(204, 1.0, 1.0f, [](scene::Scene&, HalfPlane& half, base::Random& random) {
        half.speed = random.uniform(0.5, 1.0);
    });
    EXPECT_LT(scatter.largest, 1.0 / 16 + 8e-3 * std::sqrt(2.0) / 0.5);
}

// Depths inside a medium: every ray sees the same, exactly.
TEST(TracedTruth, IsExactInsideAMedium) {
    scene::Scene scene;
    scene::Object medium;
    medium.shape = rays::testing::slab();
    medium.extinction = {0.3f, 0.6f, 0.9f};
    scene.objects.push_back(medium);
    const rays::LightView view = view_of(scene);
    std::vector<Query> queries;
    for (int i = 0; i < 20; ++i)
        queries.push_back({3.1f + 0.3f * static_cast<float>(i), 4.2f,
                           static_cast<float>(rays::to_light(view, {0, 0, 0.5 - 0.05 * i}).z), 1e-6f});
    const Truth truth = reference_visibility(scene, view, settings_of(1), queries, {});
    ASSERT_EQ(truth.channels, 3);
    const double front = rays::to_light(view, {0, 0, 0.5}).z;
    for (std::size_t q = 0; q < queries.size(); ++q)
        for (std::size_t c = 0; c < 3; ++c) {
            const double density = 2.0 * static_cast<double>(medium.extinction[static_cast<int>(c)]);
            EXPECT_NEAR(truth.value[c * queries.size() + q], std::exp(-density * (queries[q].z - front)), 1e-6);
            EXPECT_NEAR(truth.standard_error[c * queries.size() + q], 0.0, 1e-12);
        }
}

TEST(TracedTruth, DependsOnNeitherTheOtherQueriesNorTheThreads) {
    const HalfCovered half = half_covered(0.1);  // the edge is at x = 4.4
    std::vector<Query> queries;
    for (int i = 0; i < 60; ++i) {
        queries.push_back(
            {4.4f + 1e-5f * static_cast<float>(i % 7 - 3), 2.0f + 0.03f * static_cast<float>(i), 2.0f, 1e-4f});
        queries.push_back({4.3f, 2.0f + 0.03f * static_cast<float>(i), 2.0f, 1.0f});  // holds rays
    }
    std::vector<double> values[2];
    for (const int threads : {1, 2}) {
        const base::ThreadLimit limit(threads);
        values[threads - 1] = reference_visibility(half.scene, half.view, half.settings, queries, {}).value;
    }
    EXPECT_EQ(values[0], values[1]);
    bool partly = false;
    for (std::size_t q = 0; q < queries.size(); ++q) {
        const std::span<const Query> one(&queries[q], 1);
        EXPECT_EQ(reference_visibility(half.scene, half.view, half.settings, one, {}).value[0], values[0][q]) << q;
        partly = partly || (q % 2 == 0 && values[0][q] > 0.41 && values[0][q] < 0.99);
    }
    EXPECT_TRUE(partly) << "an edge inside a footprint that holds no captured ray";
}

TEST(TracedTruth, IsCutAtTheBordersOfTheMap) {
    const HalfCovered half = half_covered(-0.9999);  // covers x < 0.0004 pixels
    const rays::Tracer tracer(half.scene, true);
    rays::MapLayout layout = rays::make_layout(half.scene, half.view, half.settings);
    layout.jittered = layout.multi_jittered = true;
    rays::set_samples(layout, 1024);
    const Query queries[] = {{0.0f, 4.0f, 2.0f, 0.0016f}};  // of which [0, 0.0008] lies in the map
    const std::vector<Moments> moments = trace_footprints(tracer, half.view, layout, queries);
    ASSERT_EQ(moments[0].count, 1024u);
    EXPECT_NEAR(moments[0].sum[0] / 1024.0, 1.0 - 0.5 * 0.6, 0.01);
}

TEST(TracedTruth, NeverRisesWithDepth) {
    scene::Scene scene;
    base::Random random(5);
    for (int i = 0; i < 12; ++i) scene.objects.push_back(surface(any_half_plane(random), 0.9 - 0.1 * i, 0.3f));
    const rays::LightView view = view_of(scene);
    std::vector<Query> queries;
    for (int i = 0; i < 30; ++i)
        queries.push_back({6.1f, 5.9f, static_cast<float>(rays::to_light(view, {0, 0, 0.95 - 0.05 * i}).z), 0.01f});
    const Truth truth = reference_visibility(scene, view, settings_of(4), queries, {});
    for (std::size_t q = 1; q < queries.size(); ++q) EXPECT_LE(truth.value[q], truth.value[q - 1] + 1e-12);
    EXPECT_LT(truth.value.back(), truth.value.front());
}

}  // namespace
}  // namespace shadowbench::bench
