#include "rays/tracer.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include <fmt/format.h>

#include "base/error.h"
#include "base/parallel.h"
#include "rays/march.h"
#include "rays/primitives.h"
#include "scene/scene.h"

namespace shadowbench::rays {
namespace {

using base::Vec3d;
using base::Vec3f;

// One Embree geometry, and what its primitives mean.
struct Traced {
    const scene::Object* object;
    scene::HairSegments segments;  // hair
};

// Embree hands this back in its callbacks: what one query collects.
struct Query : RTCIntersectContext {
    Vec3d origin, direction;
    double t_min, t_max;
    double back_off;  // t from where Embree's ray starts to `origin`
    bool nearest;     // only the nearest surface; media are passed through
    std::vector<TracedSegment>* out;
};

double length_of(const Query& q) {
    return q.direction.length();
}

// Perpendicular distance test at a joint, and the depth of a strand's axis: the ray's closest approach, in double.
bool hair_crossing(const Traced& traced, const scene::Hair& hair, unsigned segment, const Query& q, double& t) {
    const std::uint32_t first = traced.segments.first[segment];
    const double length2 = q.direction.dot(q.direction);
    const auto across = [&](const Vec3f& point, double& along) {
        const Vec3d p = Vec3d(point) - q.origin;
        along = p.dot(q.direction) / length2;
        return p - q.direction * along;
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

// Called by Embree for every crossing of a triangle or a ribbon: keeps it and lets the ray go on.
void collect(const RTCFilterFunctionNArguments* args) {
    const auto& traced = *static_cast<const Traced*>(args->geometryUserPtr);
    auto& q = *static_cast<Query*>(args->context);
    const auto* hit = reinterpret_cast<const RTCHit*>(args->hit);
    const auto* ray = reinterpret_cast<const RTCRay*>(args->ray);
    double t = ray->tfar - q.back_off;
    Vec3f opacity = traced.object->opacity;
    if (const auto* hair = std::get_if<scene::Hair>(&traced.object->shape)) {
        if (!q.nearest && !hair_crossing(traced, *hair, hit->primID, q, t)) {
            args->valid[0] = 0;
            return;
        }
    } else if (const auto* mesh = std::get_if<scene::Mesh>(&traced.object->shape)) {
        opacity = opacity_at(*traced.object, *mesh, hit->primID, hit->u, hit->v);
        const base::Vec3i& index = mesh->triangles[hit->primID];
        const Vec3d p0(mesh->positions[index.x]);
        const Vec3d normal = (Vec3d(mesh->positions[index.y]) - p0).cross(Vec3d(mesh->positions[index.z]) - p0);
        if (const double facing = normal.dot(q.direction); facing != 0.0) t = normal.dot(p0 - q.origin) / facing;
    }
    if (q.nearest) {  // accept what is more there than not
        if (t <= q.t_min || opacity.x + opacity.y + opacity.z < 1.5f) args->valid[0] = 0;
        return;
    }
    args->valid[0] = 0;
    if (t > q.t_min && t <= q.t_max && (opacity.x > 0 || opacity.y > 0 || opacity.z > 0))
        q.out->push_back({t, t, Vec3f(1, 1, 1) - opacity});
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
    const SphereList list = spheres_of(*static_cast<const Traced*>(args->geometryUserPtr)->object);
    const Vec3f c = (*list.centres)[args->primID];
    const float r = (*list.radii)[args->primID] * 1.00001f;
    *args->bounds_o = {c.x - r, c.y - r, c.z - r, 0, c.x + r, c.y + r, c.z + r, 0};
}

Vec3f transmitted(const Vec3f& extinction, double optical_depth) {
    Vec3f t;
    t[0] = static_cast<float>(std::exp(-optical_depth * extinction[0]));
    for (int c = 1; c < 3; ++c)
        t[c] = extinction[c] == extinction[0] ? t[0] : static_cast<float>(std::exp(-optical_depth * extinction[c]));
    return t;
}

void sphere_intersect(const RTCIntersectFunctionNArguments* args) {
    if (!args->valid[0]) return;
    const auto& traced = *static_cast<const Traced*>(args->geometryUserPtr);
    auto& q = *static_cast<Query*>(args->context);
    const SphereList list = spheres_of(*traced.object);
    const Vec3d centre((*list.centres)[args->primID]);
    double front, back;
    if (!sphere_stretch(q.origin, q.direction, centre, (*list.radii)[args->primID], front, back)) return;
    const auto* particles = std::get_if<scene::Particles>(&traced.object->shape);
    if (q.nearest) {
        const double t = front > q.t_min ? front : back;
        auto* rayhit = reinterpret_cast<RTCRayHit*>(args->rayhit);
        if (particles || traced.object->opacity.x < 0.5f || t <= q.t_min || t + q.back_off >= rayhit->ray.tfar) return;
        const Vec3d normal = q.origin + q.direction * t - centre;
        rayhit->ray.tfar = static_cast<float>(t + q.back_off);
        rayhit->hit.Ng_x = static_cast<float>(normal.x);
        rayhit->hit.Ng_y = static_cast<float>(normal.y);
        rayhit->hit.Ng_z = static_cast<float>(normal.z);
        rayhit->hit.geomID = args->geomID;
        rayhit->hit.primID = args->primID;
        return;
    }
    if (particles) {
        front = std::max(front, q.t_min);
        back = std::min(back, q.t_max);
        if (back > front)
            q.out->push_back({front, back,
                              transmitted(traced.object->extinction,
                                          (back - front) * length_of(q) * particles->density[args->primID])});
        return;
    }
    for (const double t : {front, back})
        if (t > q.t_min && t <= q.t_max) q.out->push_back({t, t, Vec3f(1, 1, 1) - traced.object->opacity});
}

}  // namespace

struct Tracer::State {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    std::vector<std::unique_ptr<Traced>> geometries;
    struct Volume {
        const scene::Object* object;
        VolumeMarcher marcher;
    };
    std::vector<Volume> volumes;
    double widest_hair = 0.0;

    ~State() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }

    void add(const scene::Object& object);
    void attach(RTCGeometry geometry, std::unique_ptr<Traced> traced) {
        rtcSetGeometryUserData(geometry, traced.get());
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene, geometry);
        rtcReleaseGeometry(geometry);
        geometries.push_back(std::move(traced));
    }
};

void Tracer::State::add(const scene::Object& object) {
    auto traced = std::make_unique<Traced>(Traced{&object, {}});
    if (const auto* mesh = std::get_if<scene::Mesh>(&object.shape)) {
        RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        void* points =
            rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, mesh->positions.size());
        std::copy(mesh->positions.begin(), mesh->positions.end(), static_cast<Vec3f*>(points));
        void* index =
            rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, mesh->triangles.size());
        std::copy(mesh->triangles.begin(), mesh->triangles.end(), static_cast<base::Vec3i*>(index));
        rtcSetGeometryIntersectFilterFunction(g, collect);
        attach(g, std::move(traced));
    } else if (const auto* hair = std::get_if<scene::Hair>(&object.shape)) {
        traced->segments = segments(*hair);
        for (const float radius : hair->radii) widest_hair = std::max<double>(widest_hair, radius);
        RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_FLAT_LINEAR_CURVE);
        auto* points = static_cast<float*>(
            rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 16, hair->points.size()));
        for (std::size_t i = 0; i < hair->points.size(); ++i) {
            for (int a = 0; a < 3; ++a) points[4 * i + a] = hair->points[i][a];
            points[4 * i + 3] = hair->radii[i];
        }
        void* index =
            rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT, 4, traced->segments.first.size());
        std::copy(traced->segments.first.begin(), traced->segments.first.end(), static_cast<std::uint32_t*>(index));
        rtcSetGeometryIntersectFilterFunction(g, collect);
        attach(g, std::move(traced));
    } else if (const auto* grid = std::get_if<scene::GridVolume>(&object.shape)) {
        volumes.push_back({&object, VolumeMarcher(*grid)});
    } else {
        RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
        rtcSetGeometryUserPrimitiveCount(g, static_cast<unsigned>(spheres_of(object).centres->size()));
        rtcSetGeometryBoundsFunction(g, sphere_bounds, nullptr);
        rtcSetGeometryIntersectFunction(g, sphere_intersect);
        attach(g, std::move(traced));
    }
}

