// Objects as Embree geometries, and the queries of rays through them. Embree finds candidates; this code decides in
// double what is crossed, and where. Embree's types are only declared, so that its headers stay in the .cpp files.
#pragma once

#include <vector>

#include "base/vec.h"
#include "rays/tracer.h"
#include "scene/scene.h"

struct RTCDeviceTy;
struct RTCGeometryTy;
struct RTCSceneTy;

namespace shadowbench::rays {

// One geometry, and the meaning of its primitives.
struct Traced {
    const scene::Object* object;
    scene::HairSegments segments;  // hair
    std::vector<float> widened;    // hair: half-width of each point; empty: as in the scene
};

// The query of one ray.
struct TracedRay {
    base::Vec3d origin, direction;
    double time;  // in the shutter, [0, 1]
    double t_min, t_max;
};

// The widened half-widths of hair; empty if all are at least as wide. That it moves is neglected.
std::vector<float> widened(const scene::Hair& hair, const ViewedHair& viewed);

// Makes a geometry to attach to a scene; it keeps a reference to `traced`. A moving object has two time steps, between
// which Embree moves its vertices and bounds linearly. Grid volumes have no geometry.
RTCGeometryTy* make_geometry(RTCDeviceTy* device, Traced& traced);

// Appends all crossings, unsorted. `widest_hair` is the largest half-width in the scene.
void trace_all(RTCSceneTy* scene, double widest_hair, const TracedRay& ray, std::vector<TracedSegment>& out);

// A surface on a ray. `hit.t`, `tangent`, `opacity` and `normal` are set; the normal is Embree's, of any length and
// side.
struct Crossing {
    double depth;  // t in double, for the order; hit.t is Embree's, in float
    SurfaceHit hit;
    unsigned geometry, primitive;
    const Traced* traced;
    bool at_edge;  // mesh: within a ten-thousandth of a triangle's edge
};

// Whether a surface of this opacity transmits nothing; whether it absorbs nothing.
inline bool is_opaque(const base::Vec3f& opacity) {
    return opacity.x >= 1.0f && opacity.y >= 1.0f && opacity.z >= 1.0f;
}
inline bool is_nothing(const base::Vec3f& opacity) {
    return !(opacity.x > 0.0f || opacity.y > 0.0f || opacity.z > 0.0f);
}

// Finds the nearest crossing of an opaque surface; returns false if there is none.
bool trace_opaque(RTCSceneTy* scene, double widest_hair, const TracedRay& ray, Crossing& out);

// Appends all crossings of surfaces that are neither opaque nor fully transparent, unsorted.
void trace_translucent(RTCSceneTy* scene, double widest_hair, const TracedRay& ray, std::vector<Crossing>& out);

// The transmittance per channel, given the optical depth of one unit of extinction.
base::Vec3d transmitted(const base::Vec3f& extinction, double optical_depth);

// The ray's origin relative to a moving object that is kept at its position at time 0.
inline base::Vec3d origin_beside(const scene::Object& object, const TracedRay& ray) {
    return ray.origin - base::Vec3d(object.motion) * ray.time;
}

}  // namespace shadowbench::rays
