#include "rays/capture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/parallel.h"
#include "rays/scenes.h"
#include "rays/tracer.h"

namespace shadowbench::rays {
namespace {

using testing::capture;
using testing::Captured;
using testing::for_each_ray;

int rays_without_one_crossing(const Captured& c) {
    int wrong = 0;
    for_each_ray(c,
                 [&](const LightRays& t, std::size_t ray, int, int) { wrong += t.begin[ray + 1] - t.begin[ray] != 1; });
    return wrong;
}

TEST(Capture, ACrumpledSheetIsCrossedExactlyOnceByEveryRay) {
    scene::Scene scene;
    scene.objects.push_back(testing::crumpled_sheet(37));
    EXPECT_EQ(rays_without_one_crossing(capture(scene, testing::directional(1.9), testing::rays(96, 16))), 0);
    EXPECT_EQ(rays_without_one_crossing(capture(scene, testing::spot({0.3, 0.1, 1.5}, 40), testing::rays(96, 16))), 0);
}

TEST(Capture, SamplesExactlyOnSharedEdgesAndVerticesBelongToOneTriangle) {
    // Vertices at multiples of 1/32 and regular samples at odd multiples of 1/32: edges run through samples, and with
    // an even grid shifted by half a cell so do vertices.
    scene::Mesh mesh;
    const int n = 32;
    for (int y = 0; y <= n; ++y)
        for (int x = 0; x <= n; ++x)
            mesh.positions.emplace_back(static_cast<float>(x - 16) / 16 + 1.0f / 32,
                                        static_cast<float>(y - 16) / 16 + 1.0f / 32, 0.0f);
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
            const int a = y * (n + 1) + x;
            mesh.triangles.emplace_back(a, a + 1, a + n + 1);
            mesh.triangles.emplace_back(a + 1, a + n + 2, a + n + 1);
        }
    scene::Scene scene;
    scene.objects.emplace_back();
    scene.objects[0].shape = mesh;
    const Captured c = capture(scene, testing::directional(), testing::rays(32, 1, scene::Pattern::regular));
    int inside = 0, wrong = 0;
    for_each_ray(c, [&](const LightRays& t, std::size_t ray, int i, int j) {
        if (i == 0 || j == 0 || i == 31 || j == 31) return;  // the sheet's own border may go either way
        ++inside;
        wrong += t.begin[ray + 1] - t.begin[ray] != 1;
    });
    EXPECT_EQ(inside, 900);
    EXPECT_EQ(wrong, 0);
}

TEST(Capture, TwoWallsAtOneDepthAreBothKept) {
    scene::Scene scene;
    for (int i = 0; i < 2; ++i) scene.objects.push_back(testing::quad({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, 0.5f));
    const Captured c = capture(scene, testing::directional(), testing::rays(8, 4));
    for_each_ray(c, [&](const LightRays& t, std::size_t ray, int, int) {
        ASSERT_EQ(t.begin[ray + 1] - t.begin[ray], 2u);
        const std::uint32_t s = t.begin[ray];
        EXPECT_EQ(t.z_front[s], t.z_front[s + 1]);
        EXPECT_DOUBLE_EQ(transmittance(t, ray, 0, t.z_front[s]), 1.0) << "a surface shades only what is behind it";
        EXPECT_DOUBLE_EQ(transmittance(t, ray, 0, t.z_front[s] + 1), 0.25);
    });
}

TEST(Capture, DepthIsPlanarForBothKindsOfLight) {
    scene::Scene scene;
    scene.objects.push_back(testing::quad({-2, -2, 0.25f}, {4, 0, 0}, {0, 4, 0}));
    for (const auto& light : {testing::directional(), testing::spot({0, 0, 1.5}, 60)}) {
        const Captured c = capture(scene, light, testing::rays(16, 4));
        const double expected = to_light(c.view, {0.1, 0.2, 0.25}).z;
        for_each_ray(c, [&](const LightRays& t, std::size_t ray, int, int) {
            ASSERT_EQ(t.begin[ray + 1] - t.begin[ray], 1u);
            EXPECT_NEAR(t.z_front[t.begin[ray]], expected, 1e-6);
        });
    }
}

TEST(Capture, AStrandIsCrossedOnceAtItsJoints) {
    // A straight strand of many pieces, thicker than they are long: pieces that overlap would be counted again and
    // again.
    scene::Hair hair;
    for (int i = 0; i <= 40; ++i) {
        hair.points.emplace_back(-0.5f + 0.025f * static_cast<float>(i), 0.003f * static_cast<float>(i), 0.0f);
        hair.radii.push_back(0.08f);
    }
    hair.strand_begin = {0, 41};
    scene::Scene scene;
    scene.objects.emplace_back();
    scene.objects[0].shape = hair;
    const base::Vec2d a(-0.5, 0.0), b(0.5, 0.12);
    for (const auto& light : {testing::directional(), testing::spot({0, 0, 3}, 40)}) {
        const Captured c = capture(scene, light, testing::rays(64, 16));
        int hits = 0, wrong = 0;
        for_each_ray(c, [&](const LightRays& t, std::size_t ray, int i, int j) {
            const SamplePosition p = sample_position(c.layout, i, j);
            const base::Vec3d at = to_world(c.view, unproject(c.view, p.x, p.y, to_light(c.view, {0, 0, 0}).z));
            const base::Vec2d d = base::Vec2d(at.x, at.y) - a, axis = b - a;
            const double u = std::clamp(d.dot(axis) / axis.dot(axis), 0.0, 1.0), away = (d - axis * u).length();
            if (std::abs(away - 0.08) < 0.004) return;  // perspective rays are not quite square to the axis
            const bool expected = away < 0.08;
            hits += expected;
            wrong += (t.begin[ray + 1] - t.begin[ray]) != (expected ? 1u : 0u);
        });
        EXPECT_GT(hits, 500);
        EXPECT_EQ(wrong, 0);
    }
}

TEST(Capture, AgreesWithEmbree) {
    scene::Scene scene;
    scene.objects.push_back(testing::curly_hair(400, 20, 0.012f, 1));
    scene.objects.push_back(testing::crumpled_sheet(9));
    scene.objects.emplace_back();
    scene.objects.back().opacity = base::Vec3f(0.25f);
    scene.objects.back().shape = scene::Spheres{{{0.2f, 0.1f, 0.3f}, {-0.4f, 0.2f, -0.2f}}, {0.3f, 0.2f}};
    scene.objects.emplace_back();
    scene.objects.back().shape = scene::Particles{
        {{0.1f, 0.3f, 0.1f}, {-0.2f, -0.4f, 0.2f}, {0, 0, 0}}, {0.25f, 0.3f, 0.5f}, {2.0f, 1.0f, 0.5f}};
    const Tracer tracer(scene, true);
    std::vector<TracedSegment> traced;
    for (const auto& light : {testing::directional(), testing::spot({0.5, 0.4, 2}, 50)}) {
        const Captured c = capture(scene, light, testing::rays(64, 9));
        int rays = 0, differing = 0;
        std::size_t segments = 0;
        double worst = 0.0;
        for_each_ray(c, [&](const LightRays& t, std::size_t ray, int i, int j) {
            const SamplePosition p = sample_position(c.layout, i, j);
            const double through = tracer.transmittance(c.view, p.x, p.y, 1e9, traced).x;
            const std::size_t count = t.begin[ray + 1] - t.begin[ray];
            ++rays;
            segments += count;
            if (traced.size() != count) {
                ++differing;
                return;
            }
            worst = std::max(worst, std::abs(through - transmittance(t, ray, 0, 1e9)));
            for (std::size_t s = 0; s < count; ++s)
                worst = std::max(worst, std::abs(traced[s].front - t.z_front[t.begin[ray] + s]));
        });
        EXPECT_GT(segments, static_cast<std::size_t>(rays));
        EXPECT_LT(differing, rays / 2000) << "of " << rays;
        EXPECT_LT(worst, 1e-5);
    }
}

TEST(Capture, HairAroundASpotAndThroughItsNearPlaneIsNotLost) {
    scene::Scene scene;
    base::Random random(6);
    scene::Hair hair;
    hair.strand_begin.push_back(0);
    for (int s = 0; s < 40; ++s) {  // long segments from behind the light to in front of it, past its map
        for (const float z : {1.5f, -0.8f}) {
            hair.points.emplace_back(static_cast<float>(random.uniform(-0.4, 0.4)),
                                     static_cast<float>(random.uniform(-0.4, 0.4)), z);
            hair.radii.push_back(0.01f);
        }
        hair.strand_begin.push_back(static_cast<std::uint32_t>(hair.points.size()));
    }
    scene.objects.emplace_back();
    scene.objects[0].shape = hair;
    const Tracer tracer(scene, true);
    for (const double near : {0.0, 0.3}) {
        scene::Light light = testing::spot({0, 0, 1}, 60);
        light.near = near;
        const Captured c = capture(scene, light, testing::rays(64, 4));
        std::vector<TracedSegment> traced;
        int rays = 0, differing = 0, hit = 0;
        for_each_ray(c, [&](const LightRays& t, std::size_t ray, int i, int j) {
            const SamplePosition p = sample_position(c.layout, i, j);
            tracer.transmittance(c.view, p.x, p.y, 1e9, traced);
            ++rays;
            hit += !traced.empty();
            differing += traced.size() != t.begin[ray + 1] - t.begin[ray];
        });
        EXPECT_GT(hit, 1000);
        EXPECT_LE(differing, rays / 1000);
    }
}

TEST(Tracer, TheNearestHairHasADirectionAndASurfaceHasNone) {
    scene::Hair hair;
    hair.points = {{-1, 0, -1}, {1, 0, 1}};
    hair.radii = {0.1f, 0.1f};
    hair.strand_begin = {0, 2};
    scene::Object strand;
    strand.shape = hair;
    scene::Scene scene;
    scene.objects = {testing::quad({-5, -5, 3}, {4, 0, 0}, {0, 10, 0}), strand};
    const Tracer tracer(scene, false);
    std::vector<SurfaceHit> hits;
    ASSERT_TRUE(tracer.surfaces({0, 0.02, -5}, {0, 0, 1}, hits));
    SurfaceHit hit = hits.at(0);
    EXPECT_NEAR(std::abs(hit.tangent.dot(base::Vec3d(1, 0, 1).normalized())), 1.0, 1e-6);
    EXPECT_NEAR(hit.normal.dot(hit.tangent), 0.0, 1e-6);
    EXPECT_NEAR(hit.normal.dot(base::Vec3d(1, 0, -1).normalized()), 1.0, 1e-6) << "towards the eye";
    ASSERT_TRUE(tracer.surfaces({-3, 0, -5}, {0, 0, 1}, hits));
    hit = hits.at(0);
    EXPECT_EQ(hit.tangent, base::Vec3d(0, 0, 0));
    EXPECT_NEAR(hit.normal.z, -1.0, 1e-6);
}

TEST(Tracer, HairRightAtTheStartOfARayIsNotPassedOver) {
    // Embree on its own skips ribbons within two half-widths of where a ray starts.
    scene::Scene scene;
    scene::Hair hair;
    hair.points = {{-1, 0, 0}, {1, 0, 0}};
    hair.radii = {0.1f, 0.1f};
    hair.strand_begin = {0, 2};
    scene.objects.emplace_back();
    scene.objects[0].shape = hair;
    const Tracer tracer(scene, true);
    std::vector<TracedSegment> found;
    for (const double away : {0.01, 0.1, 0.19, 0.3}) {
        tracer.all_segments({0, 0.02, -away}, {0, 0, 1}, 0, 10, found);
        ASSERT_EQ(found.size(), 1u) << away;
        EXPECT_NEAR(found[0].front, away, 1e-6);
        std::vector<SurfaceHit> hits;
        ASSERT_TRUE(tracer.surfaces({0, 0.02, -away}, {0, 0, 1}, hits)) << away;
        EXPECT_NEAR(hits.at(0).t, away, 0.01);
    }
    tracer.all_segments({0, 0.02, 0.01}, {0, 0, 1}, 0, 10, found);
    EXPECT_TRUE(found.empty()) << "behind the start";
    std::vector<SurfaceHit> hits;
    EXPECT_FALSE(tracer.surfaces({0, 0.02, 0.01}, {0, 0, 1}, hits));
    EXPECT_TRUE(hits.empty());
}

TEST(Capture, DoesNotDependOnTheNumberOfThreads) {
    scene::Scene scene;
    scene.objects.push_back(testing::curly_hair(200, 20, 0.01f, 2));
    const auto run = [&](int threads) {
        const base::ThreadLimit limit(threads);
        return capture(scene, testing::directional(), testing::rays(64, 4));
    };
    const Captured one = run(1), two = run(2);
    ASSERT_EQ(one.tiles.size(), two.tiles.size());
    for (std::size_t t = 0; t < one.tiles.size(); ++t) {
        EXPECT_EQ(one.tiles[t].begin, two.tiles[t].begin);
        EXPECT_EQ(one.tiles[t].z_front, two.tiles[t].z_front);
        EXPECT_EQ(one.tiles[t].transmittance, two.tiles[t].transmittance);
    }
}

TEST(Capture, PaysOnlyForWhatTheSceneHas) {
    scene::Scene scene;
    scene.objects.push_back(testing::quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}));
    const Captured plain = capture(scene, testing::directional(), testing::rays(8, 4));
    EXPECT_TRUE(plain.tiles[0].z_back.empty()) << "surfaces need one depth";
    EXPECT_EQ(plain.tiles[0].transmittance.size(), plain.tiles[0].segments()) << "grey opacity needs one channel";
    scene.objects[0].opacity = {1.0f, 0.5f, 0.25f};
    const Captured coloured = capture(scene, testing::directional(), testing::rays(8, 4));
    ASSERT_EQ(coloured.layout.channels, 3);
    EXPECT_EQ(coloured.tiles[0].transmittance.size(), 3 * coloured.tiles[0].segments());
    EXPECT_DOUBLE_EQ(transmittance(coloured.tiles[0], 0, 1, 1e9), 0.5);
    EXPECT_DOUBLE_EQ(transmittance(channel(coloured.tiles[0], 2), 0, 0, 1e9), 0.75);
}

