#include "rays/tracer.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "base/error.h"
#include "base/parallel.h"
#include "rays/grid_media.h"
#include "rays/surfaces.h"
#include "rays/traced_geometry.h"
#include "scene/scene.h"

namespace shadowbench::rays {

using base::Vec3d;
using base::Vec3f;

namespace {

void sort(std::vector<TracedSegment>& segments) {
    std::sort(segments.begin(), segments.end(), [](const TracedSegment& a, const TracedSegment& b) {
        return a.front != b.front ? a.front < b.front : a.back < b.back;
    });
}

}  // namespace

struct Tracer::State {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    std::vector<std::unique_ptr<Traced>> geometries;
    GridMedia media;
    double widest_hair = 0.0;
    bool translucent = false;  // some surface transmits a part of the light
    bool has_media = false;

    explicit State(GridMedia grids) : media(std::move(grids)) {}
    ~State() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }

    void add(const scene::Object& object, const ViewedHair* viewed) {
        const bool grid = std::holds_alternative<scene::GridVolume>(object.shape);
        const bool medium = grid || std::holds_alternative<scene::Particles>(object.shape);
        has_media = has_media || medium;
        if (grid) return;
        const auto* mesh = std::get_if<scene::Mesh>(&object.shape);
        translucent =
            translucent ||
            (!medium && ((mesh && mesh->alpha) || !(is_opaque(object.opacity) || is_nothing(object.opacity))));
        geometries.push_back(std::make_unique<Traced>(Traced{&object, {}, {}}));
        if (const auto* hair = std::get_if<scene::Hair>(&object.shape)) {
            std::vector<float>& wider = geometries.back()->widened;
            if (viewed) wider = widened(*hair, *viewed);
            translucent = translucent || (!wider.empty() && !is_nothing(object.opacity));
            for (const float radius : wider.empty() ? hair->radii : wider)
                widest_hair = std::max<double>(widest_hair, radius);
        }
        RTCGeometry geometry = make_geometry(device, *geometries.back());
        rtcAttachGeometry(scene, geometry);
        rtcReleaseGeometry(geometry);
    }

    void march(const TracedRay& ray, Grids grids, std::vector<TracedSegment>& out) const {
        const auto cut = grids == Grids::cells ? &VolumeMarcher::march_cells : &VolumeMarcher::march;
        std::vector<MediumSegment> segments;
        for (const GridMedia::Volume& volume : media.volumes()) {
            segments.clear();
            (volume.marcher.*cut)(origin_beside(*volume.object, ray), ray.direction, ray.direction.length(), ray.t_min,
                                  ray.t_max, segments);
            for (const MediumSegment& s : segments)
                if (const Vec3d t = transmitted(volume.object->extinction, s.depth); t != Vec3d(1.0))
                    out.push_back({s.front, s.back, t});
        }
    }
};

Tracer::Tracer(const scene::Scene& scene, bool casters_only) : Tracer(scene, casters_only, nullptr) {}

Tracer::Tracer(const scene::Scene& scene, bool casters_only, const ViewedHair& viewed)
    : Tracer(scene, casters_only, &viewed) {}

Tracer::Tracer(const scene::Scene& scene, bool casters_only, const ViewedHair* viewed)
    : state_(std::make_unique<State>(GridMedia(scene, casters_only))) {
    state_->device = rtcNewDevice(fmt::format("threads={}", base::library_threads()).c_str());
    if (!state_->device) throw base::Error(base::ErrorCode::internal, "", "Embree could not start");
    state_->scene = rtcNewScene(state_->device);
    rtcSetSceneFlags(state_->scene, RTC_SCENE_FLAG_ROBUST);
    for (const scene::Object& object : scene.objects)
        if (object.casts_shadow || !casters_only) state_->add(object, viewed);
    rtcCommitScene(state_->scene);
    if (const RTCError error = rtcGetDeviceError(state_->device); error != RTC_ERROR_NONE)
        throw base::Error(base::ErrorCode::internal, "",
                          error == RTC_ERROR_OUT_OF_MEMORY ? "out of memory while building the ray tracing hierarchy"
                                                           : "Embree could not build its hierarchy");
}

Tracer::~Tracer() = default;

void Tracer::all_segments(const Vec3d& origin, const Vec3d& direction, double t_min, double t_max,
                          std::vector<TracedSegment>& out, double time, Grids grids) const {
    out.clear();
    const TracedRay ray{origin, direction, time, t_min, t_max};
    trace_all(state_->scene, state_->widest_hair, ray, out);
    if (!state_->media.empty()) state_->march(ray, grids, out);
    sort(out);
}

bool Tracer::surfaces(const Vec3d& origin, const Vec3d& direction, std::vector<SurfaceHit>& out, double time) const {
    out.clear();
    TracedRay ray{origin, direction, time, 0.0, std::numeric_limits<double>::infinity()};
    thread_local std::vector<Crossing> crossings;
    crossings.clear();
    Crossing opaque;
    const bool ends = trace_opaque(state_->scene, state_->widest_hair, ray, opaque);
    if (ends) ray.t_max = opaque.depth;
    if (state_->translucent) trace_translucent(state_->scene, state_->widest_hair, ray, crossings);
    if (ends) crossings.push_back(opaque);
    order_crossings(ray, crossings);
    return take_surfaces(ray, crossings, out);
}

bool Tracer::has_media() const {
    return state_->has_media;
}

Vec3d Tracer::transmittance(const LightView& view, double x, double y, double z, std::vector<TracedSegment>& scratch,
                            double time) const {
    const LightLine line = light_line(view, x, y);
    const TracedRay ray{line.origin, line.direction, time, std::max(line.z_start, 0.0), z};
    scratch.clear();
    trace_all(state_->scene, state_->widest_hair, ray, scratch);
    sort(scratch);  // the product is rounded in one order, whatever Embree's
    Vec3d result(1, 1, 1);
    for (const TracedSegment& s : scratch)
        if (s.front < z) result *= s.transmittance;
    if (state_->media.empty()) return result;
    Vec3d depth;
    state_->media.optical_depths(view, x, y, time, {&z, 1}, {&depth, 1});
    for (int c = 0; c < 3; ++c) result[c] *= std::exp(-depth[c]);
    return result;
}

}  // namespace shadowbench::rays
