#include "rays/traced_geometry.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "rays/march.h"
#include "rays/traced_primitives.h"

namespace shadowbench::rays {
namespace {

using base::Vec3d;
using base::Vec3f;

constexpr float edge_reach = 1e-4f;  // corner weights of a triangle below which a ray is at its edge

// Collects the results of one query; Embree passes it back in its callbacks. With neither list, finds the nearest
// opaque surface.
struct Query : RTCIntersectContext {
    TracedRay ray;
    double back_off;  // t from where Embree's ray starts to the ray's origin
    std::vector<TracedSegment>* segments = nullptr;
    std::vector<Crossing>* translucent = nullptr;  // surfaces

    bool nearest() const { return !segments && !translucent; }
};

bool is_between(const TracedRay& ray, double t) {
    return t > ray.t_min && t <= ray.t_max;
}

void add_translucent(Query& q, const Traced& traced, const RTCHit& hit, double t, double depth, const Vec3f& opacity) {
    if (is_opaque(opacity) || is_nothing(opacity)) return;
    const bool at_edge = std::holds_alternative<scene::Mesh>(traced.object->shape) &&
                         std::min({hit.u, hit.v, 1.0f - hit.u - hit.v}) < edge_reach;
    q.translucent->push_back(
        {depth,
         {t, Vec3d(0.0), Vec3d(hit.Ng_x, hit.Ng_y, hit.Ng_z), strand_direction(traced, hit.primID), Vec3d(opacity)},
         hit.geomID,
         hit.primID,
         &traced,
         at_edge});
}

// Embree calls it for every crossing of a triangle or a ribbon. Keeps the crossing and lets the ray continue, or
// accepts it if the query asks for the nearest one.
void collect(const RTCFilterFunctionNArguments* args) {
    const auto& traced = *static_cast<const Traced*>(args->geometryUserPtr);
    auto& q = *static_cast<Query*>(args->context);
    const auto* hit = reinterpret_cast<const RTCHit*>(args->hit);
    const double embree_t = reinterpret_cast<const RTCRay*>(args->ray)->tfar - q.back_off;
    double t = embree_t;
    Vec3f opacity = traced.object->opacity;
    if (const auto* hair = std::get_if<scene::Hair>(&traced.object->shape)) {
        if (!q.nearest() && !hair_crossing(traced, *hair, hit->primID, q.ray, t)) {
            args->valid[0] = 0;
            return;
        }
        opacity *= covered_share(traced, *hair, hit->primID, hit->u);
    } else if (const auto* mesh = std::get_if<scene::Mesh>(&traced.object->shape)) {
        opacity = opacity_at(*traced.object, *mesh, hit->primID, hit->u, hit->v);
        triangle_depth(*traced.object, *mesh, hit->primID, q.ray, t);
    }
    if (q.nearest()) {
        if (t <= q.ray.t_min || !is_opaque(opacity)) args->valid[0] = 0;
        return;
    }
    args->valid[0] = 0;
    if (!is_between(q.ray, t)) return;
    if (q.translucent)
        add_translucent(q, traced, *hit, embree_t, t, opacity);
    else if (!is_nothing(opacity))
        q.segments->push_back({t, t, Vec3d(1.0) - Vec3d(opacity)});
}

struct SphereList {
    const std::vector<Vec3f>* centres;
    const std::vector<float>* radii;
};
SphereList spheres_of(const scene::Object& object) {
    if (const auto* spheres = std::get_if<scene::Spheres>(&object.shape)) return {&spheres->centres, &spheres->radii};
    const auto& particles = std::get<scene::Particles>(object.shape);
    return {&particles.centres, &particles.radii};
}

void sphere_bounds(const RTCBoundsFunctionArguments* args) {
    const scene::Object& object = *static_cast<const Traced*>(args->geometryUserPtr)->object;
    const SphereList list = spheres_of(object);
    const Vec3f c = (*list.centres)[args->primID] + object.motion * static_cast<float>(args->timeStep);
    const float r = (*list.radii)[args->primID] * 1.00001f;
    *args->bounds_o = {c.x - r, c.y - r, c.z - r, 0, c.x + r, c.y + r, c.z + r, 0};
}

// Reports a hit as Embree does for its own primitives: t from the start of its ray, in float.
void fill(const RTCIntersectFunctionNArguments* args, float tfar, const Vec3d& normal, RTCRay& ray, RTCHit& hit) {
    ray.tfar = tfar;
    hit.Ng_x = static_cast<float>(normal.x);
    hit.Ng_y = static_cast<float>(normal.y);
    hit.Ng_z = static_cast<float>(normal.z);
    hit.geomID = args->geomID;
    hit.primID = args->primID;
}

// Makes the nearer crossing of an opaque sphere after the ray's start the nearest hit so far.
void accept_sphere(const RTCIntersectFunctionNArguments* args, const Query& q, const Vec3d& from_centre, double front,
                   double back) {
    auto* rayhit = reinterpret_cast<RTCRayHit*>(args->rayhit);
    const double t = front > q.ray.t_min ? front : back;
    if (t <= q.ray.t_min || t + q.back_off >= rayhit->ray.tfar) return;
    fill(args, static_cast<float>(t + q.back_off), from_centre + q.ray.direction * t, rayhit->ray, rayhit->hit);
}

void add_sphere(const RTCIntersectFunctionNArguments* args, Query& q, const Traced& traced, const Vec3d& from_centre,
                double t) {
    RTCRay ray{};
    RTCHit hit{};
    fill(args, static_cast<float>(t + q.back_off), from_centre + q.ray.direction * t, ray, hit);
    add_translucent(q, traced, hit, ray.tfar - q.back_off, t, traced.object->opacity);
}

void sphere_intersect(const RTCIntersectFunctionNArguments* args) {
    if (!args->valid[0]) return;
    const auto& traced = *static_cast<const Traced*>(args->geometryUserPtr);
    const scene::Object& object = *traced.object;
    auto& q = *static_cast<Query*>(args->context);
    const SphereList list = spheres_of(object);
    const Vec3d centre((*list.centres)[args->primID]), origin = origin_beside(object, q.ray);
    double front, back;
    if (!sphere_stretch(origin, q.ray.direction, centre, (*list.radii)[args->primID], front, back)) return;
    if (const auto* particles = std::get_if<scene::Particles>(&object.shape)) {
        if (!q.segments) return;
        front = std::max(front, q.ray.t_min);
        back = std::min(back, q.ray.t_max);
        const double length = (back - front) * q.ray.direction.length();
        if (back > front)
            q.segments->push_back(
                {front, back, transmitted(object.extinction, length * particles->density[args->primID])});
    } else if (q.nearest()) {
        if (is_opaque(object.opacity)) accept_sphere(args, q, origin - centre, front, back);
    } else if (!is_nothing(object.opacity)) {
        for (const double t : {front, back}) {
            if (!is_between(q.ray, t)) continue;
            if (q.translucent)
                add_sphere(args, q, traced, origin - centre, t);
            else
                q.segments->push_back({t, t, Vec3d(1.0) - Vec3d(object.opacity)});
        }
    }
}

void set_vertices(RTCGeometry g, const scene::Object& object, const scene::Mesh& mesh, unsigned step) {
    auto* points = static_cast<Vec3f*>(
        rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, step, RTC_FORMAT_FLOAT3, 12, mesh.positions.size()));
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        points[i] = mesh.positions[i] + object.motion * static_cast<float>(step);
}

void set_vertices(RTCGeometry g, const scene::Object& object, const scene::Hair& hair, const std::vector<float>& radii,
                  unsigned step) {
    auto* points = static_cast<float*>(
        rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, step, RTC_FORMAT_FLOAT4, 16, hair.points.size()));
    for (std::size_t i = 0; i < hair.points.size(); ++i) {
        const Vec3f p = hair.points[i] + object.motion * static_cast<float>(step);
        for (int a = 0; a < 3; ++a) points[4 * i + a] = p[a];
        points[4 * i + 3] = radii[i];
    }
}