TEST(Capture, ObjectsThatCastNoShadowStayOut) {
    scene::Scene scene;
    scene.objects.push_back(testing::quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}));
    scene.objects.push_back(testing::quad({-1, -1, -1}, {2, 0, 0}, {0, 2, 0}));
    scene.objects[1].casts_shadow = false;
    EXPECT_EQ(rays_without_one_crossing(capture(scene, testing::directional(), testing::rays(16, 4))), 0);
}

TEST(Capture, AnAlphaTextureScalesTheOpacityAndItsHolesAreNotThere) {
    scene::Scene scene;
    scene.objects.push_back(testing::quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 0.5f));
    auto& mesh = std::get<scene::Mesh>(scene.objects[0].shape);
    auto texture = std::make_shared<scene::AlphaTexture>();
    *texture = {2, 1, {0.0f, 1.0f}};
    mesh.alpha = texture;
    mesh.corner_uv = {{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}};
    const Captured c = capture(scene, testing::directional(), testing::rays(32, 4));
    for_each_ray(c, [&](const LightRays& t, std::size_t ray, int i, int j) {
        const double u = sample_position(c.layout, i, j).x / 32;
        const float alpha = scene::sample(*texture, static_cast<float>(u), 0.5f);
        EXPECT_NEAR(transmittance(t, ray, 0, 1e9), 1.0 - 0.5 * alpha, 1e-5);
        EXPECT_EQ(t.begin[ray + 1] - t.begin[ray], alpha > 0 ? 1u : 0u);
    });
}

