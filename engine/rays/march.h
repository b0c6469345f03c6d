// Media along a ray point(t) = origin + t * direction, world space; `scale` is world length per unit of t.
#pragma once

#include <cstddef>
#include <vector>

#include "base/vec.h"

namespace shadowbench::scene {
struct GridVolume;
}

namespace shadowbench::rays {

// Optical depth of one unit of extinction over [front, back]: multiply by a channel's extinction for -log of
// transmittance.
struct MediumSegment {
    float front, back;
    double depth;
};

// A grid made ready for marching: knows which blocks of voxels are empty.
class VolumeMarcher {
public:
    explicit VolumeMarcher(const scene::GridVolume& volume);

    // Marches [t_min, t_max] at regular steps from where the ray enters the box, joins the samples by the trapezoid
    // rule (Lokovic and Veach 2000, section 3.2) and appends the steps that hold something. Neighbouring steps share
    // their ends exactly. A step is volume.step of world length; the last one may be shorter. Every segment is at least
    // one float long: steps shorter than that are joined. Appends nothing where the origin is so far away that distances
    // from it in double cannot tell voxels apart.
    void march(const base::Vec3d& origin, const base::Vec3d& direction, double scale, double t_min, double t_max,
               std::vector<MediumSegment>& out) const;

    std::size_t bytes() const { return occupied_.capacity(); }

private:
    double density(const base::Vec3d& index) const;
    double empty_ahead(const base::Vec3d& index, const base::Vec3d& slope) const;

    const scene::GridVolume& volume_;
    base::Vec3i blocks_;
    std::vector<unsigned char> occupied_;  // block_size^3 cells a block; 1: some corner of them has density
};

// The stretch of the ray inside a sphere, before clipping; false when it misses.
bool sphere_stretch(const base::Vec3d& origin, const base::Vec3d& direction, const base::Vec3d& centre, double radius,
                    double& front, double& back);

}  // namespace shadowbench::rays
