// Bounds of what crosses the near plane of a light that shines to all sides, and the tiles that they meet.
#include "rays/bins.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <variant>

#include "base/random.h"
#include "rays/moving.h"
#include "rays/prepared.h"
#include "rays/scenes.h"

namespace shadowbench::rays {
namespace {

using base::Vec3f;

Vec3d somewhere(base::Random& random, double reach) {
    return {random.uniform(-reach, reach), random.uniform(-reach, reach), random.uniform(-reach, reach)};
}

bool holds(const PlaneBox& box, const Vec3d& p) {
    const double x = p.x / p.z, y = p.y / p.z;
    return box.x_low <= x && x <= box.x_high && box.y_low <= y && y <= box.y_high;
}

// Points of a moving segment of hair, chosen at random on it: without the corners at the near plane, or those between
// the two positions, some lie outside the bounds, and capture would lose their rays.
TEST(Bins, HoldEveryPointBehindTheNearPlane) {
    LightView view;
    view.perspective = true;
    view.z_near = 0.05;
    base::Random random(3);
    int seen = 0, lost = 0;
    for (int k = 0; k < 300; ++k) {
        const HairSegment s{Vec3f(somewhere(random, 0.4)), Vec3f(somewhere(random, 0.4)),
                            static_cast<float>(random.uniform(0, 0.2)), static_cast<float>(random.uniform(0, 0.2)),
                            false};
        const Vec3d motion = somewhere(random, 0.2);
        const PlaneBox box = swept(view, place_hair(view, s, {0, 0, 0}), place_hair(view, s, motion));
        PlaneBox still;
        add_hair(view, Vec3d(s.a), s.radius_a, Vec3d(s.b), s.radius_b, still);
        for (int n = 0; n < 100; ++n) {
            const double u = random.uniform();
            const Vec3d aside = somewhere(random, 1.0);
            const double reach = (s.radius_a + (s.radius_b - s.radius_a) * u) / std::max(1.0, aside.length());
            const Vec3d p = Vec3d(s.a) + (Vec3d(s.b) - Vec3d(s.a)) * u + aside * reach;
            const Vec3d moved = p + motion * random.uniform();
            if (p.z > view.z_near) lost += !holds(still, p);
            if (moved.z > view.z_near) lost += !holds(box, moved);
            seen += p.z > view.z_near;
        }
    }
    EXPECT_GT(seen, 5000);
    EXPECT_EQ(lost, 0);
}

// Nothing beside the light is within the 45 degrees of its map, so nothing is listed; when everything that crosses the
// near plane was listed for all tiles and tested by all their rays, a ball of hair took ten minutes.
TEST(Bins, WhatStandsBesideALightMeetsNoTile) {
    scene::Scene scene;
    scene.objects.push_back(testing::curly_hair(100, 20, 0.01f, 4));
    for (Vec3f& p : std::get<scene::Hair>(scene.objects[0].shape).points) p += Vec3f(4, 0, 0);
    scene::Spheres spheres;
    for (int i = 0; i < 20; ++i) {
        spheres.centres.emplace_back(-3.0f, 0.1f * static_cast<float>(i), 0.0f);
        spheres.radii.push_back(0.2f);
    }
    scene.objects.emplace_back();
    scene.objects.back().shape = spheres;
    scene.objects.push_back(scene.objects[0]);
    scene.objects.back().motion = {0.5f, 0, 0.5f};
    scene.objects.push_back(scene.objects[1]);
    scene.objects.back().motion = {0.1f, 0, 0.5f};
    const scene::Light light = testing::spot({0, 0, 0.001}, 90);
    const LightView view = make_light_view(light, scene, {16, 16}, "/lights/0");
    MapLayout layout = make_layout(scene, view, testing::rays(16, 4));
    layout.tile_width = layout.tile_height = 2;
    for (const scene::Object& object : scene.objects)
        EXPECT_EQ(prepare(object, view, layout).bins.primitives.size(), 0u) << object.motion;
}

}  // namespace
}  // namespace shadowbench::rays
