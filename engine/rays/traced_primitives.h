// Computes exactly what Embree's candidates are: in double, on coordinates stored as float.
#pragma once

#include "base/vec.h"
#include "rays/traced_geometry.h"

namespace shadowbench::rays {

// Whether this segment has the ray's crossing of a joint, and the depth of the strand's axis, which is the ray's
// closest approach. `t` does not change if the earlier segment has it.
bool hair_crossing(const Traced& traced, const scene::Hair& hair, unsigned segment, const TracedRay& ray, double& t);

// The share of its width that a strand covers, at Embree's place `u` along a segment; 1 if it was not widened.
float covered_share(const Traced& traced, const scene::Hair& hair, unsigned segment, float u);

// The opacity at a point of a triangle, with Embree's weights of its second and third corner.
base::Vec3f opacity_at(const scene::Object& object, const scene::Mesh& mesh, unsigned triangle, double u, double v);

// The depth at which the ray crosses a triangle's plane; `t` does not change if the ray runs in the plane.
void triangle_depth(const scene::Object& object, const scene::Mesh& mesh, unsigned triangle, const TracedRay& ray,
                    double& t);

// The depth in double where it can be computed; otherwise Embree's t.
double depth_of(const Traced& traced, unsigned primitive, const TracedRay& ray, double t);

// The direction of a strand; 0 for other primitives.
base::Vec3d strand_direction(const Traced& traced, unsigned primitive);

// Whether the triangle is crossed by the ray deflected by a billionth, which passes through no edge: it crosses one of
// the triangles that meet in an edge or a corner.
bool crosses_beside(const scene::Object& object, const scene::Mesh& mesh, unsigned triangle, const TracedRay& ray);

}  // namespace shadowbench::rays
