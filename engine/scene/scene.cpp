#include "scene/scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include <fmt/format.h>

#include "base/limits.h"
#include "base/printable.h"
#include "scene/cube_face.h"

namespace shadowbench::scene {
namespace {

// The texel left of `position` (in texels, repeated) and the fraction of the way to the next one.
struct Tap {
    int first, second;
    float fraction;
};

Tap tap(float position, int count) {
    const float below = std::floor(position);
    const float wrapped = below - std::floor(below / static_cast<float>(count)) * static_cast<float>(count);
    // Far from 0, rounding moves it out of the texture and beyond int.
    const int first = static_cast<int>(std::clamp(wrapped, 0.0f, static_cast<float>(count - 1)));
    return {first, first + 1 == count ? 0 : first + 1, position - below};
}

Vec3d wide(const Vec3f& v) {
    return Vec3d(v.x, v.y, v.z);
}

void extend(Box3d& box, const Vec3d& centre, double radius) {
    const Vec3d half(radius, radius, radius);
    box.extendBy(centre - half);
    box.extendBy(centre + half);
}

// Ignores vertices that no triangle uses, which files may hold.
void extend(Box3d& box, const Mesh& mesh) {
    for (const Vec3i& triangle : mesh.triangles)
        for (const int index : {triangle.x, triangle.y, triangle.z})
            box.extendBy(wide(mesh.positions[static_cast<std::size_t>(index)]));
}

void extend(Box3d& box, const Spheres& spheres) {
    for (std::size_t i = 0; i < spheres.centres.size(); ++i) extend(box, wide(spheres.centres[i]), spheres.radii[i]);
}

void extend(Box3d& box, const Hair& hair) {
    for (std::size_t i = 0; i < hair.points.size(); ++i) extend(box, wide(hair.points[i]), hair.radii[i]);
}

void extend(Box3d& box, const GridVolume& volume) {
    box.extendBy(world_box(volume));
}

void extend(Box3d& box, const Particles& particles) {
    for (std::size_t i = 0; i < particles.centres.size(); ++i)
        extend(box, wide(particles.centres[i]), particles.radii[i]);
}

bool is_medium(const Object& object) {
    return std::holds_alternative<GridVolume>(object.shape) || std::holds_alternative<Particles>(object.shape);
}

bool is_grey(const Vec3f& colour) {
    return colour.x == colour.y && colour.y == colour.z;
}

}  // namespace

float sample(const AlphaTexture& texture, float u, float v) {
    // Texel centres are at half integers. Row 0 is the top of the image; v grows upwards.
    const Tap x = tap(u * static_cast<float>(texture.width) - 0.5f, texture.width);
    const Tap y = tap((1.0f - v) * static_cast<float>(texture.height) - 0.5f, texture.height);
    const auto texel = [&](int column, int row) {
        return texture.alpha[static_cast<std::size_t>(row) * static_cast<std::size_t>(texture.width) +
                             static_cast<std::size_t>(column)];
    };
    const float upper = std::lerp(texel(x.first, y.first), texel(x.second, y.first), x.fraction);
    const float lower = std::lerp(texel(x.first, y.second), texel(x.second, y.second), x.fraction);
    return std::lerp(upper, lower, y.fraction);
}

void place(GridVolume& volume, const base::Matrix4d& move) {
    const base::Matrix4d to_world = volume.frame ? volume.frame->to_world * move : move;
    volume.frame.reset();
    bool along_axes = true;  // scaled and moved only, so that a box stays one
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) along_axes = along_axes && (i == k ? to_world[i][i] > 0.0 : to_world[i][k] == 0.0);
    if (along_axes) {
        volume.lower = base::map_point(to_world, volume.lower);
        volume.upper = base::map_point(to_world, volume.upper);
    } else {
        volume.frame = GridFrame{to_world, to_world.inverse()};
    }
}

Box3d world_box(const GridVolume& volume) {
    Box3d box;
    if (!volume.frame) {
        box.extendBy(volume.lower);
        box.extendBy(volume.upper);
        return box;
    }
    for (int i = 0; i < 8; ++i) {
        const Vec3d corner(i & 1 ? volume.upper.x : volume.lower.x, i & 2 ? volume.upper.y : volume.lower.y,
                           i & 4 ? volume.upper.z : volume.lower.z);
        box.extendBy(base::map_point(volume.frame->to_world, corner));
    }
    return box;
}

