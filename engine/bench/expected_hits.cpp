#include "bench/expected_hits.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <type_traits>
#include <variant>

namespace shadowbench::bench {
namespace {

using base::Vec2d;
using base::Vec3d;
using base::Vec3f;

constexpr std::size_t most_looked_at = 20'000;  // primitives of an object
constexpr double little_left = 1e-4;            // of the light: what is behind is not seen
// A tracer tests a piece of hair for rays that pass it this near, in lengths of the piece.
constexpr double tested = 0.25;

// An area on the map and the rectangle around it, in map pixels.
struct Area {
    double pixels = 0.0;
    Vec2d low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()}, high = -low;

    void add(const Vec3d& place, double reach) {
        low = {std::min(low.x, place.x - reach), std::min(low.y, place.y - reach)};
        high = {std::max(high.x, place.x + reach), std::max(high.y, place.y + reach)};
    }
};

// The share of a stretch that lies in [0, size].
double share_inside(double low, double high, double size) {
    if (!(high > low)) return low >= 0.0 && low <= size ? 1.0 : 0.0;
    return std::max(0.0, std::min(high, size) - std::max(low, 0.0)) / (high - low);
}

// Projects places of a scene into the map.
class Projection {
public:
    explicit Projection(const rays::LightView& view) : view_(view) {}

    bool before(const Vec3d& light) const { return !view_.perspective || light.z > std::max(view_.z_near, 0.0); }
    Vec3d place(const Vec3d& world) const { return rays::to_light(view_, world); }
    // A world length at this depth, in map pixels: the geometric mean of both axes.
    double pixels(double length, double z) const {
        return length / std::sqrt(view_.pixel.x * view_.pixel.y) / (view_.perspective ? z : 1.0);
    }
    double map() const { return static_cast<double>(view_.resolution.x) * view_.resolution.y; }
    // The part of the map that the area covers; of an area that reaches beyond the map, its share of the rectangle.
    double covered(const Area& area) const {
        return area.pixels / map() * share_inside(area.low.x, area.high.x, view_.resolution.x) *
               share_inside(area.low.y, area.high.y, view_.resolution.y);
    }

    double disc(const Vec3f& centre, float radius) const {
        const Vec3d at = place(Vec3d(centre));
        if (!before(at)) return 0.0;
        const double r = pixels(static_cast<double>(radius), at.z);
        Area area{std::numbers::pi * r * r};
        area.add(at, r);
        return covered(area);
    }

    double triangle(const Vec3d& a, const Vec3d& b, const Vec3d& c) const {
        const Vec3d p = place(a), q = place(b), r = place(c);
        if (!before(p) || !before(q) || !before(r)) return behind_corner({p, q, r});
        Area area{0.5 * std::abs((q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x))};
        for (const Vec3d& corner : {p, q, r}) area.add(corner, 0.0);
        return covered(area);
    }

    // `least_width`: in map pixels. `around`: added on each side, in lengths of the ribbon in the world. Pixels need
    // not be square.
    double ribbon(const Vec3f& a, const Vec3f& b, float radius, double least_width, double around) const {
        const Vec3d p = place(Vec3d(a)), q = place(Vec3d(b));
        if (!before(p) || !before(q)) return 0.0;
        const double z = 0.5 * (p.z + q.z), pixel = std::sqrt(view_.pixel.x * view_.pixel.y);
        const double r = std::max(pixels(static_cast<double>(radius), z), 0.5 * least_width) +
                         pixels(around * Vec3d(b - a).length(), z);
        Area area{2.0 * r * std::hypot((q.x - p.x) * view_.pixel.x, (q.y - p.y) * view_.pixel.y) / pixel};
        for (const Vec3d& end : {p, q}) area.add(end, r);
        return covered(area);
    }

private:
    // What reaches behind the light may cover the whole map.
    double behind_corner(std::initializer_list<Vec3d> corners) const {
        return std::any_of(corners.begin(), corners.end(), [&](const Vec3d& corner) { return before(corner); }) ? 0.5
                                                                                                                : 0.0;
    }