// Embree skips ribbons that a ray meets within twice their half-width of its start, so that rays from hair do not hit
// it. Here they count, so the ray starts further back, and crossings before t_min are dropped.
RTCRayHit trace(RTCScene scene, double widest_hair, Query& q) {
    const TracedRay& ray = q.ray;
    q.back_off = 4.0 * widest_hair / ray.direction.length();
    const Vec3d start = ray.origin - ray.direction * q.back_off;
    RTCRayHit rayhit{};
    rayhit.ray.org_x = static_cast<float>(start.x);
    rayhit.ray.org_y = static_cast<float>(start.y);
    rayhit.ray.org_z = static_cast<float>(start.z);
    rayhit.ray.dir_x = static_cast<float>(ray.direction.x);
    rayhit.ray.dir_y = static_cast<float>(ray.direction.y);
    rayhit.ray.dir_z = static_cast<float>(ray.direction.z);
    rayhit.ray.time = static_cast<float>(ray.time);
    rayhit.ray.tnear = widest_hair > 0.0 ? 0.0f : static_cast<float>(std::max(ray.t_min, 0.0));
    // Slightly further than asked, since the exact depths are computed again from what Embree finds.
    rayhit.ray.tfar = static_cast<float>(std::min(ray.t_max * 1.0001 + q.back_off, 3e38));
    rayhit.ray.mask = ~0u;
    rayhit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene, &q, &rayhit);
    return rayhit;
}

