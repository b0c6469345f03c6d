#include "claims/volume_rays.h"

#include <cmath>
#include <numbers>

#include "render/default_view.h"

namespace shadowbench::claims::volume {

scene::Camera turned(scene::Camera camera, double degrees) {
    const double angle = degrees * std::numbers::pi / 180.0, c = std::cos(angle), s = std::sin(angle);
    const base::Vec3d from = camera.position - camera.target;
    camera.position = camera.target + base::Vec3d(c * from.x + s * from.z, from.y, c * from.z - s * from.x);
    return camera;
}

std::vector<render::BoxRay> view_rays(const scene::Scene& scene, const scene::GridVolume& volume, int side, int view) {
    const scene::Camera camera = turned(render::default_camera(scene), 360.0 / views * view);
    return render::box_rays(camera, {side, side}, volume, static_cast<std::uint64_t>(view + 1));
}

double rms(std::span<const render::BoxRay> rays, std::span<const double> a, std::span<const double> b) {
    double sum = 0.0, count = 0.0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (!rays[i].meets()) continue;
        sum += (a[i] - b[i]) * (a[i] - b[i]);
        count += 1.0;
    }
    return std::sqrt(sum / count);
}

double mean(std::span<const render::BoxRay> rays, std::span<const double> values) {
    double sum = 0.0, count = 0.0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (!rays[i].meets()) continue;
        sum += values[i];
        count += 1.0;
    }
    return sum / count;
}

}  // namespace shadowbench::claims::volume