    const rays::LightView& view_;
};

// The sum over all of `count` primitives of what `of` gives for each.
template <class Of>
double sum(std::size_t count, const Of& of) {
    const std::size_t looked_at = std::min(count, most_looked_at);
    double all = 0.0;
    for (std::size_t i = 0; i < looked_at; ++i) all += of(i * count / looked_at);
    return looked_at ? all * static_cast<double>(count) / static_cast<double>(looked_at) : 0.0;
}

// The part of the map that a box covers: each ray through it enters one face and leaves by another.
double covered(const Projection& in, const base::Box3d& box, const scene::GridFrame* frame) {
    if (box.isEmpty()) return 0.0;
    const auto corner = [&](int i) {
        const Vec3d at(i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y, i & 4 ? box.max.z : box.min.z);
        return frame ? base::map_point(frame->to_world, at) : at;
    };
    constexpr int faces[6][4] = {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}};
    double twice = 0.0;
    for (const auto& f : faces)
        twice += in.triangle(corner(f[0]), corner(f[1]), corner(f[2])) +
                 in.triangle(corner(f[0]), corner(f[2]), corner(f[3]));
    return std::min(1.0, 0.5 * twice);
}

double crossings(const Projection& in, const scene::Mesh& mesh) {
    return sum(mesh.triangles.size(), [&](std::size_t i) {
        const base::Vec3i& corners = mesh.triangles[i];
        const auto corner = [&](int c) { return Vec3d(mesh.positions[static_cast<std::size_t>(c)]); };
        return in.triangle(corner(corners.x), corner(corners.y), corner(corners.z));
    });
}

double crossings(const Projection& in, const scene::Spheres& spheres) {
    return 2.0 *
           sum(spheres.centres.size(), [&](std::size_t i) { return in.disc(spheres.centres[i], spheres.radii[i]); });
}

double crossings(const Projection& in, const scene::Particles& particles) {
    return sum(particles.centres.size(),
               [&](std::size_t i) { return in.disc(particles.centres[i], particles.radii[i]); });
}

double crossings(const Projection& in, const scene::Hair& hair, double least_width, double around) {
    if (hair.points.size() < 2) return 0.0;
    return sum(hair.points.size() - 1, [&](std::size_t i) {
        const bool strand_ends = std::binary_search(hair.strand_begin.begin(), hair.strand_begin.end(), i + 1);
        return strand_ends ? 0.0
                           : in.ribbon(hair.points[i], hair.points[i + 1], 0.5f * (hair.radii[i] + hair.radii[i + 1]),
                                       least_width, around);
    });
}

// The part of the voxels that have density.
double filled(const scene::GridVolume& grid) {
    const double count = static_cast<double>(grid.density.size());
    return sum(grid.density.size(), [&](std::size_t i) { return grid.density[i] > 0.0f ? 1.0 : 0.0; }) /
           std::max(count, 1.0);
}

double mean(const std::vector<float>& values) {
    return sum(values.size(), [&](std::size_t i) { return static_cast<double>(values[i]); }) /
           std::max(1.0, static_cast<double>(values.size()));
}

// The world length of a ray through the middle of the box.
double chord(const scene::GridVolume& grid) {
    const Vec3d size = scene::world_box(grid).size();
    return std::cbrt(size.x * size.y * size.z);
}

// Steps or cells of such a ray, were there density everywhere.
double segments_through(const scene::GridVolume& grid, bool cells) {
    const double count = static_cast<double>(grid.size.x) * grid.size.y * grid.size.z;
    return cells ? 2.0 * std::cbrt(count) : chord(grid) / grid.step;
}

// The length of a ray in particles, on average: of one through a sphere it is 4/3 of the radius.
double length_inside(const Projection& in, const scene::Particles& particles) {
    return sum(particles.centres.size(), [&](std::size_t i) {
        return in.disc(particles.centres[i], particles.radii[i]) * 4.0 / 3.0 * static_cast<double>(particles.radii[i]);
    });
}

double mean(const Vec3f& channels) {
    return (static_cast<double>(channels.x) + static_cast<double>(channels.y) + static_cast<double>(channels.z)) / 3.0;
}

// The share of a way through media of this optical depth that lies before almost nothing of the light is left.
double before_dark(double optical_depth) {
    return std::min(1.0, -std::log(little_left) / std::max(optical_depth, 1e-9));
}

