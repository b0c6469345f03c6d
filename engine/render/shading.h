// What a point sends to the eye when its light is not shadowed. A light's colour is the radiance that a white surface
// square to it would show; there is no falloff with distance, also for spots, no light between surfaces, and no ambient
// light: what is unlit is black, so that errors of visibility show as they are.
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

// Lambert, for a surface whose normal faces the eye: nothing when the light is on its other side.
double shade_surface(const base::Vec3d& normal, const base::Vec3d& to_light);

// Kajiya and Kay, Rendering Fur with Three Dimensional Textures, SIGGRAPH 1989: a thin cylinder along `tangent`.
// Diffuse sin(t, l); specular cos^p of the angle between the eye and the cone of mirrored light.
double shade_hair(const base::Vec3d& tangent, const base::Vec3d& to_light, const base::Vec3d& to_eye);

}  // namespace shadowbench::render