Query make_query(const TracedRay& ray) {
    Query q;
    rtcInitIntersectContext(&q);
    q.ray = ray;
    return q;
}

}  // namespace

std::vector<float> widened(const scene::Hair& hair, const ViewedHair& viewed) {
    std::vector<float> radii = hair.radii;
    bool wider = false;
    for (std::size_t i = 0; i < radii.size(); ++i) {
        const double depth = (Vec3d(hair.points[i]) - viewed.eye).dot(viewed.forward);
        const auto least = static_cast<float>(viewed.half_width * depth);
        if (!(radii[i] > 0.0f && radii[i] < least)) continue;
        radii[i] = least;
        wider = true;
    }
    return wider ? radii : std::vector<float>();
}

RTCGeometryTy* make_geometry(RTCDeviceTy* device, Traced& traced) {
    const scene::Object& object = *traced.object;
    const unsigned steps = object.motion != Vec3f(0, 0, 0) ? 2 : 1;
    const auto geometry = [&](RTCGeometryType type) {
        RTCGeometry g = rtcNewGeometry(device, type);
        rtcSetGeometryTimeStepCount(g, steps);
        rtcSetGeometryUserData(g, &traced);
        return g;
    };
    RTCGeometry g;
    if (const auto* mesh = std::get_if<scene::Mesh>(&object.shape)) {
        g = geometry(RTC_GEOMETRY_TYPE_TRIANGLE);
        for (unsigned step = 0; step < steps; ++step) set_vertices(g, object, *mesh, step);
        void* index =
            rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, mesh->triangles.size());
        std::copy(mesh->triangles.begin(), mesh->triangles.end(), static_cast<base::Vec3i*>(index));
        rtcSetGeometryIntersectFilterFunction(g, collect);
    } else if (const auto* hair = std::get_if<scene::Hair>(&object.shape)) {
        traced.segments = segments(*hair);
        const std::vector<std::uint32_t>& first = traced.segments.first;
        g = geometry(RTC_GEOMETRY_TYPE_FLAT_LINEAR_CURVE);
        for (unsigned step = 0; step < steps; ++step)
            set_vertices(g, object, *hair, traced.widened.empty() ? hair->radii : traced.widened, step);
        void* index = rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT, 4, first.size());
        std::copy(first.begin(), first.end(), static_cast<std::uint32_t*>(index));
        rtcSetGeometryIntersectFilterFunction(g, collect);
    } else {
        g = geometry(RTC_GEOMETRY_TYPE_USER);
        rtcSetGeometryUserPrimitiveCount(g, static_cast<unsigned>(spheres_of(object).centres->size()));
        rtcSetGeometryBoundsFunction(g, sphere_bounds, nullptr);
        rtcSetGeometryIntersectFunction(g, sphere_intersect);
    }
    rtcCommitGeometry(g);
    return g;
}

void trace_all(RTCSceneTy* scene, double widest_hair, const TracedRay& ray, std::vector<TracedSegment>& out) {
    Query q = make_query(ray);
    q.segments = &out;
    trace(scene, widest_hair, q);
}

bool trace_opaque(RTCSceneTy* scene, double widest_hair, const TracedRay& ray, Crossing& out) {
    Query q = make_query(ray);
    const RTCRayHit found = trace(scene, widest_hair, q);
    if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    const unsigned primitive = found.hit.primID;
    const auto& traced = *static_cast<const Traced*>(rtcGetGeometryUserData(rtcGetGeometry(scene, found.hit.geomID)));
    const double t = found.ray.tfar - q.back_off;
    out = {depth_of(traced, primitive, ray, t),
           {t, Vec3d(0.0), Vec3d(found.hit.Ng_x, found.hit.Ng_y, found.hit.Ng_z), strand_direction(traced, primitive),
            Vec3d(1.0)},
           found.hit.geomID,
           primitive,
           &traced,
           false};
    return true;
}

void trace_translucent(RTCSceneTy* scene, double widest_hair, const TracedRay& ray, std::vector<Crossing>& out) {
    Query q = make_query(ray);
    q.translucent = &out;
    trace(scene, widest_hair, q);
}

Vec3d transmitted(const Vec3f& extinction, double optical_depth) {
    Vec3d t;
    t[0] = std::exp(-optical_depth * extinction[0]);
    for (int c = 1; c < 3; ++c) t[c] = extinction[c] == extinction[0] ? t[0] : std::exp(-optical_depth * extinction[c]);
    return t;
}

}  // namespace shadowbench::rays
