#include "rays/prepared.h"

#include <algorithm>
#include <variant>

#include "base/parallel.h"
#include "rays/moving.h"
#include "scene/scene.h"

namespace shadowbench::rays {
namespace {

using base::Vec3d;
using base::Vec3f;

void to_view_space(const LightView& view, const std::vector<Vec3f>& world, std::vector<Vec3f>& out) {
    out.resize(world.size());
    constexpr std::size_t chunk = 16384;
    base::parallel_for((world.size() + chunk - 1) / chunk, [&](std::size_t block) {
        for (std::size_t i = block * chunk; i < std::min(world.size(), (block + 1) * chunk); ++i)
            out[i] = Vec3f(to_view(view, Vec3d(world[i])));
    });
}

}  // namespace

HairSegment hair_segment(const Prepared& p, const scene::Hair& hair, std::uint32_t segment) {
    const std::uint32_t a = p.segments.first[segment];
    return {p.points[a], p.points[a + 1], hair.radii[a], hair.radii[a + 1], p.segments.joined[segment] != 0};
}

Prepared prepare(const scene::Object& object, const LightView& view, const MapLayout& layout) {
    Prepared p;
    p.object = &object;
    for (int c = 0; c < 3; ++c) p.transmittance[c] = 1.0f - object.opacity[c];
    p.moving = layout.moving && object.motion != Vec3f(0, 0, 0);
    if (p.moving) p.motion = to_view(view, view.origin + Vec3d(object.motion));
    const Vec3d still(0, 0, 0);
    if (const auto* mesh = std::get_if<scene::Mesh>(&object.shape)) {
        to_view_space(view, mesh->positions, p.points);
        p.bins = make_bins(view, layout, mesh->triangles.size(), [&](std::size_t i) {
            const Vec3f &a = p.points[mesh->triangles[i].x], &b = p.points[mesh->triangles[i].y];
            const Vec3f& c = p.points[mesh->triangles[i].z];
            if (p.moving)
                return swept(view, place_triangle(view, a, b, c, still), place_triangle(view, a, b, c, p.motion));
            PlaneBox box;
            add_triangle(view, Vec3d(a), Vec3d(b), Vec3d(c), box);
            return box;
        });
    } else if (const auto* hair = std::get_if<scene::Hair>(&object.shape)) {
        to_view_space(view, hair->points, p.points);
        p.segments = segments(*hair);
        p.bins = make_bins(view, layout, p.segments.first.size(), [&](std::size_t i) {
            const HairSegment s = hair_segment(p, *hair, static_cast<std::uint32_t>(i));
            if (p.moving) return swept(view, place_hair(view, s, still), place_hair(view, s, p.motion));
            PlaneBox box;
            add_hair(view, Vec3d(s.a), s.radius_a, Vec3d(s.b), s.radius_b, box);
            return box;
        });
    } else if (const auto* grid = std::get_if<scene::GridVolume>(&object.shape)) {
        p.marcher = std::make_unique<VolumeMarcher>(*grid);
    } else {
        const auto* spheres = std::get_if<scene::Spheres>(&object.shape);
        const auto* particles = std::get_if<scene::Particles>(&object.shape);
        const std::vector<float>& radii = spheres ? spheres->radii : particles->radii;
        to_view_space(view, spheres ? spheres->centres : particles->centres, p.points);
        p.bins = make_bins(view, layout, p.points.size(), [&](std::size_t i) {
            const Vec3f& c = p.points[i];
            if (p.moving)
                return swept(view, place_sphere(view, c, radii[i], still), place_sphere(view, c, radii[i], p.motion));
            PlaneBox box;
            add_sphere(view, Vec3d(c), radii[i], box);
            return box;
        });
    }
    return p;
}

}  // namespace shadowbench::rays
