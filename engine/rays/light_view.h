// How a light sees the scene: converts world space to light space and back.
// Light space: (x, y) in map pixels, x in [0, width), y in [0, height); pixel (i, j) spans [i, i+1) x [j, j+1). z is
// planar depth along the light's axis in world length, growing away from the light, for both kinds of light.
#pragma once

#include <string>

#include "base/vec.h"

namespace shadowbench::scene {
struct Light;
struct Scene;
}  // namespace shadowbench::scene

namespace shadowbench::rays {

using base::Vec2d;
using base::Vec2i;
using base::Vec3d;

struct LightView {
    bool perspective = false;
    Vec3d origin{0, 0, 0};  // the point of depth 0
    Vec3d right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, 1};
    Vec2d lower{0, 0};       // view-plane position of map corner (0, 0): world length, or slope (x / z) in perspective
    Vec2d pixel{1, 1};       // size of a map pixel on the view plane
    Vec2i resolution{1, 1};  // map pixels
    double z_near = 0.0;     // crossings at z <= z_near are not seen (perspective); orthographic: minus infinity
    double z_min = 0.0;      // depth bounds of the shadow casters
    double z_max = 1.0;
    int face = -1;  // of the cube around a point light (scene/cube_face.h), whose receivers alone it answers; -1: all
};

// The view of the scene's casters; it sees nothing if none is in view. Throws Error{bad_input}: at `where` if there is
// no caster, at its angle if the angle should fit casters that no angle fits.
LightView make_light_view(const scene::Light& light, const scene::Scene& scene, Vec2i resolution,
                          const std::string& where);

// Whether the bounds of the shadow casters surely miss the map; then no light ray meets anything.
bool misses_all(const LightView& view, const scene::Scene& scene);

// View space: coordinates along right, up, forward from the origin.
Vec3d to_view(const LightView& view, const Vec3d& world);
Vec3d to_world(const LightView& view, const Vec3d& view_point);

// Light space of a world point: (x, y in map pixels, z). In perspective, x and y mean nothing for z <= 0.
Vec3d to_light(const LightView& view, const Vec3d& world);

// The view-space point of map position (x, y) at depth z.
Vec3d unproject(const LightView& view, double x, double y, double z);

// The light ray at map position (x, y): at depth z it is at origin + z * direction, in world space.
struct LightLine {
    Vec3d origin, direction;
    double scale;    // its length per unit of z, >= 1
    double z_start;  // crossings before this depth are not seen
};
LightLine light_line(const LightView& view, double x, double y);

// The length of the ray at map position (x, y) per unit of z, >= 1.
double length_per_depth(const LightView& view, double x, double y);

}  // namespace shadowbench::rays