TEST(Capture, AParticleDarkensByItsChord) {
    scene::Scene scene;
    scene.objects.emplace_back();
    scene.objects[0].shape = scene::Particles{{{0, 0, 0}}, {0.5f}, {3.0f}};
    scene.objects[0].extinction = base::Vec3f(2.0f);
    const Captured c = capture(scene, testing::directional(), testing::rays(32, 4));
    for_each_ray(c, [&](const LightRays& t, std::size_t ray, int i, int j) {
        const SamplePosition p = sample_position(c.layout, i, j);
        const base::Vec3d at = unproject(c.view, p.x, p.y, 0);
        const double inside = 0.25 - at.x * at.x - at.y * at.y;
        const double chord = inside > 0 ? 2 * std::sqrt(inside) : 0.0;
        EXPECT_NEAR(transmittance(t, ray, 0, 1e9), std::exp(-6.0 * chord), 1e-6);
    });
}

TEST(Capture, AUniformSlabFollowsTheExponentialAtEveryDepth) {
    // In perspective too: there a ray is longer than the depth it covers.
    scene::Scene scene;
    scene.objects.emplace_back();
    scene.objects[0].shape = testing::slab();
    scene.objects[0].extinction = base::Vec3f(1.5f);
    for (const auto& light : {testing::directional(), testing::spot({0, 0, 2}, 40)}) {
        const Captured c = capture(scene, light, testing::rays(8, 4));
        const double front = to_light(c.view, {0, 0, 0.5}).z;
        for_each_ray(c, [&](const LightRays& t, std::size_t ray, int i, int j) {
            const SamplePosition p = sample_position(c.layout, i, j);
            const double scale = length_per_depth(c.view, p.x, p.y);
            for (const double depth : {0.0, 0.123, 0.5, 0.77, 1.0, 2.0})
                EXPECT_NEAR(transmittance(t, ray, 0, front + depth), std::exp(-3.0 * scale * std::min(depth, 1.0)),
                            2e-6);
        });
    }
}

