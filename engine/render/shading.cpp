#include "render/shading.h"

#include <algorithm>
#include <cmath>

#include "scene/scene.h"

namespace shadowbench::render {

using base::Vec3d;

Vec3d towards(const scene::Light& light, const Vec3d& point) {
    return light.type == scene::LightType::spot ? (light.position - point).normalized() : -light.direction;
}

double shade_surface(const Vec3d& normal, const Vec3d& to_light) {
    return surface_albedo * std::max(0.0, normal.dot(to_light));
}

double shade_hair(const Vec3d& tangent, const Vec3d& to_light, const Vec3d& to_eye) {
    const auto sine = [](double cosine) { return std::sqrt(std::max(0.0, 1.0 - cosine * cosine)); };
    const double light = tangent.dot(to_light), eye = tangent.dot(to_eye);
    // Light that meets the strand at angle a leaves it on the cone at angle pi - a.
    const double mirrored = std::max(0.0, sine(light) * sine(eye) - light * eye);
    return hair_diffuse * sine(light) + hair_specular * std::pow(mirrored, hair_exponent);
}

}  // namespace shadowbench::render
