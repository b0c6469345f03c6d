#include "rays/light_view.h"

#include <gtest/gtest.h>

#include <utility>

#include "base/error.h"
#include "rays/scenes.h"

namespace shadowbench::rays {
namespace {

scene::Scene one_sphere() {
    scene::Scene scene;
    scene.objects.emplace_back();
    scene.objects[0].shape = scene::Spheres{{{0.5f, 0.25f, 0.0f}}, {0.5f}};
    return scene;
}

TEST(LightView, UnprojectIsTheInverseOfToLight) {
    const scene::Scene scene = one_sphere();
    for (auto light : {testing::directional(3), testing::spot({1, 2, 3}, 50)}) {
        const LightView view = make_light_view(light, scene, {64, 32}, "/lights/0");
        for (const base::Vec3d& p : {base::Vec3d(0.1, 0.2, 0.3), base::Vec3d(-0.5, 0.1, 0.9)}) {
            const base::Vec3d l = to_light(view, p);
            EXPECT_LT((to_world(view, unproject(view, l.x, l.y, l.z)) - p).length(), 1e-12);
        }
    }
}

TEST(LightView, TheTargetIsInTheMiddleOfTheMap) {
    const LightView view = make_light_view(testing::spot({1, 2, 3}, 50), one_sphere(), {64, 32}, "/lights/0");
    const base::Vec3d l = to_light(view, {0, 0, 0});
    EXPECT_NEAR(l.x, 32, 1e-9);
    EXPECT_NEAR(l.y, 16, 1e-9);
    EXPECT_NEAR(l.z, std::sqrt(14.0), 1e-12) << "planar depth along the axis";
}

TEST(LightView, WithoutExtentOrAngleTheCastersJustFit) {
    scene::Light sun = testing::directional();
    sun.extent.reset();
    scene::Light lamp = testing::spot({1, 2, 3}, 50);
    lamp.angle.reset();
    for (const auto& light : {sun, lamp}) {
        const LightView view = make_light_view(light, one_sphere(), {64, 64}, "/lights/0");
        double low = 64, high = 0;
        for (int i = 0; i < 200; ++i) {
            base::Random random(i);
            base::Vec3d d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
            const base::Vec3d l = to_light(view, base::Vec3d(0.5, 0.25, 0) + d.normalized() * 0.5);
            low = std::min({low, l.x, l.y});
            high = std::max({high, l.x, l.y});
            EXPECT_GE(l.z, view.z_min);
            EXPECT_LE(l.z, view.z_max);
        }
        EXPECT_GT(low, 0);
        EXPECT_LT(high, 64);
        EXPECT_GT(high - low, 20);
    }
}

TEST(LightView, ADirectionalLightCanShineAlongItsUpVector) {
    scene::Light light = testing::directional();
    light.direction = {0, -1, 0};
    light.up.reset();
    const LightView view = make_light_view(light, one_sphere(), {8, 8}, "/lights/0");
    EXPECT_NEAR(view.right.length(), 1, 1e-12);
    EXPECT_NEAR(view.right.dot(view.forward), 0, 1e-12);
}

TEST(LightView, ASpotThatLooksAwayFromAllCastersHasDepthsAllTheSame) {
    const scene::Scene scene = one_sphere();
    EXPECT_FALSE(misses_all(make_light_view(testing::spot({0, 0, -5}, 30), scene, {8, 8}, "/lights/3"), scene))
        << "from z = -5 it looks at the sphere in the origin";
    scene::Light away = testing::spot({0, 0, 5}, 30);
    away.target = {0, 0, 10};
    const LightView view = make_light_view(away, scene, {8, 8}, "/lights/3");
    EXPECT_TRUE(misses_all(view, scene));
    EXPECT_EQ(view.z_min, view.z_near);
    EXPECT_GT(view.z_max, 5.0) << "the target is among them";
    away.angle.reset();
    try {
        make_light_view(away, scene, {8, 8}, "/lights/3");
        FAIL() << "no angle fits what is behind the light";
    } catch (const base::Error& e) {
        EXPECT_EQ(e.code(), base::ErrorCode::bad_input);
        EXPECT_EQ(e.where(), "/lights/3/angle");
    }
}

TEST(LightView, MissesAllWhereEveryCasterIsBesideTheMap) {
    scene::Scene scene = one_sphere();
    scene::Light light = testing::directional();
    for (const auto& [x, misses] : {std::pair{0.0, false}, {1.9, false}, {50.0, true}, {-50.0, true}}) {
        light.target = {x, 0, 0};
        light.extent = base::Vec2d(2, 2);
        EXPECT_EQ(misses_all(make_light_view(light, scene, {8, 8}, "/lights/0"), scene), misses) << x;
    }
    for (scene::Object& object : scene.objects) object.casts_shadow = false;
    EXPECT_THROW(make_light_view(light, scene, {8, 8}, "/lights/0"), base::Error) << "there is no caster at all";
}

}  // namespace
}  // namespace shadowbench::rays
