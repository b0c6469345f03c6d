// Projects all objects of a scene into the rays of one tile, object by object and primitive by primitive, and collects
// each ray's crossings in the order in which they are found. Internal to capture.cpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "rays/hits.h"
#include "rays/march.h"
#include "rays/medium_floats.h"
#include "rays/moving.h"
#include "rays/prepared.h"
#include "rays/project.h"
#include "rays/project_hair.h"
#include "scene/scene.h"

namespace shadowbench::rays {

// Origin and direction of a ray in view space, scaled so that its parameter is planar depth.
struct ViewLine {
    Vec3d origin, direction;
    double scale;  // world length per unit of depth
};
inline ViewLine view_line(const LightView& view, double x, double y) {
    if (view.perspective) return {{0, 0, 0}, {x, y, 1}, std::sqrt(1.0 + x * x + y * y)};
    return {{x, y, 0}, {0, 0, 1}, 1.0};
}

// Slightly more than the largest scale of a tile's rays, which a ray at a corner has.
inline double longest_ray(const LightView& view, const TileGrid& grid) {
    double scale = 1.0;
    for (const double x : {grid.plane_x, grid.plane_x + grid.nx / grid.per_cell_x})
        for (const double y : {grid.plane_y, grid.plane_y + grid.ny / grid.per_cell_y})
            scale = std::max(scale, view_line(view, x, y).scale);
    return scale * 1.000001;
}

inline bool transmits_all(const float* t) {
    return t[0] == 1.0f && t[1] == 1.0f && t[2] == 1.0f;
}

// `Sink` is SurfaceHits or SegmentHits (hits.h).
template <bool perspective, class Sink>
class TileProjection {
public:
    TileProjection(const LightView& view, const MapLayout& layout, const TileGrid& grid, const LightRays& rays,
                   Sink& sink)
        : view_(view),
          cells_(layout.cells),
          grid_(grid),
          tile_(rays.tile),
          sink_(sink),
          longest_(longest_ray(view, grid)) {}

    void project(const std::vector<Prepared>& objects) {
        for (const Prepared& p : objects)
            std::visit(
                [&](const auto& shape) {
                    if (p.moving)
                        project<true>(p, shape);
                    else
                        project<false>(p, shape);
                },
                p.object->shape);
    }

private:
    template <bool moving>
    void project(const Prepared& p, const scene::Hair& hair) {
        if (transmits_all(p.transmittance)) return;
        if constexpr (moving) {
            for (const std::uint32_t i : p.bins.of(tile_)) {
                check_hits(sink_);
                const HairSegment s = hair_segment(p, hair, i);
                const auto place = [&](const Vec3d& offset) { return place_hair(view_, s, offset); };
                const double reach = std::max(s.radius_a, s.radius_b) * longest_;
                visit_moving(view_, grid_, p.motion, place, [&](const TimedRay& ray, const Vec3d& moved) {
                    const MovedRayMetric<perspective> metric(ray.x, ray.y, moved);
                    if (metric.misses(s, reach)) return;
                    const double z = hair_depth(s, metric) + moved.z;
                    if (z > view_.z_near) sink_.surface(ray.ray, z, p.transmittance);
                });
            }
        } else {
            HairProjection<perspective, Sink> projection(grid_, view_, p.transmittance, sink_);
            for (const std::uint32_t i : p.bins.of(tile_)) projection.project(hair_segment(p, hair, i));
            projection.finish();
        }
    }

