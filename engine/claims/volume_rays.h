// The view rays of several views of a volume, and numbers over them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/two_pass.h"
#include "scene/scene.h"

namespace shadowbench::claims::volume {

inline constexpr int views = 6;  // around the volume; the range of six numbers holds their median with 97 %

// The camera turned around the vertical axis through its target.
scene::Camera turned(scene::Camera camera, double degrees);

// Rays through random places of side x side pixels of this view, 0 to views - 1; each view has a seed of its own.
std::vector<render::BoxRay> view_rays(const scene::Scene& scene, const scene::GridVolume& volume, int side, int view);

// Over the rays through the box: the RMS of the differences a - b, and the mean.
double rms(std::span<const render::BoxRay> rays, std::span<const double> a, std::span<const double> b);
double mean(std::span<const render::BoxRay> rays, std::span<const double> values);

}  // namespace shadowbench::claims::volume
