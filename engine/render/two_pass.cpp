#include "render/two_pass.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "rays/grid_media.h"
#include "rays/image_plane.h"
#include "rays/march.h"

namespace shadowbench::render {
namespace {

using base::Vec3d;
using techniques::Query;

constexpr std::size_t rays_at_once = 256;  // of a thread

// Calls body(first, count) for stretches of rays, on all threads.
template <class Body>
void for_each_stretch(std::size_t rays, const Body& body) {
    base::parallel_for((rays + rays_at_once - 1) / rays_at_once, [&](std::size_t i) {
        const std::size_t first = i * rays_at_once;
        body(first, std::min(rays_at_once, rays - first));
    });
}

// The place in the middle of step i.
double middle(const BoxRay& ray, int i, int steps) {
    return ray.front + (ray.back - ray.front) * (i + 0.5) / steps;
}

Query query_at(const rays::LightView& view, const Vec3d& place) {
    const Vec3d light = rays::to_light(view, place);
    return {static_cast<float>(light.x), static_cast<float>(light.y), static_cast<float>(light.z), 0.0f};
}

// The colour that a ray gathers in one of its equal steps, and the middle of that colour.
struct Gathered {
    double colour = 0.0, place = 0.0;
};
std::vector<Gathered> gathered(const BoxRay& ray, const std::vector<ColourStep>& colours, int steps) {
    std::vector<Gathered> result(static_cast<std::size_t>(steps));
    for (const ColourStep& step : colours) {
        const double place = 0.5 * (step.front + step.back), share = (place - ray.front) / (ray.back - ray.front);
        Gathered& part = result[static_cast<std::size_t>(std::clamp(static_cast<int>(share * steps), 0, steps - 1))];
        part.colour += step.colour;
        part.place += step.colour * place;
    }
    for (Gathered& part : result)
        if (part.colour > 0.0) part.place /= part.colour;
    return result;
}

}  // namespace

BoxRay cut_to_box(const Vec3d& origin, const Vec3d& direction, double from, const scene::GridVolume& volume) {
    const BoxRay missed{origin, direction};
    const Vec3d start = volume.frame ? base::map_point(volume.frame->to_grid, origin) : origin;
    const Vec3d way = volume.frame ? base::map_direction(volume.frame->to_grid, direction) : direction;
    double front = from, back = std::numeric_limits<double>::infinity();
    for (int a = 0; a < 3; ++a) {
        const double lower = volume.lower[a] - start[a], upper = volume.upper[a] - start[a];
        if (way[a] == 0.0) {
            if (lower > 0.0 || upper < 0.0) return missed;
            continue;
        }
        const double one = lower / way[a], other = upper / way[a];
        front = std::max(front, std::min(one, other));
        back = std::min(back, std::max(one, other));
    }
    return back > front ? BoxRay{origin, direction, front, back} : missed;
}

std::vector<BoxRay> box_rays(const scene::Camera& camera, base::Vec2i size, const scene::GridVolume& volume,
                             std::optional<std::uint64_t> seed) {
    const rays::ImagePlane plane = rays::make_image_plane(camera, size);
    std::vector<BoxRay> result;
    result.reserve(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y));
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            double dx = 0.5, dy = 0.5;
            if (seed) {
                base::Random random(base::hash(*seed, result.size()));
                dx = random.uniform();
                dy = random.uniform();
            }
            result.push_back(cut_to_box(plane.origin, plane.direction(x + dx, y + dy), 0.0, volume));
        }
    return result;
}

struct ColourPass::State {
    scene::GridVolume volume;
    double extinction;
    rays::VolumeMarcher marcher;

    State(const scene::GridVolume& grid, double per_density) : volume(grid), extinction(per_density), marcher(volume) {}
};

ColourPass::ColourPass(const scene::Object& object, int steps) {
    const auto* volume = std::get_if<scene::GridVolume>(&object.shape);
    const base::Vec3f& extinction = object.extinction;
    if (!volume || extinction.x != extinction.y || extinction.x != extinction.z)
        throw base::Error(base::ErrorCode::bad_input, "/scene/objects",
                          "a volume with a single number as its extinction is needed here");
    state_ = std::make_unique<State>(*volume, extinction.x);
    state_->volume.step = scene::longest_way(*volume) / steps;
}

