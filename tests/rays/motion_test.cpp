// Objects that move while the shutter is open, compared with closed forms and with Embree.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "rays/capture.h"
#include "rays/scenes.h"
#include "rays/tile_grid.h"
#include "rays/tracer.h"

namespace shadowbench::rays {
namespace {

using base::Vec3d;
using base::Vec3f;
using testing::capture;
using testing::Captured;
using testing::for_each_ray;

std::size_t segments_of(const LightRays& tile, std::size_t ray) {
    return tile.begin[ray + 1] - tile.begin[ray];
}

MapLayout moving_layout(int samples, bool jittered) {
    MapLayout layout;
    layout.width = layout.height = 5;
    layout.moving = true;
    layout.jittered = jittered;
    layout.seed = 3;
    set_samples(layout, samples);
    return layout;
}

TEST(SampleTime, TheRaysOfAPixelTakeOneEachOfAsManyPartsOfTheShutter) {
    for (const int samples : {1, 3, 12, 16, 64})
        for (const bool jittered : {false, true}) {
            const MapLayout layout = moving_layout(samples, jittered);
            for (int pixel = 0; pixel < 25; ++pixel) {
                std::set<int> parts;
                for (int s = 0; s < samples; ++s) {
                    const double time = sample_time(layout, pixel % 5 * layout.samples_x + s % layout.samples_x,
                                                    pixel / 5 * layout.samples_y + s / layout.samples_x);
                    ASSERT_GE(time, 0.0);
                    ASSERT_LT(time, 1.0);
                    parts.insert(static_cast<int>(time * samples));
                }
                EXPECT_EQ(parts.size(), static_cast<std::size_t>(samples));
            }
        }
}

TEST(SampleTime, PixelsDoNotAllHaveOneOrder) {
    const MapLayout layout = moving_layout(16, false);
    std::set<double> first;
    for (int pixel = 0; pixel < 5; ++pixel) first.insert(sample_time(layout, pixel * layout.samples_x, 0));
    EXPECT_GT(first.size(), 1u);
}

TEST(SampleTime, IsTheBeginningOfTheShutterWhereNothingMoves) {
    MapLayout layout = moving_layout(16, true);
    layout.moving = false;
    for (int i = 0; i < 20; ++i) EXPECT_EQ(sample_time(layout, i, 7), 0.0);
}

// The share of positions x in [a, b] and times t in [0, 1] with x > edge + speed * t, speed > 0.
double share_behind(double edge, double speed, double a, double b) {
    const auto half_square = [](double v) { return v > 0.0 ? 0.5 * v * v : 0.0; };
    return (half_square(b - edge) - half_square(a - edge) - half_square(b - edge - speed) +
            half_square(a - edge - speed)) /
           (speed * (b - a));
}

TEST(Motion, APixelsCoverageByAMovingOpaqueQuadIsItsShareOfTheShutter) {
    // From x in [-0.8, -0.3] to x in [0.1, 0.6], all of y.
    scene::Scene scene;
    scene.objects.push_back(testing::quad({-0.8f, -3, 0}, {0.5f, 0, 0}, {0, 6, 0}));
    scene.objects[0].motion = {0.9f, 0, 0};
    for (const auto pattern : {scene::Pattern::regular, scene::Pattern::jittered}) {
        const Captured c = capture(scene, testing::directional(), testing::rays(16, 400, pattern));
        std::vector<double> covered(16, 0.0);
        double worst = 0.0, squares = 0.0;
        for (const LightRays& tile : c.tiles)
            for (int pixel = 0; pixel < tile.width * tile.height; ++pixel) {
                double sum = 0.0;
                for (int s = 0; s < 400; ++s)
                    sum += 1.0 - transmittance(tile, static_cast<std::size_t>(pixel) * 400 + s, 0, 1e9);
                const int x = tile.x0 + pixel % tile.width;
                const double left = -1.0 + 0.125 * x;
                const double expected =
                    share_behind(-0.8, 0.9, left, left + 0.125) - share_behind(-0.3, 0.9, left, left + 0.125);
                worst = std::max(worst, std::abs(sum / 400 - expected));
                squares += (sum / 400 - expected) * (sum / 400 - expected);
                covered[static_cast<std::size_t>(x)] += sum / (400 * 16);
            }
        // Independent samples would have a standard error of at most 0.5 / sqrt(400) = 0.025.
        EXPECT_LT(worst, 0.1);
        EXPECT_LT(std::sqrt(squares / 256), 0.025);
        for (int x = 0; x < 16; ++x) {
            const double left = -1.0 + 0.125 * x;
            EXPECT_NEAR(covered[static_cast<std::size_t>(x)],
                        share_behind(-0.8, 0.9, left, left + 0.125) - share_behind(-0.3, 0.9, left, left + 0.125), 0.01)
                << "column " << x;
        }
    }
}

TEST(Motion, EveryRaySeesAQuadWhereItStandsAtTheRaysTime) {
    // Also towards and away from the light, so that a spot sees the object grow and shrink.
    for (const Vec3f& motion : {Vec3f(0.7f, 0.2f, 0), Vec3f(0, 0, 0.6f), Vec3f(-0.3f, 0.1f, -0.5f)})
        for (const auto& light : {testing::directional(), testing::spot({0, 0, 2}, 50)}) {
            scene::Scene scene;
            scene.objects.push_back(testing::quad({-0.5f, -0.4f, 0.1f}, {0.6f, 0, 0}, {0, 0.7f, 0}));
            scene.objects[0].motion = motion;
            const Captured c = capture(scene, light, testing::rays(80, 16));
            ASSERT_GT(c.tiles.size(), 1u);
            int wrong = 0, hit = 0;
            double worst = 0.0;
            for_each_ray(c, [&](const LightRays& t, std::size_t ray, int i, int j) {
                const double time = sample_time(c.layout, i, j);
                const SamplePosition p = sample_position(c.layout, i, j);
                const double depth = to_light(c.view, Vec3d(0, 0, static_cast<double>(0.1f) + time * motion.z)).z;
                const Vec3d at = to_world(c.view, unproject(c.view, p.x, p.y, depth));
                const double u = (at.x - time * motion.x + 0.5) / 0.6, v = (at.y - time * motion.y + 0.4) / 0.7;
                const double inside = std::min({u, 1 - u, v, 1 - v});
                if (std::abs(inside) < 1e-5) return;
                ++hit;
                wrong += segments_of(t, ray) != (inside > 0 ? 1u : 0u);
                if (inside > 0 && segments_of(t, ray) == 1)
                    worst = std::max(worst, std::abs(t.z_front[t.begin[ray]] - depth));
            });
            EXPECT_GT(hit, 10000);
            EXPECT_EQ(wrong, 0);
            EXPECT_LT(worst, 1e-6);
        }
}

TEST(Motion, AWallThatComesTowardsTheLightShadesEachDepthForItsShareOfTheShutter) {
    scene::Scene scene;
    scene.objects.push_back(testing::quad({-3, -3, -0.5f}, {6, 0, 0}, {0, 6, 0}));
    scene.objects[0].motion = {0, 0, 1};
    for (const auto& light : {testing::directional(), testing::spot({0, 0, 2}, 40)}) {
        const Captured c = capture(scene, light, testing::rays(8, 64));
        const double far_depth = to_light(c.view, {0, 0, -0.5}).z;
        for (const LightRays& tile : c.tiles)
            for (int pixel = 0; pixel < tile.width * tile.height; ++pixel)
                for (const double before : {-0.1, 0.0, 0.25, 0.6, 1.0, 1.1}) {  // how far before the farthest place
                    double sum = 0.0;
                    for (int s = 0; s < 64; ++s)
                        sum += transmittance(tile, static_cast<std::size_t>(pixel) * 64 + s, 0, far_depth - before);
                    // Lit until the wall comes as near as the query's depth.
                    EXPECT_NEAR(sum / 64, std::clamp(before, 0.0, 1.0), 1.0 / 64 + 1e-6);
                }
    }
}

TEST(Motion, ACrumpledSheetIsCrossedExactlyOnceByEveryRayWhileItMoves) {
    scene::Scene scene;
    scene.objects.push_back(testing::crumpled_sheet(37));
    scene.objects[0].motion = {0.3f, 0.21f, -0.13f};
    for (const auto& light : {testing::directional(0.9), testing::spot({0.1, 0.05, 1.5}, 18)}) {
        // The light looks at the middle, which the sheet covers all the time.
        const Captured c = capture(scene, light, testing::rays(96, 16));
        int wrong = 0;
        for_each_ray(c, [&](const LightRays& t, std::size_t ray, int, int) { wrong += segments_of(t, ray) != 1; });
        EXPECT_EQ(wrong, 0);
    }
}

TEST(Motion, AStrandIsCrossedOnceAtItsJointsWhileItMoves) {
    scene::Hair hair;
    for (int i = 0; i <= 40; ++i) {
        hair.points.emplace_back(-0.5f + 0.025f * static_cast<float>(i), 0.003f * static_cast<float>(i), 0.0f);
        hair.radii.push_back(0.08f);
    }
    hair.strand_begin = {0, 41};
    scene::Scene scene;
    scene.objects.emplace_back();
    scene.objects[0].shape = hair;
    scene.objects[0].motion = {0.2f, 0.4f, -0.3f};
    for (const auto& light : {testing::directional(), testing::spot({0, 0, 3}, 40)}) {
        const Captured c = capture(scene, light, testing::rays(64, 16));
        int hit = 0, more = 0;
        for_each_ray(c, [&](const LightRays& t, std::size_t ray, int, int) {
            hit += segments_of(t, ray) == 1;
            more += segments_of(t, ray) > 1;
        });
        EXPECT_GT(hit, 500);
        EXPECT_EQ(more, 0);
    }
}

scene::Object textured_quad() {
    scene::Object object = testing::quad({-0.8f, -0.7f, 0.1f}, {1.2f, 0.1f, 0.3f}, {0.1f, 1.3f, -0.2f}, 0.75f);
    auto& mesh = std::get<scene::Mesh>(object.shape);
    auto texture = std::make_shared<scene::AlphaTexture>();
    *texture = {4, 4, {0, 0, 1, 1, 0, 0.5f, 1, 0.25f, 1, 0.75f, 0.5f, 0, 0.25f, 0, 0, 1}};
    mesh.alpha = texture;
    mesh.corner_uv = {{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}};
    return object;
}

scene::Object with(decltype(scene::Object::shape) shape) {
    scene::Object object;
    object.opacity = Vec3f(0.25f);
    object.shape = std::move(shape);
    return object;
}

scene::Object bumpy_volume() {
    scene::GridVolume grid;
    grid.size = {5, 6, 7};
    base::Random random(4);
    for (int i = 0; i < 5 * 6 * 7; ++i) grid.density.push_back(static_cast<float>(random.uniform(0, 3)));
    grid.lower = {-0.6, -0.5, -0.4};
    grid.upper = {0.3, 0.5, 0.6};
    grid.step = 0.07;
    return with(grid);
}

struct Kind {
    const char* name;
    scene::Object (*make)();
};
class MovingKind : public ::testing::TestWithParam<Kind> {};

// Compares every ray with Embree at the ray's time: as many segments, at the same depths, with the same transmittance.
void expect_agreement(scene::Scene scene, const scene::Light& light, scene::Media media = scene::Media::steps) {
    scene.objects.push_back(testing::quad({-3, -3, -1.5f}, {6, 0, 0.1f}, {0, 6, 0}, 0.5f));  // still, behind everything
    const Tracer tracer(scene, true);
    scene::RaySettings settings = testing::rays(64, 16);
    settings.media = media;
    const auto grids = media == scene::Media::cells ? Tracer::Grids::cells : Tracer::Grids::steps;
    const Captured c = capture(scene, light, settings);
    ASSERT_GT(c.tiles.size(), 1u);
    std::vector<TracedSegment> traced;
    int rays = 0, met = 0, differing = 0;
    double worst = 0.0;
    for_each_ray(c, [&](const LightRays& t, std::size_t ray, int i, int j) {
        const SamplePosition p = sample_position(c.layout, i, j);
        const LightLine line = light_line(c.view, p.x, p.y);
        tracer.all_segments(line.origin, line.direction, std::max(line.z_start, 0.0), 1e9, traced,
                            sample_time(c.layout, i, j), grids);
        double through = 1.0;
        for (const TracedSegment& segment : traced) through *= segment.transmittance.x;
        ++rays;
        met += traced.size() > 1;
        if (traced.size() != segments_of(t, ray)) {
            ++differing;
            return;
        }
        worst = std::max(worst, std::abs(through - transmittance(t, ray, 0, 1e9)));
        for (std::size_t s = 0; s < traced.size(); ++s)
            worst = std::max(worst, std::abs(traced[s].front - t.z_front[t.begin[ray] + s]));
    });
    EXPECT_GT(met, 1000) << "rays that meet what moves";
    EXPECT_LE(differing, rays / 2000) << "of " << rays;
    EXPECT_LT(worst, 2e-5);
}

TEST_P(MovingKind, AgreesWithEmbreeRayByRay) {
    for (const Vec3f& motion : {Vec3f(0.5f, -0.35f, 0.2f), Vec3f(0.01f, 0, -0.6f)})
        for (const auto& light : {testing::directional(2.6), testing::spot({0.5, 0.4, 2}, 60)}) {
            scene::Scene scene;
            scene.objects.push_back(GetParam().make());
            scene.objects[0].motion = motion;
            expect_agreement(scene, light);
            if (scene::has_media(scene)) expect_agreement(scene, light, scene::Media::cells);
        }
}

TEST_P(MovingKind, ThatPassesTheLightIsNotLost) {
    // From behind a spot to in front of it, through its near plane.
    scene::Light light = testing::spot({0, 0, 0.8}, 70);
    light.near = 0.3;
    scene::Scene scene;
    scene.objects.push_back(GetParam().make());
    scene.objects[0].motion = {0.1f, -0.1f, 1.0f};
    expect_agreement(scene, light);
}

INSTANTIATE_TEST_SUITE_P(
    Primitives, MovingKind,
    ::testing::Values(Kind{"Mesh", [] { return testing::crumpled_sheet(7); }}, Kind{"TexturedMesh", textured_quad},
                      Kind{"Hair", [] { return testing::curly_hair(120, 20, 0.012f, 1); }},
                      Kind{"Spheres",
                           [] {
                               return with(scene::Spheres{{{0.2f, 0.1f, 0.3f}, {-0.4f, 0.2f, -0.2f}}, {0.3f, 0.2f}});
                           }},
                      Kind{"Particles",
                           [] {
                               return with(scene::Particles{{{0.1f, 0.3f, 0.1f}, {-0.2f, -0.4f, 0.2f}, {0, 0, 0}},
                                                            {0.25f, 0.3f, 0.5f},
                                                            {2.0f, 1.0f, 0.5f}});
                           }},
                      Kind{"Volume", bumpy_volume}),
    [](const auto& kind) { return std::string(kind.param.name); });

TEST(Tracer, TheNearestSurfaceStandsWhereItsTimePutsIt) {
    scene::Scene scene;
    scene.objects.push_back(testing::quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}));
    scene.objects.push_back(with(scene::Spheres{{{0, 0, 5}}, {1.0f}}));
    scene.objects[1].opacity = Vec3f(1);
    for (scene::Object& object : scene.objects) object.motion = {0, 0, 4};
    const Tracer tracer(scene, false);
    std::vector<SurfaceHit> hits;
    ASSERT_TRUE(tracer.surfaces({0.1, 0.2, -3}, {0, 0, 1}, hits, scene::mid_shutter));
    EXPECT_NEAR(hits.at(0).t, 5.0, 1e-5);
    ASSERT_TRUE(tracer.surfaces({0, 0, 20}, {0, 0, -1}, hits, 0.25));
    EXPECT_NEAR(hits.at(0).t, 13.0, 1e-5);
    EXPECT_NEAR(hits.at(0).normal.z, 1.0, 1e-6);
}

