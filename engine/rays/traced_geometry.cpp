#include "rays/traced_geometry.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "rays/march.h"

namespace shadowbench::rays {
namespace {

using base::Vec3d;
using base::Vec3f;

// Embree hands this back in its callbacks: what one query collects.
struct Query : RTCIntersectContext {
    TracedRay ray;
    double back_off;  // t from where Embree's ray starts to the ray's origin
    bool nearest;     // only the nearest surface; media are passed through
    std::vector<TracedSegment>* out;
};

bool is_between(const TracedRay& ray, double t) {
    return t > ray.t_min && t <= ray.t_max;
}

// Perpendicular distance test at a joint, and the depth of a strand's axis: the ray's closest approach, in double.
bool hair_crossing(const Traced& traced, const scene::Hair& hair, unsigned segment, const TracedRay& ray, double& t) {
    const Vec3d origin = origin_beside(*traced.object, ray);
    const std::uint32_t first = traced.segments.first[segment];
    const double length2 = ray.direction.dot(ray.direction);
    const auto across = [&](const Vec3f& point, double& along) {
        const Vec3d p = Vec3d(point) - origin;
        along = p.dot(ray.direction) / length2;
        return p - ray.direction * along;
    };
    double ta, tb;
    const Vec3d a = across(hair.points[first], ta), b = across(hair.points[first + 1], tb);
    const double radius = hair.radii[first];
    if (traced.segments.joined[segment] && a.dot(a) <= radius * radius) return false;  // the earlier segment has it
    const Vec3d d = b - a;
    const double d2 = d.dot(d);
    const double u = d2 > 0.0 ? std::clamp(-a.dot(d) / d2, 0.0, 1.0) : 0.0;
    t = ta + (tb - ta) * u;
    return true;
}

Vec3f opacity_at(const scene::Object& object, const scene::Mesh& mesh, unsigned triangle, double u, double v) {
    if (!mesh.alpha) return object.opacity;
    const base::Vec2f* uv = &mesh.corner_uv[3 * static_cast<std::size_t>(triangle)];
    const base::Vec2f at =
        uv[0] * static_cast<float>(1.0 - u - v) + uv[1] * static_cast<float>(u) + uv[2] * static_cast<float>(v);
    return object.opacity * scene::sample(*mesh.alpha, at.x, at.y);
}

// Where the ray passes a triangle's plane; `t` stays where it runs in the plane.
void triangle_depth(const scene::Object& object, const scene::Mesh& mesh, unsigned triangle, const TracedRay& ray,
                    double& t) {
    const base::Vec3i& index = mesh.triangles[triangle];
    const Vec3d p0(mesh.positions[index.x]);
    const Vec3d normal = (Vec3d(mesh.positions[index.y]) - p0).cross(Vec3d(mesh.positions[index.z]) - p0);
    if (const double facing = normal.dot(ray.direction); facing != 0.0)
        t = normal.dot(p0 - origin_beside(object, ray)) / facing;
}

// Called by Embree for every crossing of a triangle or a ribbon: keeps it and lets the ray go on.
void collect(const RTCFilterFunctionNArguments* args) {
    const auto& traced = *static_cast<const Traced*>(args->geometryUserPtr);
    auto& q = *static_cast<Query*>(args->context);
    const auto* hit = reinterpret_cast<const RTCHit*>(args->hit);
    double t = reinterpret_cast<const RTCRay*>(args->ray)->tfar - q.back_off;
    Vec3f opacity = traced.object->opacity;
    if (const auto* hair = std::get_if<scene::Hair>(&traced.object->shape)) {
        if (!q.nearest && !hair_crossing(traced, *hair, hit->primID, q.ray, t)) {
            args->valid[0] = 0;
            return;
        }
    } else if (const auto* mesh = std::get_if<scene::Mesh>(&traced.object->shape)) {
        opacity = opacity_at(*traced.object, *mesh, hit->primID, hit->u, hit->v);
        triangle_depth(*traced.object, *mesh, hit->primID, q.ray, t);
    }
    if (q.nearest) {  // accept what is more there than not
        if (t <= q.ray.t_min || opacity.x + opacity.y + opacity.z < 1.5f) args->valid[0] = 0;
        return;
    }
    args->valid[0] = 0;
    if (is_between(q.ray, t) && (opacity.x > 0 || opacity.y > 0 || opacity.z > 0))
        q.out->push_back({t, t, Vec3d(1.0) - Vec3d(opacity)});
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

// Makes t the nearest hit of Embree's ray so far.
void accept(const RTCIntersectFunctionNArguments* args, double t, const Vec3d& normal) {
    auto* rayhit = reinterpret_cast<RTCRayHit*>(args->rayhit);
    rayhit->ray.tfar = static_cast<float>(t);
    rayhit->hit.Ng_x = static_cast<float>(normal.x);
    rayhit->hit.Ng_y = static_cast<float>(normal.y);
    rayhit->hit.Ng_z = static_cast<float>(normal.z);
    rayhit->hit.geomID = args->geomID;
    rayhit->hit.primID = args->primID;
}

void sphere_intersect(const RTCIntersectFunctionNArguments* args) {
    if (!args->valid[0]) return;
    const scene::Object& object = *static_cast<const Traced*>(args->geometryUserPtr)->object;
    auto& q = *static_cast<Query*>(args->context);
    const SphereList list = spheres_of(object);
    const Vec3d centre((*list.centres)[args->primID]), origin = origin_beside(object, q.ray);
    double front, back;
    if (!sphere_stretch(origin, q.ray.direction, centre, (*list.radii)[args->primID], front, back)) return;
    const auto* particles = std::get_if<scene::Particles>(&object.shape);
    if (q.nearest) {
        const double t = front > q.ray.t_min ? front : back;
        const double farthest = reinterpret_cast<const RTCRayHit*>(args->rayhit)->ray.tfar;
        if (particles || object.opacity.x < 0.5f || t <= q.ray.t_min || t + q.back_off >= farthest) return;
        accept(args, t + q.back_off, origin + q.ray.direction * t - centre);
    } else if (particles) {
        front = std::max(front, q.ray.t_min);
        back = std::min(back, q.ray.t_max);
        const double length = (back - front) * q.ray.direction.length();
        if (back > front)
            q.out->push_back({front, back, transmitted(object.extinction, length * particles->density[args->primID])});
    } else {
        for (const double t : {front, back})
            if (is_between(q.ray, t)) q.out->push_back({t, t, Vec3d(1.0) - Vec3d(object.opacity)});
    }
}

void set_vertices(RTCGeometry g, const scene::Object& object, const scene::Mesh& mesh, unsigned step) {
    auto* points = static_cast<Vec3f*>(
        rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, step, RTC_FORMAT_FLOAT3, 12, mesh.positions.size()));
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        points[i] = mesh.positions[i] + object.motion * static_cast<float>(step);
}

void set_vertices(RTCGeometry g, const scene::Object& object, const scene::Hair& hair, unsigned step) {
    auto* points = static_cast<float*>(
        rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, step, RTC_FORMAT_FLOAT4, 16, hair.points.size()));
    for (std::size_t i = 0; i < hair.points.size(); ++i) {
        const Vec3f p = hair.points[i] + object.motion * static_cast<float>(step);
        for (int a = 0; a < 3; ++a) points[4 * i + a] = p[a];
        points[4 * i + 3] = hair.radii[i];
    }
}

// Embree passes over ribbons that a ray meets within twice their half-width of its start, so that rays from hair do not
// hit it. Here they count: the ray starts further back, and what lies before t_min is dropped when it is found.
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
    // A little further than asked, since exact depths are recomputed from what is found.
    rayhit.ray.tfar = static_cast<float>(std::min(ray.t_max * 1.0001 + q.back_off, 3e38));
    rayhit.ray.mask = ~0u;
    rayhit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene, &q, &rayhit);
    return rayhit;
}