double longest_way(const GridVolume& volume) {
    const Vec3d extent = volume.upper - volume.lower;
    if (!volume.frame) return extent.length();
    double longest = 0.0;  // of the four diagonals
    for (int i = 0; i < 4; ++i) {
        const Vec3d diagonal(i & 1 ? -extent.x : extent.x, i & 2 ? -extent.y : extent.y, extent.z);
        longest = std::max(longest, base::map_direction(volume.frame->to_world, diagonal).length());
    }
    return longest;
}

double voxel_width(const GridVolume& volume) {
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i) {
        double width = (volume.upper[i] - volume.lower[i]) / volume.size[i];
        if (volume.frame) {
            const base::Matrix4d& to_grid = volume.frame->to_grid;
            width /= Vec3d(to_grid[0][i], to_grid[1][i], to_grid[2][i]).length();
        }
        least = std::min(least, width);
    }
    return least;
}

Box3d bounds(const Object& object) {
    Box3d box;
    std::visit([&](const auto& shape) { extend(box, shape); }, object.shape);
    return box;
}

Box3d bounds(const Scene& scene, bool casters_only) {
    Box3d box;
    for (const Object& object : scene.objects) {
        if (casters_only && !object.casts_shadow) continue;
        const Box3d still = bounds(object);
        if (still.isEmpty()) continue;
        box.extendBy(still);
        box.extendBy(Box3d(still.min + wide(object.motion), still.max + wide(object.motion)));
    }
    return box;
}

bool behind_everything(const DeepImage& image, std::size_t sample) {
    return !(image.z_back[sample] <= static_cast<float>(base::max_coordinate));
}

std::vector<std::string> read_notes(const Scene& scene) {
    std::vector<std::string> lines;
    const auto add = [&](const std::string& where, const ReadNotes& notes) {
        for (const std::string& line : notes.lines) lines.push_back(base::printable(where + ": " + line));
    };
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const Object& object = scene.objects[i];
        const std::string where = fmt::format("/scene/objects/{}", i);
        if (const auto* volume = std::get_if<GridVolume>(&object.shape)) add(where, volume->notes);
        std::string passed_over;
        for (const PassedOver& each : object.passed_over)
            passed_over += fmt::format("{}{} ({})", passed_over.empty() ? "" : ", ", each.what, each.count);
        if (!passed_over.empty()) add(where, {{"passed over: " + passed_over}});
    }
    if (scene.deep_image) add("/scene/deep_image", scene.deep_image->notes);
    return lines;
}

