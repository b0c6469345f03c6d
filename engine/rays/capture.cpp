#include "rays/capture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "rays/hits.h"
#include "rays/march.h"
#include "rays/prepared.h"
#include "rays/project.h"
#include "scene/scene.h"

namespace shadowbench::rays {
namespace {

using base::Vec3d;
using base::Vec3f;

// Origin and direction of a ray such that its parameter is planar depth: view space, and world space.
struct RayLine {
    Vec3d origin, direction;
    double scale;  // world length per unit of depth
};
RayLine view_line(const LightView& view, double x, double y) {
    if (view.perspective) return {{0, 0, 0}, {x, y, 1}, std::sqrt(1.0 + x * x + y * y)};
    return {{x, y, 0}, {0, 0, 1}, 1.0};
}
RayLine world_line(const LightView& view, double x, double y) {
    const RayLine line = view_line(view, x, y);
    return {to_world(view, line.origin), view.right * line.direction.x + view.up * line.direction.y + view.forward,
            line.scale};
}

template <bool perspective, class Sink>
class TileProjection {
public:
    TileProjection(const LightView& view, const TileGrid& grid, const LightRays& rays,
                   std::span<const unsigned char> wanted, Sink& sink)
        : view_(view), grid_(grid), tile_(rays.tile), samples_(rays.samples), wanted_(wanted), sink_(sink) {}

    void project(const Prepared& p) {
        std::visit([&](const auto& shape) { project(p, shape); }, p.object->shape);
    }

private:
    bool transmits_all(const float* t) const { return t[0] == 1.0f && t[1] == 1.0f && t[2] == 1.0f; }

    void project(const Prepared& p, const scene::Hair& hair) {
        if (transmits_all(p.transmittance)) return;
        for (const std::uint32_t i : p.bins.of(tile_))
            project_hair<perspective>(hair_segment(p, hair, i), grid_, view_.z_near, p.transmittance, sink_);
    }

    void project(const Prepared& p, const scene::Mesh& mesh) {
        if (transmits_all(p.transmittance)) return;
        const auto corner = [&](std::uint32_t triangle, int i) -> const Vec3f& {
            return p.points[mesh.triangles[triangle][i]];
        };
        for (const std::uint32_t i : p.bins.of(tile_)) {
            PlaneBox box;
            add_triangle(view_, corner(i, 0), corner(i, 1), corner(i, 2), box);
            if (box.empty()) continue;
            float textured[3];
            const auto shade = [&](const double weight[3]) -> const float* {
                if (!mesh.alpha) return p.transmittance;
                const base::Vec2f* uv = &mesh.corner_uv[3 * static_cast<std::size_t>(i)];
                const base::Vec2f at = uv[0] * static_cast<float>(weight[0]) + uv[1] * static_cast<float>(weight[1]) +
                                       uv[2] * static_cast<float>(weight[2]);
                const float alpha = scene::sample(*mesh.alpha, at.x, at.y);
                if (alpha <= 0.0f) return nullptr;
                for (int c = 0; c < 3; ++c) textured[c] = 1.0f - alpha * p.object->opacity[c];
                return textured;
            };
            const TriangleSetup setup = set_up_triangle<perspective>(corner(i, 0), corner(i, 1), corner(i, 2));
            project_triangle(setup, box.x_low, box.x_high, box.y_low, box.y_high, grid_, view_.z_near, shade, sink_);
        }
    }

    template <class Visit>
    void visit_sphere(const Vec3f& centre, double radius, const Visit& visit) {
        PlaneBox box;
        add_sphere(view_, centre, radius, box);
        if (box.empty()) return;
        visit_samples(box.x_low, box.x_high, box.y_low, box.y_high, grid_, [&](std::uint32_t ray, double x, double y) {
            const RayLine line = view_line(view_, x, y);
            double front, back;
            if (sphere_stretch(line.origin, line.direction, Vec3d(centre), radius, front, back) && back > view_.z_near)
                visit(ray, front, back, line.scale);
        });
    }

    void project(const Prepared& p, const scene::Spheres& spheres) {
        if (transmits_all(p.transmittance)) return;
        for (const std::uint32_t i : p.bins.of(tile_))
            visit_sphere(p.points[i], spheres.radii[i], [&](std::uint32_t ray, double front, double back, double) {
                if (front > view_.z_near) sink_.surface(ray, front, p.transmittance);
                sink_.surface(ray, back, p.transmittance);
            });
    }

    void medium(std::uint32_t ray, float front, float back, double depth, const Vec3f& extinction) {
        float t[3];
        t[0] = static_cast<float>(std::exp(-depth * extinction[0]));
        for (int c = 1; c < 3; ++c)
            t[c] = extinction[c] == extinction[0] ? t[0] : static_cast<float>(std::exp(-depth * extinction[c]));
        if (!transmits_all(t)) sink_.medium(ray, front, back, t);
    }

    void project(const Prepared& p, const scene::Particles& particles) {
        if constexpr (std::is_same_v<Sink, SegmentHits>) {
            for (const std::uint32_t i : p.bins.of(tile_))
                visit_sphere(
                    p.points[i], particles.radii[i], [&](std::uint32_t ray, double front, double back, double scale) {
                        front = std::max(front, view_.z_near);
                        const float f = static_cast<float>(front), b = static_cast<float>(back);
                        if (b > f)
                            medium(ray, f, b, (back - front) * scale * particles.density[i], p.object->extinction);
                    });
        }
    }