Query make_query(const TracedRay& ray, std::vector<TracedSegment>* out) {
    Query q;
    rtcInitIntersectContext(&q);
    q.ray = ray;
    q.nearest = !out;
    q.out = out;
    return q;
}

// 0 for what is not hair.
Vec3d strand_direction(const Traced& traced, unsigned primitive) {
    const auto* hair = std::get_if<scene::Hair>(&traced.object->shape);
    if (!hair) return Vec3d(0.0);
    const std::uint32_t first = traced.segments.first[primitive];
    return (Vec3d(hair->points[first + 1]) - Vec3d(hair->points[first])).normalized();
}

}  // namespace

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
        for (unsigned step = 0; step < steps; ++step) set_vertices(g, object, *hair, step);
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
    Query q = make_query(ray, &out);
    trace(scene, widest_hair, q);
}

bool trace_nearest(RTCSceneTy* scene, double widest_hair, const TracedRay& ray, SurfaceHit& out) {
    Query q = make_query(ray, nullptr);
    const RTCRayHit found = trace(scene, widest_hair, q);
    if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    out.t = found.ray.tfar - q.back_off;
    out.normal = Vec3d(found.hit.Ng_x, found.hit.Ng_y, found.hit.Ng_z);
    const void* traced = rtcGetGeometryUserData(rtcGetGeometry(scene, found.hit.geomID));
    out.tangent = strand_direction(*static_cast<const Traced*>(traced), found.hit.primID);
    return true;
}

Vec3d transmitted(const Vec3f& extinction, double optical_depth) {
    Vec3d t;
    t[0] = std::exp(-optical_depth * extinction[0]);
    for (int c = 1; c < 3; ++c) t[c] = extinction[c] == extinction[0] ? t[0] : std::exp(-optical_depth * extinction[c]);
    return t;
}

}  // namespace shadowbench::rays