    template <bool moving>
    void project(const Prepared& p, const scene::Mesh& mesh) {
        if (transmits_all(p.transmittance)) return;
        for (const std::uint32_t i : p.bins.of(tile_)) {
            check_hits(sink_);
            const base::Vec3i& corners = mesh.triangles[i];
            const base::Vec3f &a = p.points[corners.x], &b = p.points[corners.y], &c = p.points[corners.z];
            float textured[3];
            const auto shade = [&](const double weight[3]) {
                return mesh.alpha ? this->shade(p, mesh, i, weight, textured) : p.transmittance;
            };
            if constexpr (moving) {
                const auto place = [&](const Vec3d& offset) { return place_triangle(view_, a, b, c, offset); };
                const MovingTriangle triangle = set_up_moving_triangle<perspective>(a, b, c, p.motion);
                visit_moving(view_, grid_, p.motion, place, [&](const TimedRay& ray, const Vec3d&) {
                    double z, weight[3];
                    if (!cross_triangle(at_time(triangle, ray.time), ray.x, ray.y, z, weight) || !(z > view_.z_near))
                        return;
                    if (const float* transmittance = shade(weight)) sink_.surface(ray.ray, z, transmittance);
                });
            } else {
                PlaneBox box;
                add_triangle(view_, Vec3d(a), Vec3d(b), Vec3d(c), box);
                if (box.empty()) continue;
                project_triangle(set_up_triangle<perspective>(a, b, c), box.x_low, box.x_high, box.y_low, box.y_high,
                                 grid_, view_.z_near, shade, sink_);
            }
        }
    }

    // Writes the transmittances for these weights of the corners to `textured`; returns null where the texture has a
    // hole.
    const float* shade(const Prepared& p, const scene::Mesh& mesh, std::uint32_t triangle, const double weight[3],
                       float textured[3]) const {
        const base::Vec2f* uv = &mesh.corner_uv[3 * static_cast<std::size_t>(triangle)];
        const base::Vec2f at = uv[0] * static_cast<float>(weight[0]) + uv[1] * static_cast<float>(weight[1]) +
                               uv[2] * static_cast<float>(weight[2]);
        const float alpha = scene::sample(*mesh.alpha, at.x, at.y);
        if (alpha <= 0.0f) return nullptr;
        for (int c = 0; c < 3; ++c) textured[c] = 1.0f - alpha * p.object->opacity[c];
        return textured;
    }

    // Calls visit(ray, front, back, length per depth) if a ray passes through the sphere.
    template <bool moving, class Visit>
    void visit_sphere(const Prepared& p, std::uint32_t sphere, double radius, const Visit& visit) {
        const Vec3d centre(p.points[sphere]);
        const auto pass = [&](std::uint32_t ray, double x, double y, const Vec3d& at) {
            const ViewLine line = view_line(view_, x, y);
            double front, back;
            if (sphere_stretch(line.origin, line.direction, at, radius, front, back) && back > view_.z_near)
                visit(ray, front, back, line.scale);
        };
        if constexpr (moving) {
            const auto place = [&](const Vec3d& offset) {
                return place_sphere(view_, p.points[sphere], radius, offset);
            };
            visit_moving(view_, grid_, p.motion, place,
                         [&](const TimedRay& ray, const Vec3d& moved) { pass(ray.ray, ray.x, ray.y, centre + moved); });
        } else {
            PlaneBox box;
            add_sphere(view_, centre, radius, box);
            if (box.empty()) return;
            visit_samples(box, grid_, [&](std::uint32_t ray, double x, double y) { pass(ray, x, y, centre); });
        }
    }

    template <bool moving>
    void project(const Prepared& p, const scene::Spheres& spheres) {
        if (transmits_all(p.transmittance)) return;
        for (const std::uint32_t i : p.bins.of(tile_)) {
            check_hits(sink_);
            visit_sphere<moving>(p, i, spheres.radii[i], [&](std::uint32_t ray, double front, double back, double) {
                if (front > view_.z_near) sink_.surface(ray, front, p.transmittance);
                sink_.surface(ray, back, p.transmittance);
            });
        }
    }

    // Adds a segment of optical depth `depth` per unit of extinction. `rounding` carries the rounding error of its
    // transmittances to the segments behind it.
    void medium(std::uint32_t ray, float front, float back, double depth, const base::Vec3f& extinction,
                StepRounding& rounding) {
        const float most = std::max({extinction[0], extinction[1], extinction[2]});
        if (depth * most > darkest) {
            cut_where_dark(front, back, depth, extinction,
                           [&](float from, float to, const float* t) { sink_.medium(ray, from, to, t); });
            rounding = {};
            return;
        }
        float t[3];
        t[0] = rounding.transmittance(0, depth * extinction[0]);
        for (int c = 1; c < 3; ++c)
            t[c] = extinction[c] == extinction[0] ? t[0] : rounding.transmittance(c, depth * extinction[c]);
        if (!transmits_all(t)) sink_.medium(ray, front, back, t);
    }

