// Media along a ray point(t) = origin + t * direction, world space; `scale` is world length per unit of t.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "base/vec.h"
#include "rays/grid_density.h"
#include "rays/voxel_blocks.h"

namespace shadowbench::scene {
struct GridVolume;
}

namespace shadowbench::rays {

// The optical depth of one unit of extinction over [front, back]. Multiply it by a channel's extinction to get
// -log(transmittance).
struct MediumSegment {
    float front, back;
    double depth;
};

// A segment that transmits so much.
struct MediumStep {
    float front, back, transmittance;
};

struct WorldRay {
    base::Vec3d origin, direction;
    double scale;
};

// A grid prepared for rays: knows which blocks of voxels are empty. Rays are in the world; a grid that is turned or
// sheared there is met by the ray in its own space, at the same t, so integrals stay exact.
// Density is trilinear between voxel centres, and constant in the half voxel outside the outermost ones. Along a ray it
// is a cubic polynomial inside each cell (the box between eight centres), so the two-point Gauss-Legendre rule gives
// its integral exactly.
// All functions see nothing if the origin is so far away that distances from it in double cannot resolve voxels.
class VolumeMarcher {
public:
    explicit VolumeMarcher(const scene::GridVolume& volume);

    // Append the segments with density, in order. Neighbours share their ends exactly. Each is at least one float long:
    // shorter ones are joined.
    //  - march: regular steps from where the ray enters the box; the trapezoid rule joins the samples (Lokovic
    //    and Veach 2000, section 3.2). A step is volume.step of world length; the last one may be shorter.
    //  - march_cells: one segment for each cell that the ray crosses, with exactly the cell's optical depth.
    void march(const base::Vec3d& origin, const base::Vec3d& direction, double scale, double t_min, double t_max,
               std::vector<MediumSegment>& out) const;
    void march_cells(const base::Vec3d& origin, const base::Vec3d& direction, double scale, double t_min, double t_max,
                     std::vector<MediumSegment>& out) const;

    // The same as march, for up to side_by_side rays at once, and what StepRounding makes of the depths of each ray:
    // the steps that transmit less than 1. `out` is replaced. Returns false if the rays must be marched one by one:
    // where steps are shorter than floats can tell, or darker than a float can hold.
    bool march_side_by_side(std::span<const WorldRay> rays, double t_min, double t_max, float extinction,
                            Lanes<std::vector<MediumStep>>& out) const;

    // The exact optical depth of one unit of extinction from t_min to each value of `t`, which must ascend: depth[i]
    // belongs to t[i], which may be inside a cell. The relative error is that of double sums over the cells crossed.
    void optical_depths(const base::Vec3d& origin, const base::Vec3d& direction, double scale, double t_min,
                        std::span<const double> t, std::span<double> depth) const;

    std::size_t bytes() const { return blocks_.bytes(); }

private:
    // A ray inside the box: voxel coordinates start + slope * s, s in [0, length], at t = t_min + s.
    struct Way {
        base::Vec3d start, slope;
        double t_min, length;
    };
    bool enter(const base::Vec3d& world_origin, const base::Vec3d& world_direction, double t_min, double t_max,
               Way& way) const;
    double density(const base::Vec3d& index) const;
    double integral(const Way& way, double from, double to) const;
    template <class Visit>
    void for_each_cell(const Way& way, const Visit& visit) const;

    const scene::GridVolume& volume_;
    Voxels voxels_;
    VoxelBlocks blocks_;
};

// The part of the ray inside a sphere, before clipping; returns false if the ray misses it.
bool sphere_stretch(const base::Vec3d& origin, const base::Vec3d& direction, const base::Vec3d& centre, double radius,
                    double& front, double& back);

}  // namespace shadowbench::rays
