#include "render/shading.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scene/scene.h"

namespace shadowbench::render {
namespace {

using base::Vec3d;

TEST(Shading, of_a_surface_falls_with_the_cosine_and_is_0_behind_it) {
    const Vec3d up(0, 1, 0);
    EXPECT_NEAR(shade_surface(up, up), surface_albedo, 1e-12);
    EXPECT_NEAR(shade_surface(up, Vec3d(1, 1, 0).normalized()), surface_albedo * std::sqrt(0.5), 1e-12);
    EXPECT_EQ(shade_surface(up, Vec3d(0.6, -0.8, 0)), 0.0);
}

TEST(Shading, of_hair_shines_on_the_cone_of_mirrored_light) {
    const Vec3d strand(1, 0, 0), light = Vec3d(-1, 2, 0).normalized();
    const double diffuse = hair_diffuse * 2.0 / std::sqrt(5.0);
    for (const Vec3d& eye : {Vec3d(1, 2, 0), Vec3d(1, 0, 2), Vec3d(1, -2, 0)})
        EXPECT_NEAR(shade_hair(strand, light, eye.normalized()), diffuse + hair_specular, 1e-12)
            << "the same all around the strand";
    EXPECT_LT(shade_hair(strand, light, light), diffuse + 0.01 * hair_specular);
    EXPECT_NEAR(shade_hair(strand, strand, Vec3d(0, 1, 0)), 0.0, 1e-12) << "light along the strand";
}

TEST(Shading, of_a_spot_depends_on_its_position_and_of_a_sun_on_its_direction) {
    scene::Light light;
    light.direction = Vec3d(0, -1, 0);
    light.position = Vec3d(0, 4, 0);
    EXPECT_EQ(towards(light, Vec3d(3, 0, 0)), Vec3d(0, 1, 0));
    light.type = scene::LightType::spot;
    EXPECT_NEAR((towards(light, Vec3d(3, 0, 0)) - Vec3d(-0.6, 0.8, 0)).length(), 0.0, 1e-12);
}

}  // namespace
}  // namespace shadowbench::render
