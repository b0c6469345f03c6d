// Procedural scene content. The same parameters and seed give the same values on any machine and thread count.
#pragma once

#include <cstdint>

#include "scene/scene.h"

namespace shadowbench::scene {

// A ball covered with curly hairs, after the scene of Lokovic and Veach 2000, section 6 (50,000 hairs).
struct HairBall {
    int strands = 50000;
    int segments = 16;  // per strand
    Vec3d centre{0, 0, 0};
    double ball_radius = 1.0;  // where the roots are
    double length = 0.6;       // of a hair, along its axis
    double curl_radius = 0.04;
    double curls = 3.0;      // turns per hair
    double clumping = 0.5;   // 0: even; 1: all hairs of a tuft lean to its middle
    double radius = 0.0015;  // half-width of a hair at its root; a quarter of it at the tip
    std::uint64_t seed = 1;
};
Hair make_hair_ball(const HairBall& parameters);

// A cloud: fractal noise inside an ellipsoid that fills the box, density in [0, 1].
struct Cloud {
    Vec3i size{64, 64, 64};
    Vec3d lower{-1, -1, -1}, upper{1, 1, 1};
    int octaves = 5;
    double coverage = 0.5;  // in (0, 1): roughly the share of the ellipsoid that is not clear
    std::uint64_t seed = 1;
};
GridVolume make_cloud(const Cloud& parameters);

// A box whose density falls from nearly 1 at its middle to nearly 0 at its faces, in proportion to the distance from
// the nearest face (measured as if the box were a cube): the first data set of the paper on deep shadow maps of
// volumes.
struct DensityBox {
    Vec3i size{64, 64, 64};
    Vec3d lower{-1, -1, -1}, upper{1, 1, 1};
};
GridVolume make_density_box(const DensityBox& parameters);

// Three rods, one along each axis, that cross in the middle of the box: density 1 inside, 0 outside. The third data set
// of the same paper.
struct CrossedRods {
    Vec3i size{64, 64, 64};
    Vec3d lower{-1, -1, -1}, upper{1, 1, 1};
    double radius = 0.25;  // of a rod, world length
};
GridVolume make_crossed_rods(const CrossedRods& parameters);

// A rising column of puffs that widens and thins out, as in Salvi et al. 2010.
struct SmokeColumn {
    int particles = 2000;
    Vec3d base{0, 0, 0};
    double height = 3.0;
    double width = 0.35;        // of the column at its base; three times as wide at the top
    double puff_radius = 0.12;  // at the base; twice as large at the top
    double density = 2.0;       // of a puff at the base; a quarter of it at the top
    std::uint64_t seed = 1;
};
Particles make_smoke_column(const SmokeColumn& parameters);

}  // namespace shadowbench::scene