namespace {

// Embree passes over ribbons that a ray meets within twice their half-width of its start, so that rays from hair do not
// hit it. Here they count: the ray starts further back, and what lies before t_min is dropped when it is found.
RTCRayHit trace(RTCScene scene, double widest_hair, Query& q) {
    q.back_off = 4.0 * widest_hair / q.direction.length();
    const Vec3d start = q.origin - q.direction * q.back_off;
    RTCRayHit rayhit{};
    rayhit.ray.org_x = static_cast<float>(start.x);
    rayhit.ray.org_y = static_cast<float>(start.y);
    rayhit.ray.org_z = static_cast<float>(start.z);
    rayhit.ray.dir_x = static_cast<float>(q.direction.x);
    rayhit.ray.dir_y = static_cast<float>(q.direction.y);
    rayhit.ray.dir_z = static_cast<float>(q.direction.z);
    rayhit.ray.tnear = widest_hair > 0.0 ? 0.0f : static_cast<float>(std::max(q.t_min, 0.0));
    // A little further than asked, since exact depths are recomputed from what is found.
    rayhit.ray.tfar = static_cast<float>(std::min(q.t_max * 1.0001 + q.back_off, 3e38));
    rayhit.ray.mask = ~0u;
    rayhit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene, &q, &rayhit);
    return rayhit;
}

