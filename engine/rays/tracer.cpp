#include "rays/tracer.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <limits>
#include <variant>

#include <fmt/format.h>

#include "base/error.h"
#include "base/parallel.h"
#include "rays/march.h"
#include "rays/surfaces.h"
#include "rays/traced_geometry.h"
#include "scene/scene.h"

namespace shadowbench::rays {

using base::Vec3d;
using base::Vec3f;

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
    bool translucent = false;  // some surface lets a part of the light through
    bool media = false;

    ~State() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }

    void add(const scene::Object& object) {
        const auto* grid = std::get_if<scene::GridVolume>(&object.shape);
        const bool medium = grid || std::holds_alternative<scene::Particles>(object.shape);
        media = media || medium;
        if (grid) {
            volumes.push_back({&object, VolumeMarcher(*grid)});
            return;
        }
        const auto* mesh = std::get_if<scene::Mesh>(&object.shape);
        translucent =
            translucent ||
            (!medium && ((mesh && mesh->alpha) || !(is_opaque(object.opacity) || is_nothing(object.opacity))));
        if (const auto* hair = std::get_if<scene::Hair>(&object.shape))
            for (const float radius : hair->radii) widest_hair = std::max<double>(widest_hair, radius);
        geometries.push_back(std::make_unique<Traced>(Traced{&object, {}}));
        RTCGeometry geometry = make_geometry(device, *geometries.back());
        rtcAttachGeometry(scene, geometry);
        rtcReleaseGeometry(geometry);
    }

    void march(const TracedRay& ray, std::vector<TracedSegment>& out) const {
        std::vector<MediumSegment> steps;
        for (const Volume& volume : volumes) {
            steps.clear();
            volume.marcher.march(origin_beside(*volume.object, ray), ray.direction, ray.direction.length(), ray.t_min,
                                 ray.t_max, steps);
            for (const MediumSegment& s : steps)
                if (const Vec3d t = transmitted(volume.object->extinction, s.depth); t != Vec3d(1.0))
                    out.push_back({s.front, s.back, t});
        }
    }
};

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
                          std::vector<TracedSegment>& out, double time) const {
    out.clear();
    const TracedRay ray{origin, direction, time, t_min, t_max};
    trace_all(state_->scene, state_->widest_hair, ray, out);
    if (!state_->volumes.empty()) state_->march(ray, out);
    std::sort(out.begin(), out.end(), [](const TracedSegment& a, const TracedSegment& b) {
        return a.front != b.front ? a.front < b.front : a.back < b.back;
    });
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
    return state_->media;
}

Vec3d Tracer::transmittance(const LightView& view, double x, double y, double z, std::vector<TracedSegment>& scratch,
                            double time) const {
    const double px = view.lower.x + x * view.pixel.x, py = view.lower.y + y * view.pixel.y;
    if (view.perspective)
        all_segments(view.origin, view.right * px + view.up * py + view.forward, view.z_near, z, scratch, time);
    else
        all_segments(view.origin + view.right * px + view.up * py, view.forward, 0.0, z, scratch, time);
    Vec3d result(1, 1, 1);
    for (const TracedSegment& s : scratch)
        if (s.front < z) result *= s.transmittance;
    return result;
}

}  // namespace shadowbench::rays
