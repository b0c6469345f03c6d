#include "rays/grid_media.h"

#include <algorithm>
#include <variant>

#include "scene/scene.h"

namespace shadowbench::rays {

GridMedia::GridMedia(const scene::Scene& scene, bool casters_only) {
    for (const scene::Object& object : scene.objects)
        if (const auto* grid = std::get_if<scene::GridVolume>(&object.shape);
            grid && (object.casts_shadow || !casters_only))
            volumes_.push_back({&object, VolumeMarcher(*grid)});
}

void GridMedia::optical_depths(const LightView& view, double x, double y, double time, std::span<const double> z,
                               std::span<base::Vec3d> depth) const {
    std::fill(depth.begin(), depth.end(), base::Vec3d(0.0));
    const LightLine line = light_line(view, x, y);
    thread_local std::vector<double> of_one;
    of_one.resize(z.size());
    for (const Volume& volume : volumes_) {
        volume.marcher.optical_depths(line.origin - base::Vec3d(volume.object->motion) * time, line.direction,
                                      line.scale, line.z_start, z, of_one);
        const base::Vec3d extinction(volume.object->extinction);
        for (std::size_t i = 0; i < z.size(); ++i) depth[i] += extinction * of_one[i];
    }
}

}  // namespace shadowbench::rays