TEST(Motion, AStillSceneStoresNoTimes) {
    scene::Scene scene;
    scene.objects.push_back(testing::quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}));
    scene.objects.push_back(testing::quad({-1, -1, -0.5f}, {2, 0, 0}, {0, 2, 0}));
    scene.objects[1].casts_shadow = false;
    scene.objects[1].motion = {1, 0, 0};
    const Captured c = capture(scene, testing::directional(), testing::rays(8, 4));
    EXPECT_FALSE(c.layout.moving) << "what casts no shadow may move";
    EXPECT_EQ(make_tile_grid(c.view, c.layout, c.tiles[0], false).timed.capacity(), 0u);
    EXPECT_TRUE(c.tiles[0].submission.empty());
    scene.objects[1].casts_shadow = true;
    const Captured moving = capture(scene, testing::directional(), testing::rays(8, 4));
    EXPECT_TRUE(moving.layout.moving);
}

TEST(Motion, ATilesRaysByTimeAreTheSameRays) {
    scene::Scene scene;
    scene.objects.push_back(testing::quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}));
    scene.objects[0].motion = {1, 0, 0};
    const Captured c = capture(scene, testing::directional(), testing::rays(8, 4));
    const TileGrid grid = make_tile_grid(c.view, c.layout, c.tiles[0], true);
    std::vector<const TimedRay*> ray_of(c.tiles[0].rays(), nullptr);
    ASSERT_EQ(grid.timed.size(), ray_of.size());
    for (std::size_t i = 0; i < grid.timed.size(); ++i) {
        EXPECT_EQ(static_cast<std::size_t>(grid.timed[i].time * 4), i / 64) << "part after part";
        EXPECT_EQ(grid.timed[i].ray / 4, i % 64) << "one ray of every pixel";
        ray_of[grid.timed[i].ray] = &grid.timed[i];
    }
    for_each_ray(c, [&](const LightRays&, std::size_t ray, int i, int j) {
        ASSERT_NE(ray_of[ray], nullptr);
        const SamplePosition p = sample_position(c.layout, i, j);
        EXPECT_EQ(ray_of[ray]->x, c.view.lower.x + p.x * c.view.pixel.x);
        EXPECT_EQ(ray_of[ray]->y, c.view.lower.y + p.y * c.view.pixel.y);
        EXPECT_EQ(ray_of[ray]->time, sample_time(c.layout, i, j));
    });
}