namespace {

// The width of a lookup of a face at planar depth z, as a share of the shorter side of the map.
double length_share(const Scenario& scenario, const Light& face, double length, double z) {
    const Vec2i resolution = scenario.rays.resolution;
    const double side = 2.0 * (1.0 + face.border) * z;  // of the map, at this depth
    return length / side * resolution.x / std::min(resolution.x, resolution.y);
}

// The planar depth of a receiver whose lookup, as wide as `length`, surely reaches over the map of a light's face: of
// given points the nearest such one; else, if the farthest place of the scene is one, that. Infinite if none is known.
double cut_depth(const Scenario& scenario, const Light& face, double length) {
    constexpr double beyond = 1.05;  // spread receivers reach a little behind the casters
    constexpr double none = std::numeric_limits<double>::infinity();
    if (scenario.receivers.camera || scenario.receivers.points.empty()) {
        const Box3d box = bounds(scenario.scene, false);
        if (box.isEmpty()) return none;
        double farthest = 0.0;
        for (int axis = 0; axis < 3; ++axis)
            farthest = std::max({farthest, std::abs(box.min[axis] - face.position[axis]),
                                 std::abs(box.max[axis] - face.position[axis])});
        return farthest * beyond;
    }
    double nearest = none;
    for (const Vec3d& point : scenario.receivers.points) {
        const Vec3d way = point - face.position;
        const int on = cube_face(way);
        const bool has_map = std::any_of(scenario.lights.begin(), scenario.lights.end(), [&](const Light& light) {
            return light.where == face.where && light.face == on;
        });
        std::array<double, 3> along{std::abs(way.x), std::abs(way.y), std::abs(way.z)};
        std::sort(along.begin(), along.end());
        const double z = along[2], half = length_share(scenario, face, length, z) * (1.0 + face.border);
        if (has_map && along[1] / z + half > 1.0 + face.border) nearest = std::min(nearest, z);
    }
    return nearest;
}

// What is known before the lookups; a width in receiver pixels is not.
std::string border_note(const Scenario& scenario, const Light& face) {
    const FilterWidth width = face.softness.value_or(scenario.receivers.filter_width);
    const Vec2i resolution = scenario.rays.resolution;
    const double shorter = std::min(resolution.x, resolution.y), room = face.border / (1.0 + face.border);
    const bool as_length = width.unit == WidthUnit::length;
    const double share = as_length ? length_share(scenario, face, width.value, cut_depth(scenario, face, width.value))
                         : width.unit == WidthUnit::share      ? width.value * resolution.x / shorter
                         : width.unit == WidthUnit::map_pixels ? width.value / shorter
                                                               : 0.0;
    if (!(share > room * (1.0 + 1e-9))) return "";
    constexpr double widest = 10.0;  // border
    const double border = as_length ? share * (1.0 + face.border) : share < 1.0 ? share / (1.0 - share) : 2.0 * widest;
    const std::string remedy =
        border > widest ? "make them narrower"
                        : fmt::format("give it a border of {} or more", std::ceil(1e3 * border - 1e-6) / 1e3);
    return fmt::format(
        "{}: lookups are {:.3g} of a map wide and its border has room for {:.3g}, so at seams a part is cut off: {}",
        face.where, share, room, remedy);
}

}  // namespace

std::vector<std::string> notes(const Scenario& scenario) {
    std::vector<std::string> lines = read_notes(scenario.scene);
    const Light* last = nullptr;
    for (const Light& light : scenario.lights) {
        if (light.face && (!last || last->where != light.where))  // one for all faces
            if (const std::string note = border_note(scenario, light); !note.empty()) lines.push_back(note);
        last = &light;
    }
    for (const Light& light : scenario.fills)
        lines.push_back(base::printable(
            light.face ? fmt::format("{}: face \"{}\" has no map: only pictures show its light, without shadows",
                                     light.where, light.name)
                       : fmt::format("{}: \"{}\" casts no shadow, so it has no map: only pictures show it", light.where,
                                     light.name)));
    return lines;
}

int channels(const Scene& scene) {
    if (scene.deep_image) return scene.deep_image->channels;
    for (const Object& object : scene.objects) {
        if (!object.casts_shadow) continue;
        if (!is_grey(is_medium(object) ? object.extinction : object.opacity)) return 3;
    }
    return 1;
}

bool has_media(const Scene& scene) {
    for (const Object& object : scene.objects)
        if (object.casts_shadow && is_medium(object)) return true;
    if (!scene.deep_image) return false;
    const DeepImage& image = *scene.deep_image;
    for (std::size_t i = 0; i < image.z_front.size(); ++i)
        if (image.z_back[i] > image.z_front[i] && !behind_everything(image, i)) return true;
    return false;
}

bool has_motion(const Scene& scene) {
    return std::any_of(scene.objects.begin(), scene.objects.end(),
                       [](const Object& object) { return object.casts_shadow && object.motion != Vec3f(0, 0, 0); });
}

HairSegments segments(const Hair& hair) {
    HairSegments s;
    const std::size_t strands = hair.strand_begin.empty() ? 0 : hair.strand_begin.size() - 1;
    s.first.reserve(hair.points.size());
    s.joined.reserve(hair.points.size());
    for (std::size_t strand = 0; strand < strands; ++strand)
        for (std::uint32_t a = hair.strand_begin[strand]; a + 1 < hair.strand_begin[strand + 1]; ++a) {
            s.first.push_back(a);
            s.joined.push_back(a > hair.strand_begin[strand]);
        }
    return s;
}

}  // namespace shadowbench::scene
