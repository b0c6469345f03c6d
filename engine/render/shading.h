// Shading: the light that a point sends to the eye if nothing shadows it. A light's colour is the radiance that a white
// surface facing it would show. There is no falloff with distance, not even for spots, no interreflection and no
// ambient light: unlit points are black, so that errors of visibility show undiminished.
#pragma once

#include "base/vec.h"

namespace shadowbench::scene {
struct Light;
}

namespace shadowbench::render {

inline constexpr double surface_albedo = 0.8;
inline constexpr double hair_diffuse = 0.6, hair_specular = 0.25, hair_exponent = 16.0;
inline constexpr double medium_albedo = 0.9;

// Unit vector from a point to the light.
base::Vec3d towards(const scene::Light& light, const base::Vec3d& point);

// Lambert shading of a surface whose normal faces the eye: 0 if the light is on its other side.
double shade_surface(const base::Vec3d& normal, const base::Vec3d& to_light);

// Kajiya and Kay, Rendering Fur with Three Dimensional Textures, SIGGRAPH 1989: a thin cylinder along `tangent`.
// Diffuse: sin(t, l). Specular: cos^p of the angle between the eye and the cone of mirrored light.
double shade_hair(const base::Vec3d& tangent, const base::Vec3d& to_light, const base::Vec3d& to_eye);

}  // namespace shadowbench::render