    template <bool moving>
    void project(const Prepared& p, const scene::Particles& particles) {
        if constexpr (std::is_same_v<Sink, SegmentHits>) {
            for (const std::uint32_t i : p.bins.of(tile_)) {
                check_hits(sink_);
                visit_sphere<moving>(
                    p, i, particles.radii[i], [&](std::uint32_t ray, double front, double back, double scale) {
                        front = std::max(front, view_.z_near);
                        const float f = static_cast<float>(front);
                        const float b = static_cast<float>(back) > f ? static_cast<float>(back) : next_depth(f);
                        StepRounding alone;
                        medium(ray, f, b, (back - front) * scale * particles.density[i], p.object->extinction, alone);
                    });
            }
        }
    }

    template <bool moving>
    void project(const Prepared& p, const scene::GridVolume&) {
        if constexpr (std::is_same_v<Sink, SegmentHits>) {
            if constexpr (moving) {
                for (const TimedRay& ray : grid_.timed) add_ray(p, ray.ray, ray.x, ray.y, p.motion * ray.time);
            } else {
                // Pixel after pixel, in the order of the rays' numbers: then there is nothing to sort.
                for (int y = 0; y < grid_.ny; y += grid_.samples_y)
                    for (int x = 0; x < grid_.nx; x += grid_.samples_x)
                        for (int j = y; j < y + grid_.samples_y; ++j)
                            for (int i = x; i < x + grid_.samples_x; ++i) {
                                const std::size_t sample = static_cast<std::size_t>(j) * grid_.nx + i;
                                add_ray(p, grid_.ray_row[j] + grid_.ray_column[i], grid_.x[sample], grid_.y[sample],
                                        {0, 0, 0});
                            }
            }
            march(p);
        }
    }

    // Adds a ray to those that are marched together, through a volume at its position in the scene: the ray moves the
    // opposite way instead.
    void add_ray(const Prepared& p, std::uint32_t ray, double x, double y, const Vec3d& moved) {
        const ViewLine line = view_line(view_, x, y);
        const Vec3d& d = line.direction;
        world_rays_[together_] = {to_world(view_, line.origin - moved),
                                  view_.right * d.x + view_.up * d.y + view_.forward * d.z, line.scale};
        ray_numbers_[together_] = ray;
        if (++together_ == side_by_side) march(p);
    }

    // Marches the rays that were added.
    void march(const Prepared& p) {
        check_hits(sink_);
        const std::span<const WorldRay> rays(world_rays_.data(), std::exchange(together_, 0));
        const double z_near = std::max(view_.z_near, -1e30);
        const base::Vec3f& extinction = p.object->extinction;
        const bool grey = extinction[0] == extinction[1] && extinction[0] == extinction[2];
        if (!cells_ && grey && p.marcher->march_side_by_side(rays, z_near, 1e30, extinction[0], steps_)) {
            for (std::size_t r = 0; r < rays.size(); ++r)
                for (const MediumStep& step : steps_[r]) {
                    const float t[3] = {step.transmittance, step.transmittance, step.transmittance};
                    sink_.medium(ray_numbers_[r], step.front, step.back, t);
                }
            return;
        }
        for (std::size_t r = 0; r < rays.size(); ++r) {
            segments_.clear();
            const auto cut = cells_ ? &VolumeMarcher::march_cells : &VolumeMarcher::march;
            (*p.marcher.*cut)(rays[r].origin, rays[r].direction, rays[r].scale, z_near, 1e30, segments_);
            StepRounding rounding;
            for (const MediumSegment& s : segments_)
                medium(ray_numbers_[r], s.front, s.back, s.depth, extinction, rounding);
        }
    }

    const LightView& view_;
    const bool cells_;  // of grid volumes, else steps
    const TileGrid& grid_;
    const int tile_;
    Sink& sink_;
    const double longest_;  // at least every ray's length per depth in this tile
    std::vector<MediumSegment> segments_;
    Lanes<WorldRay> world_rays_;  // to be marched together
    Lanes<std::uint32_t> ray_numbers_;
    std::size_t together_ = 0;
    Lanes<std::vector<MediumStep>> steps_;
};

}  // namespace shadowbench::rays