TEST(Capture, GridsAreLeftOutForThoseWhoIntegrateThemThemselves) {
    scene::Scene scene;
    scene.objects.push_back(testing::curly_hair(100, 20, 0.02f, 2));
    const Captured c = capture(scene, testing::directional(), testing::rays(16, 4));
    scene.objects.emplace_back();
    scene.objects[1].shape = testing::slab();
    const LightRays hair = Capture(scene, c.view, c.layout, Capture::Grids::left_out).tile(0);
    EXPECT_EQ(hair.begin, c.tiles[0].begin);
    EXPECT_EQ(hair.z_front, c.tiles[0].z_front);
}

TEST(Capture, AViewWithoutCastersHasRaysWithoutSegments) {
    scene::Scene scene;
    scene.objects.push_back(testing::quad({50, -1, 0}, {2, 0, 0}, {0, 2, 0}));
    scene::Light away = testing::spot({0, 0, 100}, 40);
    away.target = {0, 0, 200};
    for (const scene::Light& light : {testing::directional(), testing::spot({0, 0, -100}, 40), away}) {
        const auto c = testing::capture(scene, light, testing::rays(8, 4));
        ASSERT_EQ(c.tiles.size(), 1u);
        EXPECT_EQ(c.tiles[0].rays(), 256u);
        EXPECT_EQ(c.tiles[0].segments(), 0u);
        EXPECT_LT(c.layout.z_min, c.layout.z_max);
    }
}

TEST(Capture, LightInsideASphereSeesOnlyItsFarSide) {
    scene::Scene scene;
    scene.objects.emplace_back();
    scene.objects[0].shape = scene::Spheres{{{0, 0, 1}}, {0.5f}};
    const Captured c = capture(scene, testing::spot({0, 0, 1}, 40), testing::rays(16, 4));
    EXPECT_EQ(rays_without_one_crossing(c), 0);
}

}  // namespace
}  // namespace shadowbench::rays