TEST(Motion, WhatStandsStillIsCrossedAtTheSamePlacesBesideSomethingThatMoves) {
    scene::Scene scene;
    scene.objects.push_back(testing::curly_hair(100, 20, 0.02f, 2));
    scene.objects.push_back(testing::quad({-1, -1, 2}, {2, 0, 0}, {0, 2, 0}));
    const Captured still = capture(scene, testing::directional(), testing::rays(32, 16));
    scene.objects[1].motion = {3, 0, 0};
    scene.objects[1].opacity = Vec3f(0.0f);  // gone from the rays, not from the bounds
    const Captured moving =
        testing::capture_all(scene, still.view, make_layout(scene, still.view, testing::rays(32, 16)));
    ASSERT_TRUE(moving.layout.moving);
    for (std::size_t t = 0; t < still.tiles.size(); ++t) {
        const LightRays &a = still.tiles[t], &b = moving.tiles[t];
        for (std::size_t ray = 0; ray < a.rays(); ++ray) {
            ASSERT_EQ(segments_of(a, ray), segments_of(b, ray) + 1) << "the quad is before the hair";
            for (std::uint32_t s = 0; s < segments_of(b, ray); ++s)
                ASSERT_EQ(a.z_front[a.begin[ray] + 1 + s], b.z_front[b.begin[ray] + s]);
        }
    }
}

}  // namespace
}  // namespace shadowbench::rays
