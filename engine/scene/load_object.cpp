#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scene/json_read.h"
#include "scene/limits.h"
#include "scene/load.h"
#include "scene/procedural.h"
#include "scene/readers/extension.h"
#include "scene/readers/files.h"
#include "scene/readers/hair_files.h"
#include "scene/readers/pbrt_files.h"
#include "scene/readers/point_files.h"

namespace shadowbench::scene {
namespace {

using Shape = decltype(Object::shape);

struct Loaded {
    Shape shape;
    std::vector<PassedOver> passed_over = {};
};

Loaded mesh(const json& from, const SearchPath& path, const std::string& where) {
    MeshFile file = load_mesh(from, path, where);
    return {std::move(file.mesh), std::move(file.passed_over)};
}
Loaded quad(const json& from, const SearchPath& path, const std::string& where) {
    return {load_quad(from, path, where)};
}
Loaded layers(const json& from, const SearchPath&, const std::string& where) {
    return {load_layers(from, where)};
}

Loaded sphere(const json& from, const SearchPath&, const std::string&) {
    double radius = 0.0;
    Vec3d centre(0, 0, 0);
    read(from, "radius", radius);
    read(from, "centre", centre);
    return {Spheres{{Vec3f(centre)}, {static_cast<float>(radius)}}};
}

void check_count(std::size_t count, std::size_t centres, const std::string& where) {
    if (count != centres)
        refuse(where, fmt::format("{} values for {} centres; give one for each centre", count, centres));
}

Loaded spheres(const json& from, const SearchPath&, const std::string& where) {
    Spheres shape;
    read(from, "centres", shape.centres);
    read(from, "radii", shape.radii);
    check_count(shape.radii.size(), shape.centres.size(), where + "/radii");
    return {std::move(shape)};
}

Loaded particles_from_file(const json& from, const SearchPath& path, const std::string& where) {
    for (const char* key : {"centres", "radii", "density"})
        if (from.contains(key))
            refuse(fmt::format("{}/{}", where, key), "the particles already have a file; remove one of the two");
    const std::filesystem::path name = find_file(path, from["file"].get<std::string>(), where + "/file");
    const std::string extension = extension_of(name);
    if (extension != ".ply" && extension != ".pbrt")
        refuse(where + "/file", unknown_extension(name, "particle", {".ply", ".pbrt"}));
    double radius = 0.0;
    read(from, "radius", radius);
    if (extension == ".pbrt") {
        if (radius > 0.0) refuse(where + "/radius", "the spheres of a pbrt scene have their own; remove this key");
        PbrtFile scene = read_pbrt(name);
        return {std::move(scene.particles), std::move(scene.passed_over)};
    }
    PointFile file = read_points(name, static_cast<float>(radius));
    if (!file.has_radii && radius == 0.0)
        refuse(where, "\"radius\" is missing: the file does not hold that of its points");
    return {std::move(file.points), std::move(file.passed_over)};
}

Loaded particles(const json& from, const SearchPath& path, const std::string& where) {
    if (from.contains("file")) return particles_from_file(from, path, where);
    for (const char* key : {"centres", "radii", "density"})
        if (!from.contains(key))
            refuse(where, fmt::format("\"{}\" is missing: particles have a file, or centres, radii and density", key));
    if (from.contains("radius"))
        refuse(where + "/radius", "only the points of a file have one; give each its radius in radii");
    Particles shape;
    read(from, "centres", shape.centres);
    read(from, "radii", shape.radii);
    read(from, "density", shape.density);
    check_count(shape.radii.size(), shape.centres.size(), where + "/radii");
    check_count(shape.density.size(), shape.centres.size(), where + "/density");
    return {std::move(shape)};
}

Hair with_length(Hair hair) {
    merge_equal_points(hair);
    return hair;
}

Loaded hair(const json& from, const SearchPath& path, const std::string& where) {
    const std::filesystem::path file = find_file(path, from["file"].get<std::string>(), where + "/file");
    double radius = 0.0;
    read(from, "radius", radius);
    const std::string extension = extension_of(file);
    if (std::find(hair_extensions.begin(), hair_extensions.end(), extension) == hair_extensions.end())
        refuse(where + "/file", unknown_extension(file, "hair", {hair_extensions.begin(), hair_extensions.end()}));
    CurveBasis basis = CurveBasis::linear;
    if (from.contains("basis")) {
        if (extension != ".txt" && !(extension == ".hair" && is_mitsuba_hair(file)))
            refuse(where + "/basis",
                   "only for Mitsuba's files of points; the lines between those of other files are known");
        if (from["basis"] == "bspline") basis = CurveBasis::bspline;
    }
    HairFile strands = read_strands(file, static_cast<float>(radius), basis);
    if (!strands.has_radii && radius == 0.0)
        refuse(where, "\"radius\" is missing: the file does not hold the width of its hair");
    return {with_length(std::move(strands.hair)), std::move(strands.passed_over)};
}

// That a ray through the ball crosses, on average: the areas of all hairs over that of the ball.
double hairs_on_a_ray(const HairBall& ball) {
    constexpr double tapered = 0.625;  // mean width of a hair over that of its root
    const double reach = ball.ball_radius + ball.length + ball.radius;
    return ball.strands * (2.0 * tapered * ball.radius / reach) * (ball.length / reach) / std::numbers::pi;
}

Loaded hair_ball(const json& from, const SearchPath&, const std::string& where) {
    HairBall ball;
    read(from, "strands", ball.strands);
    read(from, "segments", ball.segments);
    read(from, "centre", ball.centre);
    read(from, "ball_radius", ball.ball_radius);
    read(from, "length", ball.length);
    read(from, "curl_radius", ball.curl_radius);
    read(from, "curls", ball.curls);
    read(from, "clumping", ball.clumping);
    read(from, "radius", ball.radius);
    read(from, "seed", ball.seed);
    const std::uint64_t points =
        static_cast<std::uint64_t>(ball.strands) * static_cast<std::uint64_t>(ball.segments + 1);
    if (points > max_hair_points)
        refuse(where + "/strands", fmt::format("{} points of hair; the limit is {}", points, max_hair_points));
    if (const double hairs = hairs_on_a_ray(ball); hairs > max_hairs_on_a_ray)
        refuse(where + "/radius", fmt::format("a ray would cross about {:.0f} hairs; the limit is {}: this is the "
                                              "half-width of one hair, and \"ball_radius\" is that of the ball",
                                              hairs, max_hairs_on_a_ray));
    return {with_length(make_hair_ball(ball))};
}

Loaded volume(const json& from, const SearchPath& path, const std::string& where) {
    return {load_volume(from, path, where)};
}

Loaded cloud(const json& from, const SearchPath&, const std::string& where) {
    return {load_cloud(from, where)};
}

Loaded density_box(const json& from, const SearchPath&, const std::string& where) {
    return {load_density_box(from, where)};
}

Loaded crossed_rods(const json& from, const SearchPath&, const std::string& where) {
    return {load_crossed_rods(from, where)};
}

Loaded smoke_column(const json& from, const SearchPath&, const std::string&) {
    SmokeColumn column;
    read(from, "particles", column.particles);
    read(from, "base", column.base);
    read(from, "height", column.height);
    read(from, "width", column.width);
    read(from, "puff_radius", column.puff_radius);
    read(from, "density", column.density);
    read(from, "seed", column.seed);
    return {make_smoke_column(column)};
}

// One row for each type of object; the schema's definition of the same name lists the keys.
struct Row {
    std::string_view type;
    Loaded (*load)(const json& from, const SearchPath& path, const std::string& where);
};
constexpr std::array rows{
    Row{"mesh", mesh},
    Row{"sphere", sphere},
    Row{"spheres", spheres},
    Row{"quad", quad},
    Row{"layers", layers},
    Row{"hair", hair},
    Row{"hair_ball", hair_ball},
    Row{"volume", volume},
    Row{"cloud", cloud},
    Row{"density_box", density_box},
    Row{"crossed_rods", crossed_rods},
    Row{"particles", particles},
    Row{"smoke_column", smoke_column},
};

// Says why light can never meet a shape; empty if it can.
const char* emptiness(const Mesh& shape) {
    return shape.triangles.empty() ? "the mesh has no triangles" : "";
}
const char* emptiness(const Spheres& shape) {
    return shape.centres.empty() ? "there are no spheres" : "";
}
const char* emptiness(const Particles& shape) {
    return shape.centres.empty() ? "there are no particles" : "";
}

const char* emptiness(const Hair& shape) {
    if (shape.strand_begin.size() < 2) return "there are no strands that have a length";
    const bool wide = std::any_of(shape.radii.begin(), shape.radii.end(), [](float radius) { return radius > 0.0f; });
    return wide ? "" : "every strand has zero width; give a radius";
}

const char* emptiness(const GridVolume& shape) {
    const bool dense = std::any_of(shape.density.begin(), shape.density.end(), [](float d) { return d > 0.0f; });
    return dense ? "" : "the density is 0 everywhere";
}

}  // namespace

Object load_object(const json& from, std::size_t index, const SearchPath& path, const std::string& where) {
    Object object;
    const std::string type = from["type"].get<std::string>();
    object.name = fmt::format("{}_{}", type, index);
    read(from, "name", object.name);
    read(from, "casts_shadow", object.casts_shadow);
    read(from, "opacity", object.opacity);
    read(from, "extinction", object.extinction);
    read(from, "motion", object.motion);
    const auto row = std::find_if(rows.begin(), rows.end(), [&](const Row& each) { return each.type == type; });
    if (row == rows.end()) refuse(where + "/type", fmt::format("no object has type \"{}\"", type));
    try {
        Loaded loaded = row->load(from, path, where);
        object.shape = std::move(loaded.shape);
        object.passed_over = std::move(loaded.passed_over);
    } catch (const base::Error& error) {
        if (error.where().starts_with(where)) throw;
        // The fault is in the object's file: name the scenario's place first, then the file's.
        throw base::Error(error.code(), from.contains("file") ? where + "/file" : where, error.what());
    }
    if (const auto transform = load_transform(from, where)) apply(*transform, object, where);
    if (auto* grid = std::get_if<GridVolume>(&object.shape)) read_step(from, where, *grid);
    const std::string empty = std::visit([](const auto& shape) { return std::string(emptiness(shape)); }, object.shape);
    if (!empty.empty()) refuse(where, empty);
    return object;
}

}  // namespace shadowbench::scene
