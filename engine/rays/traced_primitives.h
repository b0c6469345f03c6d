// What Embree's candidates are, exactly: in double, on coordinates stored as float.
#pragma once

#include "base/vec.h"
#include "rays/traced_geometry.h"

namespace shadowbench::rays {

// Whether this segment has the ray's crossing of a joint, and the depth of the strand's axis: the ray's closest
// approach. `t` stays where the earlier segment has it.
bool hair_crossing(const Traced& traced, const scene::Hair& hair, unsigned segment, const TracedRay& ray, double& t);

// At a place of a triangle, with Embree's weights of its second and third corner.
base::Vec3f opacity_at(const scene::Object& object, const scene::Mesh& mesh, unsigned triangle, double u, double v);

// Where the ray passes a triangle's plane; `t` stays where it runs in the plane.
void triangle_depth(const scene::Object& object, const scene::Mesh& mesh, unsigned triangle, const TracedRay& ray,
                    double& t);

// t in double, where that is known; else as Embree has it.
double depth_of(const Traced& traced, unsigned primitive, const TracedRay& ray, double t);

// 0 for what is not hair.
base::Vec3d strand_direction(const Traced& traced, unsigned primitive);

// Whether the triangle is crossed by the ray turned aside by a billionth, which passes through no edge: of the
// triangles that meet in an edge or a corner, one is.
bool crosses_beside(const scene::Object& object, const scene::Mesh& mesh, unsigned triangle, const TracedRay& ray);

}  // namespace shadowbench::rays