ColourPass::~ColourPass() = default;

void ColourPass::trace(const BoxRay& ray, std::vector<ColourStep>& out) const {
    out.clear();
    if (!ray.meets()) return;
    std::vector<rays::MediumSegment> segments;
    state_->marcher.march(ray.origin, ray.direction, 1.0, ray.front, ray.back, segments);
    double left = 1.0;
    for (const rays::MediumSegment& s : segments) {
        const double front = s.front, back = s.back;
        const double opacity = -std::expm1(-state_->extinction * s.depth), sample = s.depth / (back - front);
        out.push_back({front, back, left * opacity * sample});
        left *= 1.0 - opacity;
    }
}

std::vector<double> ColourPass::colours(std::span<const BoxRay> rays) const {
    std::vector<double> result(rays.size(), 0.0);
    for_each_stretch(rays.size(), [&](std::size_t first, std::size_t count) {
        std::vector<ColourStep> steps;
        for (std::size_t r = first; r < first + count; ++r) {
            trace(rays[r], steps);
            for (const ColourStep& step : steps) result[r] += step.colour;
        }
    });
    return result;
}

std::vector<double> mean_opacities(std::span<const BoxRay> rays, int samples, const rays::LightView& view,
                                   const bench::Maps& maps) {
    std::vector<double> result(rays.size(), 0.0);
    for_each_stretch(rays.size(), [&](std::size_t first, std::size_t count) {
        std::vector<Query> queries;
        for (std::size_t r = first; r < first + count; ++r)
            for (int i = 0; rays[r].meets() && i < samples; ++i)
                queries.push_back(query_at(view, rays[r].at(middle(rays[r], i, samples))));
        std::vector<float> visibility(queries.size() * maps.channels());
        bench::lookup(maps, queries, visibility);
        const float* next = visibility.data();
        for (std::size_t r = first; r < first + count; ++r) {
            if (!rays[r].meets()) continue;
            for (int i = 0; i < samples; ++i) result[r] += 1.0 - *next++;
            result[r] /= samples;
        }
    });
    return result;
}

std::vector<double> exact_opacities(std::span<const BoxRay> rays, int samples, const scene::Scene& scene,
                                    const rays::LightView& view, const ColourPass& pass) {
    const rays::GridMedia media(scene, true);
    std::vector<double> result(rays.size(), 0.0);
    for_each_stretch(rays.size(), [&](std::size_t first, std::size_t count) {
        std::vector<ColourStep> steps;
        for (std::size_t r = first; r < first + count; ++r) {
            pass.trace(rays[r], steps);
            double all = 0.0, kept = 0.0;
            for (const Gathered& part : gathered(rays[r], steps, samples)) {
                if (part.colour == 0.0) continue;
                const Vec3d light = rays::to_light(view, rays[r].at(part.place));
                Vec3d depth;
                media.optical_depths(view, light.x, light.y, scene::mid_shutter, std::span(&light.z, 1),
                                     std::span(&depth, 1));
                all += part.colour;
                kept -= part.colour * std::expm1(-depth.x);
            }
            if (all > 0.0) result[r] = kept / all;
        }
    });
    return result;
}

Image grey_picture(std::span<const double> values, base::Vec2i size) {
    Image image(size, base::Vec3f(0.0f));
    for (std::size_t i = 0; i < values.size(); ++i) image.pixels[i] = base::Vec3f(static_cast<float>(values[i]));
    return image;
}

std::vector<double> darkened(std::span<const double> colours, std::span<const double> opacities) {
    std::vector<double> result;
    result.reserve(colours.size());
    for (std::size_t i = 0; i < colours.size(); ++i) result.push_back(colours[i] * (1.0 - opacities[i]));
    return result;
}

}  // namespace shadowbench::render