// 0 for what is not hair.
Vec3d strand_direction(const Traced& traced, unsigned primitive) {
    const auto* hair = std::get_if<scene::Hair>(&traced.object->shape);
    if (!hair) return Vec3d(0.0);
    const std::uint32_t first = traced.segments.first[primitive];
    return (Vec3d(hair->points[first + 1]) - Vec3d(hair->points[first])).normalized();
}

}  // namespace

Tracer::Tracer(const scene::Scene& scene, bool casters_only) : state_(std::make_unique<State>()) {
    state_->device = rtcNewDevice(fmt::format("threads={}", base::library_threads()).c_str());
    if (!state_->device) throw base::Error(base::ErrorCode::internal, "", "Embree could not start");
    state_->scene = rtcNewScene(state_->device);
    rtcSetSceneFlags(state_->scene, RTC_SCENE_FLAG_ROBUST);
    for (const scene::Object& object : scene.objects)
        if (object.casts_shadow || !casters_only) state_->add(object);
    rtcCommitScene(state_->scene);
    if (const RTCError error = rtcGetDeviceError(state_->device); error != RTC_ERROR_NONE)
        throw base::Error(base::ErrorCode::internal, "",
                          error == RTC_ERROR_OUT_OF_MEMORY ? "out of memory while building the ray tracing hierarchy"
                                                           : "Embree could not build its hierarchy");
}

Tracer::~Tracer() = default;

void Tracer::all_segments(const Vec3d& origin, const Vec3d& direction, double t_min, double t_max,
                          std::vector<TracedSegment>& out) const {
    out.clear();
    Query q;
    rtcInitIntersectContext(&q);
    q.origin = origin;
    q.direction = direction;
    q.t_min = t_min;
    q.t_max = t_max;
    q.nearest = false;
    q.out = &out;
    trace(state_->scene, state_->widest_hair, q);
    if (!state_->volumes.empty()) {
        std::vector<MediumSegment> steps;
        for (const State::Volume& volume : state_->volumes) {
            steps.clear();
            volume.marcher.march(origin, direction, direction.length(), t_min, t_max, steps);
            for (const MediumSegment& s : steps)
                if (const Vec3f t = transmitted(volume.object->extinction, s.depth); t != Vec3f(1, 1, 1))
                    out.push_back({s.front, s.back, t});
        }
    }
    std::sort(out.begin(), out.end(), [](const TracedSegment& a, const TracedSegment& b) {
        return a.front != b.front ? a.front < b.front : a.back < b.back;
    });
}

bool Tracer::nearest(const Vec3d& origin, const Vec3d& direction, SurfaceHit& out) const {
    Query q;
    rtcInitIntersectContext(&q);
    q.origin = origin;
    q.direction = direction;
    q.t_min = 0.0;
    q.t_max = std::numeric_limits<double>::infinity();
    q.nearest = true;
    q.out = nullptr;
    const RTCRayHit found = trace(state_->scene, state_->widest_hair, q);
    if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    out.t = found.ray.tfar - q.back_off;
    out.position = origin + direction * out.t;
    out.normal = Vec3d(found.hit.Ng_x, found.hit.Ng_y, found.hit.Ng_z);
    out.tangent = strand_direction(*state_->geometries[found.hit.geomID], found.hit.primID);
    if (out.tangent != Vec3d(0.0)) out.normal = out.tangent * out.tangent.dot(direction) - direction;
    if (out.normal.dot(direction) > 0.0) out.normal = -out.normal;
    const double length = out.normal.length();
    out.normal = length > 0.0 ? out.normal / length : -direction.normalized();
    return true;
}

Vec3d Tracer::transmittance(const LightView& view, double x, double y, double z,
                            std::vector<TracedSegment>& scratch) const {
    const double px = view.lower.x + x * view.pixel.x, py = view.lower.y + y * view.pixel.y;
    if (view.perspective)
        all_segments(view.origin, view.right * px + view.up * py + view.forward, view.z_near, z, scratch);
    else
        all_segments(view.origin + view.right * px + view.up * py, view.forward, 0.0, z, scratch);
    Vec3d result(1, 1, 1);
    for (const TracedSegment& s : scratch)
        if (s.front < z) result *= Vec3d(s.transmittance);
    return result;
}

}  // namespace shadowbench::rays