// Adds an object that a share of the rays meets, `crossed` times a ray of the map.
void add_seen(double crossed, double share, double opacity, ExpectedHits& hits) {
    if (!(share > 0.0)) return;
    const double through = -std::log(std::max(1.0 - opacity, little_left));
    const double before_dark = through > 0.0 ? std::ceil(-std::log(little_left) / through) : crossed / share;
    hits.seen += share * std::min(std::max(crossed / share, 0.0), before_dark);
}

void add(const Projection& in, const scene::Object& object, bool cells, double least_hair, ExpectedHits& hits) {
    if (const auto* grid = std::get_if<scene::GridVolume>(&object.shape)) {
        const double share = covered(in, {grid->lower, grid->upper}, grid->frame ? &*grid->frame : nullptr);
        const double part = share * filled(*grid), way = chord(*grid);
        const double parts = part * segments_through(*grid, cells);
        hits.segments += parts;
        hits.steps += parts;
        hits.grids += parts;
        hits.media = std::min(1.0, hits.media + share);
        hits.inside += part * way * before_dark(mean(grid->density) * mean(object.extinction) * way);
        return;
    }
    const double share = covered(in, scene::bounds(object), nullptr);
    if (const auto* hair = std::get_if<scene::Hair>(&object.shape)) {
        const double crossed = crossings(in, *hair, least_hair, 0.0), of_its_width = crossings(in, *hair, 0.0, 0.0);
        hits.segments += crossed;
        hits.hair_tests += crossings(in, *hair, least_hair, tested);
        add_seen(crossed, std::min(1.0, share), crossed > 0.0 ? mean(object.opacity) * of_its_width / crossed : 0.0,
                 hits);
        return;
    }
    double crossed = 0.0;
    std::visit(
        [&](const auto& shape) {
            using Shape = std::decay_t<decltype(shape)>;
            if constexpr (!std::is_same_v<Shape, scene::GridVolume> && !std::is_same_v<Shape, scene::Hair>)
                crossed = crossings(in, shape);
        },
        object.shape);
    hits.segments += crossed;
    if (const auto* particles = std::get_if<scene::Particles>(&object.shape)) {
        hits.media = std::min(1.0, hits.media + std::min(share, crossed));
        hits.steps += crossed;
        // Balls that overlap share their way, but not their optical depth.
        const double way = share > 0.0 ? length_inside(in, *particles) / share : 0.0;
        const double longest = scene::bounds(object).size().length() / std::sqrt(3.0);
        hits.inside +=
            share * std::min(way, longest) * before_dark(mean(particles->density) * mean(object.extinction) * way);
    } else {
        add_seen(crossed, std::min(1.0, std::max(share, 0.0)), mean(object.opacity), hits);
    }
}

}  // namespace

ExpectedHits expected_hits(const scene::Scene& scene, const rays::LightView& view, bool casters_only, bool cells) {
    ExpectedHits hits;
    if (scene.deep_image) {
        const double pixels = static_cast<double>(scene.deep_image->width) * scene.deep_image->height;
        hits.segments = hits.seen = static_cast<double>(scene.deep_image->z_front.size()) / pixels;
        return hits;
    }
    const Projection projection(view);
    for (const scene::Object& object : scene.objects)
        if (object.casts_shadow || !casters_only) add(projection, object, cells, 0.0, hits);
    return hits;
}

ExpectedHits expected_hits(const scene::Object& object, const rays::LightView& view, bool cells, double least_hair) {
    ExpectedHits hits;
    add(Projection(view), object, cells, least_hair, hits);
    return hits;
}

rays::LightView camera_view(const scene::Camera& camera, base::Vec2i resolution) {
    rays::LightView view;
    view.perspective = true;
    view.origin = camera.position;
    view.forward = (camera.target - camera.position).normalized();
    view.right = view.forward.cross(camera.up).normalized();
    view.up = view.right.cross(view.forward);
    view.resolution = resolution;
    const double side = 2.0 * std::tan(camera.fov * std::numbers::pi / 360.0) / resolution.y;
    view.pixel = {side, side};
    view.lower = {-0.5 * side * resolution.x, -0.5 * side * resolution.y};
    return view;
}

}  // namespace shadowbench::bench
