// The grid volumes of a scene along light rays, integrated without steps, for the reference and the ray-traced
// technique.
#pragma once

#include <span>
#include <vector>

#include "base/vec.h"
#include "rays/light_view.h"
#include "rays/march.h"

namespace shadowbench::scene {
struct Object;
struct Scene;
}  // namespace shadowbench::scene

namespace shadowbench::rays {

// Keeps a reference to the scene.
class GridMedia {
public:
    GridMedia(const scene::Scene& scene, bool casters_only);

    struct Volume {
        const scene::Object* object;
        VolumeMarcher marcher;
    };
    const std::vector<Volume>& volumes() const { return volumes_; }
    bool empty() const { return volumes_.empty(); }

    // The exact optical depth in each channel of the light ray at map position (x, y) and `time` in the shutter, up to
    // each depth in `z`, which must ascend. `depth` is as long as `z`; it is replaced.
    void optical_depths(const LightView& view, double x, double y, double time, std::span<const double> z,
                        std::span<base::Vec3d> depth) const;

private:
    std::vector<Volume> volumes_;
};

}  // namespace shadowbench::rays