    void project(const Prepared& p, const scene::GridVolume&) {
        if constexpr (std::is_same_v<Sink, SegmentHits>) {
            std::vector<MediumSegment> steps;
            for (int j = 0; j < grid_.ny; ++j)
                for (int i = 0; i < grid_.nx; ++i) {
                    const std::size_t sample = static_cast<std::size_t>(j) * grid_.nx + i;
                    if (!wanted_.empty() && !wanted_[(grid_.ray_row[j] + grid_.ray_column[i]) / samples_]) continue;
                    const RayLine line = world_line(view_, grid_.x[sample], grid_.y[sample]);
                    steps.clear();
                    p.marcher->march(line.origin, line.direction, line.scale, std::max(view_.z_near, -1e30), 1e30,
                                     steps);
                    for (const MediumSegment& s : steps)
                        medium(grid_.ray_row[j] + grid_.ray_column[i], s.front, s.back, s.depth, p.object->extinction);
                }
        }
    }

    const LightView& view_;
    const TileGrid& grid_;
    const int tile_;
    const int samples_;  // rays a pixel
    const std::span<const unsigned char> wanted_;
    Sink& sink_;
};

// Rows of a deep image are the map's rows: one ray a pixel.
void copy_deep_image(const scene::DeepImage& image, LightRays& rays) {
    rays.begin.assign(1, 0);
    for (int y = rays.y0; y < rays.y0 + rays.height; ++y)
        for (int x = rays.x0; x < rays.x0 + rays.width; ++x) {
            const std::size_t pixel = static_cast<std::size_t>(y) * image.width + x;
            for (std::size_t s = image.begin[pixel]; s < image.begin[pixel + 1]; ++s) {
                if (image.transmittance[s] == 1.0f) continue;
                rays.z_front.push_back(image.z_front[s]);
                rays.z_back.push_back(image.z_back[s]);
                rays.transmittance.push_back(image.transmittance[s]);
            }
            rays.begin.push_back(static_cast<std::uint32_t>(rays.z_front.size()));
        }
    if (rays.z_back == rays.z_front) rays.z_back.clear();
}

float outward(double z, float direction) {
    return std::nextafter(static_cast<float>(z), direction);
}

}  // namespace

MapLayout make_layout(const scene::Scene& scene, const LightView& view, const scene::RaySettings& settings) {
    MapLayout layout;
    layout.width = view.resolution.x;
    layout.height = view.resolution.y;
    layout.jittered = settings.pattern == scene::Pattern::jittered;
    layout.seed = settings.seed;
    constexpr float infinity = std::numeric_limits<float>::infinity();
    layout.z_min = outward(view.z_min, -infinity);
    layout.z_max = outward(view.z_max, infinity);
    if (scene.deep_image) {
        layout.jittered = false;
        for (std::size_t s = 0; s < scene.deep_image->z_front.size() && !layout.media; ++s)
            layout.media = scene.deep_image->z_back[s] > scene.deep_image->z_front[s];
    } else {
        layout.channels = scene::channels(scene);
        layout.media = scene::has_media(scene);
        layout.moving = scene::has_motion(scene);
        set_samples(layout, settings.samples_per_pixel);
    }
    int size = 64;
    while (size > 1 && size * size * layout.samples() > 16384) size /= 2;
    layout.tile_width = std::min(size, layout.width);
    layout.tile_height = std::min(size, layout.height);
    return layout;
}

struct Capture::State {
    const scene::Scene& scene;
    const LightView view;
    const MapLayout layout;
    std::vector<Prepared> objects;

    template <class Sink>
    void project(LightRays& rays, std::span<const unsigned char> wanted) const {
        const TileGrid grid = make_tile_grid(view, layout, rays);
        thread_local Sink sink;  // its memory serves tile after tile
        sink.hits.clear();
        if (view.perspective) {
            TileProjection<true, Sink> projection(view, grid, rays, wanted, sink);
            for (const Prepared& p : objects) projection.project(p);
        } else {
            TileProjection<false, Sink> projection(view, grid, rays, wanted, sink);
            for (const Prepared& p : objects) projection.project(p);
        }
        sort_hits(sink, static_cast<std::size_t>(grid.nx) * grid.ny, rays);
    }
};

Capture::Capture(const scene::Scene& scene, const LightView& view, const MapLayout& layout)
    : state_(std::make_unique<State>(State{scene, view, layout, {}})) {
    for (const scene::Object& object : scene.objects)
        if (object.casts_shadow) state_->objects.push_back(prepare(object, view, layout));
}

Capture::~Capture() = default;

LightRays Capture::tile(int index, std::span<const unsigned char> wanted, int apron) const {
    const MapLayout& layout = state_->layout;
    LightRays rays;
    rays.tile = index;
    const TileCore core = core_of(layout, index);
    rays.x0 = std::max(core.x0 - apron, 0);
    rays.y0 = std::max(core.y0 - apron, 0);
    rays.width = std::min(core.x0 + core.width + apron, layout.width) - rays.x0;
    rays.height = std::min(core.y0 + core.height + apron, layout.height) - rays.y0;
    rays.samples = layout.samples();
    rays.channels = layout.channels;
    if (state_->scene.deep_image)
        copy_deep_image(*state_->scene.deep_image, rays);
    else if (layout.media || layout.channels > 1)
        state_->project<SegmentHits>(rays, wanted);
    else
        state_->project<SurfaceHits>(rays, wanted);
    return rays;
}

std::size_t Capture::bytes() const {
    std::size_t sum = 0;
    for (const Prepared& p : state_->objects) sum += p.bytes();
    return sum;
}

}  // namespace shadowbench::rays
