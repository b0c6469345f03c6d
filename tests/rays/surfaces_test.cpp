#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "base/random.h"
#include "rays/tracer.h"
#include "scenes.h"

namespace shadowbench::rays {
namespace {

using base::Vec3d;
using base::Vec3f;

scene::Object with(decltype(scene::Object::shape) shape, Vec3f opacity) {
    scene::Object object;
    object.shape = std::move(shape);
    object.opacity = opacity;
    return object;
}

scene::Object wall(float z, Vec3f opacity) {
    scene::Object object = testing::quad({-1, -1, z}, {2, 0, 0}, {0, 2, 0});
    object.opacity = opacity;
    return object;
}

std::vector<SurfaceHit> hits_along_z(const scene::Scene& scene, double x, double y) {
    std::vector<SurfaceHit> hits;
    Tracer(scene, false).surfaces({x, y, -3}, {0, 0, 1}, hits);
    return hits;
}

TEST(Surfaces, ComeInOrderOfDepthUpToTheFirstBehindWhichNothingIsLeft) {
    scene::Scene scene;
    scene.objects = {wall(4, Vec3f(0.5f)), wall(2, {0, 1, 1}), wall(1, {0.25f, 0, 0}),
                     wall(3, {1, 0, 0}),   wall(0, Vec3f(0)),  wall(5, Vec3f(1))};
    std::vector<SurfaceHit> hits;
    EXPECT_TRUE(Tracer(scene, false).surfaces({0.3, 0.1, -3}, {0, 0, 1}, hits));
    ASSERT_EQ(hits.size(), 3u) << "red is stopped by the third, green and blue by the second";
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(hits[i].t, 4.0 + i, 1e-6);
        EXPECT_NEAR(hits[i].position.z, 1.0 + i, 1e-6);
        EXPECT_EQ(hits[i].normal, Vec3d(0, 0, -1));
    }
    EXPECT_EQ(hits[0].opacity, Vec3d(0.25, 0, 0));
    EXPECT_EQ(hits[2].opacity, Vec3d(1, 0, 0));
    scene.objects.pop_back();
    scene.objects[3].opacity = {0.5f, 0, 0};
    EXPECT_FALSE(Tracer(scene, false).surfaces({0.3, 0.1, -3}, {0, 0, 1}, hits)) << "red goes through";
    EXPECT_EQ(hits.size(), 4u);
}

TEST(Surfaces, OfOpacity0AreSkipped) {
    scene::Scene scene;
    scene.objects = {wall(0, Vec3f(0)), with(scene::Spheres{{{0, 0, 3}}, {1.0f}}, Vec3f(0))};
    EXPECT_TRUE(hits_along_z(scene, 0.3, 0.1).empty());
    std::vector<TracedSegment> segments;
    Tracer(scene, false).all_segments({0.3, 0.1, -3}, {0, 0, 1}, 0, 100, segments);
    EXPECT_TRUE(segments.empty());
    scene.objects.push_back(wall(5, Vec3f(1)));
    ASSERT_EQ(hits_along_z(scene, 0.3, 0.1).size(), 1u);
    EXPECT_NEAR(hits_along_z(scene, 0.3, 0.1)[0].t, 8, 1e-6);
}

TEST(Surfaces, OfASphereAreTwo) {
    scene::Scene scene;
    scene.objects = {with(scene::Spheres{{{0, 0, 3}}, {1.0f}}, {0.4f, 1, 0})};
    const std::vector<SurfaceHit> hits = hits_along_z(scene, 0.6, 0.0);
    ASSERT_EQ(hits.size(), 2u);
    EXPECT_NEAR(hits[0].t, 6.0 - 0.8, 1e-6);
    EXPECT_NEAR(hits[1].t, 6.0 + 0.8, 1e-6);
    EXPECT_NEAR(hits[0].normal.x, 0.6, 1e-6);
    EXPECT_NEAR(hits[1].normal.x, -0.6, 1e-6) << "the inside, facing the eye";
    EXPECT_NEAR(hits[1].normal.z, -0.8, 1e-6);
}

TEST(Surfaces, ThatCoincideAreAllKeptInTheScenesOrder) {
    scene::Scene scene;
    for (const float opacity : {0.5f, 0.25f, 0.125f}) scene.objects.push_back(wall(1, Vec3f(opacity)));
    const std::vector<SurfaceHit> hits = hits_along_z(scene, 0.3, 0.1);
    ASSERT_EQ(hits.size(), 3u);
    EXPECT_EQ(hits[0].opacity.x, 0.5);
    EXPECT_EQ(hits[1].opacity.x, 0.25);
    EXPECT_EQ(hits[2].opacity.x, 0.125);
}

// Pixels of a camera that looks at a quad's middle pass through its diagonal.
TEST(Surfaces, AreMetOnceWhereTrianglesShareAnEdgeOrACorner) {
    scene::Mesh fan;  // eight triangles about (0, 0, 0), and a border
    fan.positions = {{0, 0, 0}};
    for (int i = 0; i < 8; ++i)
        fan.positions.push_back({static_cast<float>(std::lround(std::cos(i * std::acos(0.0) / 2) * 1.2)),
                                 static_cast<float>(std::lround(std::sin(i * std::acos(0.0) / 2) * 1.2)), 0});
    for (int i = 0; i < 8; ++i) fan.triangles.push_back({0, 1 + i, 1 + (i + 1) % 8});
    scene::Scene scene;
    scene.objects = {with(fan, Vec3f(0.5f))};
    const double places[][2] = {{0, 0}, {0.5, 0.5}, {0.25, -0.25}, {0, 0.75}, {-0.125, 0}, {0.3, 0.1}, {1, 0.3}};
    for (const auto& [x, y] : places) EXPECT_EQ(hits_along_z(scene, x, y).size(), 1u) << x << " " << y;
    // Twice if the mesh has each triangle twice.
    const std::vector<base::Vec3i> once = fan.triangles;
    fan.triangles.insert(fan.triangles.end(), once.begin(), once.end());
    scene.objects = {with(fan, Vec3f(0.5f))};
    for (std::size_t i = 0; i < 6; ++i)
        EXPECT_EQ(hits_along_z(scene, places[i][0], places[i][1]).size(), 2u) << places[i][0] << " " << places[i][1];
}

// Otherwise a picture shows a strand that is thinner than a view ray as dots, or not at all.
TEST(Surfaces, OfHairThinnerThanAViewRayCoverTheirShareOfIt) {
    scene::Scene scene;  // a strand of two segments across the rays, and one that is wide enough
    scene.objects = {with(scene::Hair{{{-1, 0, 1}, {0, 0, 1}, {1, 0, 1}}, {0.01f, 0.01f, 0.01f}, {0, 3}}, Vec3f(1)),
                     with(scene::Hair{{{-1, 0, 2}, {1, 0, 2}}, {0.5f, 0.5f}, {0, 2}}, Vec3f(1))};
    const Tracer tracer(scene, false, ViewedHair{{0, 0, -3}, {0, 0, 1}, 0.02});  // 0.08 at the depth of the first
    std::vector<SurfaceHit> hits;
    double covered = 0.0;
    for (int i = -50; i < 50; ++i) {
        const double y = (i + 0.5) * 0.002;
        EXPECT_TRUE(tracer.surfaces({0.3, y, -3}, {0, 0, 1}, hits)) << "the wide strand stays opaque";
        ASSERT_EQ(hits.size(), std::abs(y) < 0.08 ? 2u : 1u) << y;
        EXPECT_EQ(hits.back().opacity, Vec3d(1.0));
        if (hits.size() == 2) covered += hits[0].opacity.x * 0.002;
    }
    EXPECT_NEAR(covered, 2 * 0.01, 2e-4) << "as much of the picture as before";
    tracer.surfaces({0.0, 0.05, -3}, {0, 0, 1}, hits);
    EXPECT_EQ(hits.size(), 2u) << "once where its segments join";
    Tracer(scene, false).surfaces({0.3, 0.05, -3}, {0, 0, 1}, hits);
    EXPECT_EQ(hits.size(), 1u) << "as thin as it is for all others";
}

TEST(Surfaces, HaveTheirTexturesOpacity) {
    auto texture = std::make_shared<scene::AlphaTexture>();
    texture->width = 4;
    texture->height = 1;
    texture->alpha = {0.0f, 0.25f, 0.5f, 1.0f};
    scene::Object leaf = wall(1, Vec3f(0.5f));
    auto& mesh = std::get<scene::Mesh>(leaf.shape);
    mesh.corner_uv = {{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}};
    mesh.alpha = texture;
    scene::Scene scene;
    scene.objects = {leaf, wall(2, Vec3f(1))};
    for (int i = 1; i < 4; ++i) {  // at the texels' centres
        const std::vector<SurfaceHit> hits = hits_along_z(scene, -1.0 + (i + 0.5) / 2.0, 0.1);
        ASSERT_EQ(hits.size(), 2u);
        EXPECT_NEAR(hits[0].opacity.x, 0.5 * texture->alpha[static_cast<std::size_t>(i)], 1e-5);
    }
    EXPECT_EQ(hits_along_z(scene, -0.75, 0.1).size(), 1u) << "a hole";
    scene.objects[0].opacity = Vec3f(1);
    EXPECT_EQ(hits_along_z(scene, 0.75, 0.1).size(), 1u) << "texel and object opaque: the ray ends";
}

// In a scene with every kind of surface, the surfaces together transmit as much as the segments.
TEST(Surfaces, LetThroughWhatAllSegmentsDo) {
    scene::Scene scene;
    scene.objects = {testing::curly_hair(200, 20, 0.03f, 2), with(scene::Spheres{{{0.2f, 0, 0}}, {0.6f}}, Vec3f(0.2f)),
                     wall(0.2f, {0.3f, 0.6f, 0.1f}), wall(-0.4f, Vec3f(0.05f))};
    scene.objects[0].opacity = Vec3f(0.3f);
    const Tracer tracer(scene, false);
    base::Random random(3);
    std::vector<SurfaceHit> hits;
    std::vector<TracedSegment> segments;
    std::size_t crossings = 0;
    for (int i = 0; i < 20000; ++i) {
        const Vec3d origin(random.uniform(-1, 1), random.uniform(-1, 1), -3);
        const Vec3d direction = Vec3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)) - origin;
        tracer.surfaces(origin, direction, hits);
        tracer.all_segments(origin, direction, 0.0, 1e9, segments);
        Vec3d left(1.0), right(1.0);
        double last = 0.0;
        for (const SurfaceHit& hit : hits) {
            left *= Vec3d(1.0) - hit.opacity;
            EXPECT_GE(hit.t, last - 1e-5);
            last = hit.t;
        }
        for (const TracedSegment& s : segments) right *= s.transmittance;
        crossings += hits.size();
        ASSERT_NEAR((left - right).length(), 0.0, 1e-12) << i;
    }
    EXPECT_GT(crossings, 60000u);
}

}  // namespace
}  // namespace shadowbench::rays
