#include "bench/camera_points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/random.h"
#include "bench/half_covered.h"
#include "bench/run.h"

namespace shadowbench::bench {
namespace {

using base::Vec3d;
using base::Vec3f;
using nlohmann::json;

scene::Object object(scene::Mesh mesh, Vec3f opacity) {
    scene::Object object;
    object.shape = std::move(mesh);
    object.opacity = opacity;
    return object;
}

scene::Mesh layer(float y, float side = 5.0f) {
    scene::Mesh mesh;
    mesh.positions = {{-side, y, -side}, {-side, y, side}, {side, y, side}, {side, y, -side}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

// Layers at y = -1, -2, ... of these opacities.
scene::Scene stack(const std::vector<Vec3f>& opacities) {
    scene::Scene scene;
    for (std::size_t i = 0; i < opacities.size(); ++i)
        scene.objects.push_back(object(layer(-1.0f - static_cast<float>(i)), opacities[i]));
    return scene;
}

// A camera at the origin that looks straight down.
scene::Receivers downwards(int side, double fov = 40.0) {
    scene::Receivers receivers;
    receivers.camera = scene::Camera{{0, 0, 0}, {0, -1, 0}, {0, 0, -1}, fov};
    receivers.resolution = {side, side};
    return receivers;
}

std::vector<CameraPoint> seen(const scene::Scene& scene, const scene::Receivers& receivers) {
    return camera_points(receivers, rays::Tracer(scene, false));
}

std::vector<int> counts_by_layer(const std::vector<CameraPoint>& points, std::size_t layers) {
    std::vector<int> counts(layers, 0);
    for (const CameraPoint& p : points) ++counts.at(static_cast<std::size_t>(std::lround(-p.position.y)) - 1);
    return counts;
}

// Within 4.5 standard deviations of the binomial distribution.
void expect_share(int count, std::size_t pixels, double share, const std::string& what) {
    const double n = static_cast<double>(pixels);
    EXPECT_NEAR(count, n * share, 4.5 * std::sqrt(n * share * (1.0 - share)) + 1e-9) << what;
}

TEST(CameraPoints, lie_on_the_nearest_of_opaque_surfaces_in_image_order) {
    HalfCovered half = half_covered();
    half.scene.objects[0].opacity = Vec3f(1.0f);
    scene::Receivers receivers;
    receivers.camera = scene::Camera{{0, 1, 0}, {0, -1, 0}, {0, 0, -1}, 20.0};
    receivers.resolution = {4, 2};
    const std::vector<CameraPoint> points = seen(half.scene, receivers);
    ASSERT_EQ(points.size(), 8u);
    for (const CameraPoint& p : points) EXPECT_NEAR(p.position.y, p.position.x < 0 ? -1.0 : -3.0, 1e-5);
    EXPECT_LT(points[0].position.x, points[1].position.x) << "left to right";
    EXPECT_LT(points[0].position.z, points[4].position.z) << "top row first: up is -z";
}

// Grey stacks, with and without an opaque end: each share is a layer's part of all that is seen.
TEST(CameraPoints, lie_on_each_layer_of_a_stack_as_often_as_it_is_seen) {
    for (const std::vector<double>& opacities :
         {std::vector<double>{0.1, 0.49, 0.3, 0.5, 1.0, 0.5}, {0.3, 0.2}, {0.001, 0.002, 0.001}, {0.9, 1.0}}) {
        std::vector<Vec3f> grey;
        for (const double o : opacities) grey.push_back(Vec3f(static_cast<float>(o)));
        std::vector<double> share;
        double left = 1.0, sum = 0.0;
        for (const double o : opacities) {
            share.push_back(left * o);
            sum += left * o;
            left *= 1.0 - o;
        }
        const std::vector<CameraPoint> points = seen(stack(grey), downwards(200));
        ASSERT_EQ(points.size(), 40000u);
        const std::vector<int> counts = counts_by_layer(points, opacities.size());
        for (std::size_t i = 0; i < share.size(); ++i)
            expect_share(counts[i], points.size(), share[i] / sum, "layer " + std::to_string(i));
    }
}

TEST(CameraPoints, weigh_the_mean_of_coloured_shares) {
    // Red sees 0.4, 0.6 x 0.5, then 0.3 of the floor; green 1; blue 0, 0.5, 0.5.
    const std::vector<CameraPoint> points = seen(stack({{0.4f, 1, 0}, {0.5f, 0.3f, 0.5f}, Vec3f(1)}), downwards(200));
    ASSERT_EQ(points.size(), 40000u);
    const std::vector<int> counts = counts_by_layer(points, 3);
    expect_share(counts[0], 40000, 1.4 / 3, "first");
    expect_share(counts[1], 40000, 0.8 / 3, "second");
    expect_share(counts[2], 40000, 0.8 / 3, "floor");
}

// A medium of optical depth ln 4 between the layers, and 2 ln 4 before them. The first has no influence, since nothing
// is seen through less of it.
TEST(CameraPoints, see_surfaces_through_the_media_before_them) {
    scene::Scene scene = stack({Vec3f(0.5f), Vec3f(1.0f)});
    for (const double y : {-0.5, -1.5}) {
        scene::GridVolume slab;
        slab.size = {2, 2, 2};
        slab.density.assign(8, y == -0.5 ? 2.0f : 1.0f);
        slab.lower = {-500, y - 0.25, -500};
        slab.upper = {500, y + 0.25, 500};
        slab.step = 0.01;
        scene.objects.emplace_back();
        scene.objects.back().shape = slab;
        scene.objects.back().extinction = Vec3f(static_cast<float>(2.0 * std::log(4.0)));
    }
    for (const int lookups : {0, 2}) {
        scene::Receivers receivers = downwards(200, 0.5);
        receivers.media_lookups = lookups;
        std::vector<CameraPoint> points = seen(scene, receivers);
        ASSERT_EQ(points.size(), 40000u * static_cast<unsigned>(1 + lookups));
        if (lookups > 0) {  // one in each slab, also behind translucent layers
            EXPECT_NEAR(points[0].position.y, -0.5, 1e-3);
            EXPECT_NEAR(points[1].position.y, -1.5, 1e-3);
        }
        std::vector<CameraPoint> surfaces;
        for (std::size_t i = static_cast<std::size_t>(lookups); i < points.size();
             i += 1 + static_cast<std::size_t>(lookups))
            surfaces.push_back(points[i]);
        const std::vector<int> counts = counts_by_layer(surfaces, 2);
        expect_share(counts[0], 40000, 0.5 / (0.5 + 0.5 / 4), "first");
    }
}

rays::SurfaceHit at(double t, const Vec3d& opacity) {
    return {t, Vec3d(0.0), Vec3d(0.0), Vec3d(0.0), opacity};
}

TEST(CameraPoints, take_the_nearest_if_all_shares_underflow) {
    const std::vector<rays::SurfaceHit> surfaces{at(2, Vec3d(0.5)), at(3, Vec3d(1.0))};
    const std::vector<rays::TracedSegment> dark{{0.5, 1.0, Vec3d(0.0)}};
    for (const double u : {0.0, 0.3, 0.999}) EXPECT_EQ(draw_surface(surfaces, dark, u), 0u) << u;
    const std::vector<rays::TracedSegment> between{{2.5, 2.75, Vec3d(0.0)}};
    for (const double u : {0.0, 0.3, 0.999}) EXPECT_EQ(draw_surface(surfaces, between, u), 0u) << u;
    const Vec3d red(1, 0, 0);
    const std::vector<rays::SurfaceHit> unseen{at(2, red), at(3, red), at(4, Vec3d(0, 1, 1))};
    EXPECT_EQ(draw_surface(unseen, {}, 0.0), 0u);
    EXPECT_EQ(draw_surface(unseen, {}, 0.999), 2u) << "only red is opaque in front of the second";
}

// Kinds of surfaces, each of one opacity; none in front of a floor.
struct Kind {
    const char* name;
    std::function<void(scene::Scene&)> add;
};

void add_spheres(scene::Scene& scene) {
    scene.objects.emplace_back();
    scene.objects.back().shape = scene::Spheres{{{0, -4, 0}, {0.3f, -3, 0.2f}, {-0.9f, -5, 0.1f}}, {0.8f, 0.4f, 0.5f}};
}

void add_hair(scene::Scene& scene) {
    scene::Hair hair;
    hair.strand_begin = {0};
    base::Random random(5);
    for (int strand = 0; strand < 300; ++strand) {
        Vec3f at(static_cast<float>(random.uniform(-1, 1)), -4.0f, static_cast<float>(random.uniform(-1, 1)));
        for (int i = 0; i < 8; ++i) {
            hair.points.push_back(at);
            hair.radii.push_back(0.02f);
            for (int a = 0; a < 3; ++a) at[a] += static_cast<float>(random.uniform(-0.1, 0.1));
        }
        hair.strand_begin.push_back(static_cast<std::uint32_t>(hair.points.size()));
    }
    scene.objects.emplace_back();
    scene.objects.back().shape = hair;
}

void add_sheets(scene::Scene& scene) {
    scene::Mesh mesh;  // waves, so that rays cross the sheet more than once
    const int n = 40;
    for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n; ++j) {
            const double x = -1.0 + 2.0 * i / n, z = -1.0 + 2.0 * j / n;
            mesh.positions.push_back({static_cast<float>(x + 0.3 * std::sin(9 * z)),
                                      static_cast<float>(-3.0 + std::sin(11 * x + 3 * z)), static_cast<float>(z)});
        }
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const int a = i * (n + 1) + j, b = a + n + 1;
            mesh.triangles.push_back({a, a + 1, b});
            mesh.triangles.push_back({a + 1, b + 1, b});
        }
    scene.objects.push_back(object(mesh, Vec3f(1)));
}

void add_leaf(scene::Scene& scene) {
    scene::Mesh mesh = layer(-3.0f, 1.0f);
    for (const base::Vec3i& t : mesh.triangles)
        for (int i = 0; i < 3; ++i)
            mesh.corner_uv.push_back({0.5f + 0.5f * mesh.positions[t[i]].x, 0.5f + 0.5f * mesh.positions[t[i]].z});
    auto texture = std::make_shared<scene::AlphaTexture>();
    texture->width = 4;
    texture->height = 4;
    texture->alpha = {1, 0, 0, 0.3f, 1, 0, 0, 0.3f, 1, 0, 0, 0.7f, 1, 0, 0, 0.7f};
    mesh.alpha = texture;
    scene.objects.push_back(object(mesh, Vec3f(1)));
}

class SeenSurface : public ::testing::TestWithParam<Kind> {};

TEST_P(SeenSurface, has_as_many_receivers_at_any_opacity_above_0) {
    scene::Scene scene;
    GetParam().add(scene);
    std::vector<std::size_t> counts;
    for (const float opacity : {1.0f, 1e-30f, 1e-3f, 0.1f, 0.49f, 0.5f, 0.51f, 0.999f}) {
        scene.objects[0].opacity = Vec3f(opacity);
        counts.push_back(seen(scene, downwards(120)).size());
    }
    EXPECT_GT(counts[0], 500u);
    for (const std::size_t count : counts) EXPECT_EQ(count, counts[0]);
    for (const Vec3f& colour : {Vec3f(0.4f, 1, 1), Vec3f(0, 0, 0.1f), Vec3f(1, 0, 0), Vec3f(0.1f, 0.2f, 0.3f)}) {
        scene.objects[0].opacity = colour;
        EXPECT_EQ(seen(scene, downwards(120)).size(), counts[0]) << colour;
    }
    scene.objects[0].opacity = Vec3f(0.0f);
    EXPECT_TRUE(seen(scene, downwards(120)).empty()) << "opacity 0 is not seen";
}

// For each pixel, the drawn surface only comes nearer as the surface grows opaque. From opacity 0.5 to 0.51 the
// cumulative shares of a stack, 1 - (1 - a)^i, move by 0.01 / a^2 in sum. So that share of the pixels moves, and the
// others keep their exact place.
TEST_P(SeenSurface, gains_receivers_from_the_floor_and_loses_none_as_its_opacity_grows) {
    scene::Scene scene;
    GetParam().add(scene);
    scene.objects.push_back(object(layer(-9.0f), Vec3f(1)));
    std::vector<CameraPoint> before;
    for (const float opacity : {0.001f, 0.1f, 0.49f, 0.5f, 0.51f, 1.0f}) {
        scene.objects[0].opacity = Vec3f(opacity);
        const std::vector<CameraPoint> points = seen(scene, downwards(120));
        ASSERT_EQ(points.size(), 120u * 120);
        int moved = 0;
        for (std::size_t i = 0; i < before.size(); ++i) {
            EXPECT_LE(points[i].position.length(), before[i].position.length() + 0.03) << i << " at " << opacity;
            moved += points[i].position != before[i].position || points[i].across != before[i].across;
        }
        if (opacity == 0.51f) {
            EXPECT_LT(moved, 0.05 * 120 * 120);
        }
        before = points;
    }
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, SeenSurface,
    ::testing::Values(Kind{"Quad", [](scene::Scene& s) { s.objects.push_back(object(layer(-3.0f, 1.0f), Vec3f(1))); }},
                      Kind{"Spheres", add_spheres}, Kind{"Hair", add_hair}, Kind{"Sheets", add_sheets},
                      Kind{"Leaf", add_leaf}),
    [](const auto& kind) { return std::string(kind.param.name); });

TEST(CameraPoints, have_the_pixel_edges_of_the_drawn_surface) {
    scene::Scene scene = stack({Vec3f(0.5f)});
    scene::Mesh tilted = layer(0.0f);  // y = -3 + 0.5 x
    for (Vec3f& p : tilted.positions) p.y = -3.0f + 0.5f * p.x;
    scene.objects.push_back(object(tilted, Vec3f(1)));
    int flat = 0;
    for (const CameraPoint& p : seen(scene, downwards(40, 10.0))) {
        const bool first = p.position.y > -1.5;
        flat += first;
        EXPECT_NEAR(p.across.y, first ? 0.0 : 0.5 * p.across.x, 1e-6);
        EXPECT_NEAR(p.across.x, 2 * std::tan(5 * std::acos(-1.0) / 180) / 40 * -p.position.y, first ? 1e-6 : 0.003);
    }
    EXPECT_GT(flat, 600);
    EXPECT_LT(flat, 1000);
}

TEST(CameraPoints, depend_on_the_seed_of_the_receivers_if_surfaces_are_drawn) {
    const scene::Scene scene = stack({Vec3f(0.5f), Vec3f(1)});
    scene::Receivers receivers = downwards(64);
    const auto heights = [&] {
        std::vector<double> y;
        for (const CameraPoint& p : seen(scene, receivers)) y.push_back(p.position.y);
        return y;
    };
    const std::vector<double> one = heights(), again = heights();
    receivers.seed = 8;
    const std::vector<double> other = heights();
    EXPECT_EQ(one, again);
    int differ = 0;
    for (std::size_t i = 0; i < one.size(); ++i) differ += one[i] != other[i];
    expect_share(differ, one.size(), 0.5, "independent draws");
}

TEST(CameraPoints, lie_on_moving_objects_at_mid_shutter) {
    scene::Scene scene;
    scene.objects.emplace_back();
    scene.objects[0].shape = scene::Spheres{{{0, -4, 0}}, {1.0f}};
    scene.objects[0].motion = {0, -2, 0};
    scene.objects.emplace_back();
    scene.objects[1].shape = scene::Particles{{{0, -2, 0}}, {0.5f}, {1.0f}};
    scene.objects[1].motion = {0, 1, 0};
    scene::Receivers receivers;
    receivers.camera = scene::Camera{{0, 0, 0}, {0, -1, 0}, {0, 0, -1}, 0.01};
    receivers.resolution = {1, 1};
    receivers.media_lookups = 1;
    const std::vector<CameraPoint> points = camera_points(receivers, rays::Tracer(scene, false));
    ASSERT_EQ(points.size(), 2u);
    EXPECT_NEAR(points[0].position.y, -1.5, 1e-3);
    EXPECT_NEAR(points[1].position.y, -4.0, 1e-3);
}

TEST(CameraPoints, spread_over_the_media_before_the_surface) {
    scene::Scene scene;
    scene::Particles puffs;  // on the view ray from 1 to 2, and from 3 to 6
    puffs.centres = {{0, -1.5f, 0}, {0, -4.5f, 0}};
    puffs.radii = {0.5f, 1.5f};
    puffs.density = {1.0f, 1.0f};
    scene.objects.emplace_back();
    scene.objects.back().shape = puffs;
    scene::Receivers receivers;
    receivers.camera = scene::Camera{{0, 0, 0}, {0, -1, 0}, {0, 0, -1}, 0.01};
    receivers.resolution = {1, 1};
    receivers.media_lookups = 4;
    const std::vector<CameraPoint> points = camera_points(receivers, rays::Tracer(scene, false));
    ASSERT_EQ(points.size(), 4u) << "no surface behind them";
    const double depths[] = {1.5, 3.5, 4.5, 5.5};
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(points[i].position.y, -depths[i], 1e-3);
    // A pixel of 0.01 degrees, on a plane that faces the ray.
    const double pixel = 2 * std::tan(0.005 * std::acos(-1.0) / 180);
    for (int i = 0; i < 4; ++i) {
        EXPECT_NEAR(points[i].across.length(), pixel * depths[i], 1e-6);
        EXPECT_NEAR(points[i].across.y, 0.0, 1e-9);
        EXPECT_NEAR(points[i].across.dot(points[i].down), 0.0, 1e-9);
    }
}

json seen_alone(const char* objects) {
    json document = json::parse(R"({
        "name": "seen",
        "lights": [{"type": "spot", "name": "key", "position": [4, 8, 3], "target": [0, 1.7, 0]}],
        "rays": {"resolution": 32, "samples_per_pixel": 4},
        "receivers": {"type": "camera", "position": [-1.5, 4.2, 7.5], "target": [-0.6, 1.0, -0.2],
                      "resolution": [128, 96], "bias": 0.02},
        "reference": {"samples_per_pixel": 16, "queries": 64, "spread_seeds": 0},
        "timing": {"repetitions": 1, "lookups": 256},
        "techniques": [{"type": "uncompressed"}]})");
    document["scene"]["objects"] = json::parse(objects);
    return document;
}

std::uint64_t receivers_of(const json& document) {
    const results::LightResult light = run(document, {}, {}).variants.at(0).lights.at(0);
    return light.receivers + light.dropped;
}

TEST(Run, has_receivers_on_faint_hair_alone_in_the_scene) {
    json faint = seen_alone(R"([{"type": "hair_ball", "strands": 500, "segments": 12, "centre": [0, 1.7, 0],
        "ball_radius": 0.9, "length": 0.5, "radius": 0.004, "opacity": 0.3}])");
    json opaque = faint;
    opaque["scene"]["objects"][0]["opacity"] = 1;
    EXPECT_GT(receivers_of(faint), 100u);
    EXPECT_EQ(receivers_of(faint), receivers_of(opaque));
}

TEST(Run, has_receivers_on_a_sphere_whose_red_is_faint) {
    json red = seen_alone(R"([{"type": "sphere", "centre": [0, 1, 0], "radius": 0.8, "opacity": [0.4, 1, 1]}])");
    json opaque = red;
    opaque["scene"]["objects"][0]["opacity"] = 1;
    EXPECT_GT(receivers_of(red), 100u);
    EXPECT_EQ(receivers_of(red), receivers_of(opaque));
}

}  // namespace
}  // namespace shadowbench::bench
