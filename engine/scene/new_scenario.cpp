#include "scene/new_scenario.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <utility>
#include <variant>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/utf8.h"
#include "scene/limits.h"

namespace shadowbench::scene {
namespace {

using base::Error;
using base::ErrorCode;
using nlohmann::ordered_json;

constexpr double optical_depth = 2.0;  // of a volume: see densest_column()
constexpr double hair_opacity = 0.6;
constexpr int surface_rays = 16, media_rays = 4;  // a pixel

ordered_json number(double value) {
    if (value == std::floor(value) && std::abs(value) < 1e15) return static_cast<std::int64_t>(value);
    return value;
}

ordered_json point(const Vec3d& p) {
    return ordered_json::array({number(p.x), number(p.y), number(p.z)});
}

ordered_json point(const Vec3i& p) {
    return ordered_json::array({p.x, p.y, p.z});
}

// The text as the name of a scenario, and so of an object: see the schema.
std::string as_name(const std::string& text) {
    constexpr std::size_t longest = 64;
    std::string name = text.substr(0, longest);
    for (char& c : name) {
        const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
        if (!letter && c != '.' && c != '-') c = '_';
    }
    if (name.empty()) return "_";
    if (name[0] == '.' || name[0] == '-') name[0] = '_';
    return name;
}

void put_choice(ordered_json& object, const char* key, const std::variant<std::monostate, std::string, int>& choice) {
    if (const auto* name = std::get_if<std::string>(&choice)) object[key] = *name;
    if (const auto* position = std::get_if<int>(&choice)) object[key] = *position;
}

void put_volume(ordered_json& object, const DataFile& data, const GridVolume& volume) {
    put_choice(object, "grid", data.choice.grid);
    if (!data.raw_type.empty()) {
        object["format"] = data.raw_type;
        object["size"] = point(volume.size);
    }
    if (data.no_box) {
        object["lower"] = point(volume.lower);
        object["upper"] = point(volume.upper);
    }
    if (const double column = densest_column(volume); column > 0.0)
        object["extinction"] = number(std::min(to_digits(optical_depth / column, 2), max_coordinate));
}

void put_points(ordered_json& object, const DataFile& data, const Particles& points) {
    if (points.radii.empty()) return;
    double column = 0.0;  // through the middle of all points together
    for (std::size_t i = 0; i < points.radii.size(); ++i)
        column += 2.0 * static_cast<double>(points.radii[i]) * static_cast<double>(points.density[i]);
    column /= static_cast<double>(points.radii.size());
    if (data.guessed_radius) object["radius"] = number(to_digits(static_cast<double>(points.radii[0]), 1));
    if (column > 0.0) object["extinction"] = number(std::min(to_digits(optical_depth / column, 2), max_coordinate));
}

void put_quad(ordered_json& object, const Mesh& quad) {
    const double width = to_digits(2.0 * static_cast<double>(quad.positions[1].x), 4);
    object["corner"] = point(Vec3d(-0.5 * width, 0, 0));
    object["edge_u"] = point(Vec3d(width, 0, 0));
    object["edge_v"] = point(Vec3d(0, 1, 0));
}

std::string_view type_of(const Object& object) {
    if (std::holds_alternative<Hair>(object.shape)) return "hair";
    if (std::holds_alternative<GridVolume>(object.shape)) return "volume";
    if (std::holds_alternative<Particles>(object.shape)) return "particles";
    return "mesh";
}

// By its name or, if several have that, by its number.
void put_medium(ordered_json& object, const DataFile& data, const Object& medium) {
    int number = 0, same = 0, before = 0;
    for (const Object& each : data.scene.objects) {
        if (!std::holds_alternative<GridVolume>(each.shape)) continue;
        if (&each == &medium) number = before;
        ++before;
        same += each.name == medium.name;
    }
    if (same == 1)
        object["grid"] = medium.name;
    else
        object["grid"] = number;
}

// One of several objects of a file is named by its type too, and a medium by its own name.
ordered_json object_of(const DataFile& data, const Object& from, const std::string& name) {
    const bool several = data.format->loader == several_objects;
    const std::string_view type = several ? type_of(from) : data.format->loader;
    std::string own = data.file.stem().string();
    if (several) own += fmt::format("_{}", from.name.empty() ? type : from.name);
    ordered_json object{{"type", std::string(type)}, {"name", as_name(own)}};
    const bool texture = data.format->loader == "quad";
    object[texture ? "alpha_texture" : "file"] = name;
    if (texture) put_quad(object, std::get<Mesh>(from.shape));
    if (const auto* volume = std::get_if<GridVolume>(&from.shape)) {
        if (several)
            put_medium(object, data, from);
        else
            put_volume(object, data, *volume);
    }
    if (const auto* points = std::get_if<Particles>(&from.shape); points && !several) put_points(object, data, *points);
    if (const auto* hair = std::get_if<Hair>(&from.shape)) {
        if (data.guessed_radius && !hair->radii.empty())
            object["radius"] = number(to_digits(static_cast<double>(hair->radii[0]), 1));
        object["opacity"] = hair_opacity;
    }
    return object;
}

ordered_json deep_object(const DataFile& data, const std::string& name) {
    ordered_json object{{"file", name}};
    if (data.choice.deep.layer) object["layer"] = *data.choice.deep.layer;
    put_choice(object, "part", data.choice.deep.part);
    return object;
}

[[noreturn]] void refuse_file(const DataFile& data, const std::string& message) {
    throw Error(ErrorCode::bad_input, data.file.string(), message);
}

bool has_only_points(const DataFile& data) {
    if (data.scene.deep_image || !data.scene.objects[0].passed_over.empty()) return false;
    const auto* mesh = std::get_if<Mesh>(&data.scene.objects[0].shape);
    return mesh && !mesh->positions.empty() && mesh->triangles.empty();
}

void check_shadow(const DataFile& data) {
    if (has_only_points(data))
        refuse_file(data,
                    "a point cloud, which has no faces and so casts no shadow; write it as PLY, whose points are read "
                    "as particles, or put its points into a scenario as the centres of an object of type spheres");
    if (casts_shadow(data)) return;
    std::string message = "nothing in it casts a shadow";
    for (const Object& object : data.scene.objects)
        for (const PassedOver& each : object.passed_over)
            message += fmt::format("; passed over: {} ({})", each.what, each.count);
    refuse_file(data, message);
}

// Far from the limits of a scenario, which the ground and the camera must also keep.
void check_bounds(const DataFile& data) {
    const Box3d box = bounds(data);
    const double size = box.size().length();
    double farthest = 0.0;
    for (int axis = 0; axis < 3; ++axis)
        farthest = std::max({farthest, std::abs(box.min[axis]), std::abs(box.max[axis])});
    if (farthest > 1e-3 * max_coordinate || !(size >= 1e4 * min_length))
        refuse_file(data, fmt::format("its box is {:.3g} long and reaches {:.3g} from the origin; {:.0e} at least and "
                                      "{:.0e} at most leave room for a ground and a camera: scale it",
                                      size, farthest, 1e4 * min_length, 1e-3 * max_coordinate));
}

bool takes_texture(const DataFile& data) {
    const auto* mesh = std::get_if<Mesh>(&data.scene.objects[0].shape);
    return mesh && !mesh->alpha && !mesh->corner_uv.empty();
}

// Map pixels a side for a volume, a power of two: about four pixels a voxel, but few enough for 2e8 steps in all.
int map_side(const GridVolume& volume) {
    const int longest = std::max({volume.size.x, volume.size.y, volume.size.z});
    const double most = std::sqrt(2e8 / (media_rays * 2.0 * longest));  // 2 steps a voxel
    return static_cast<int>(
        std::bit_floor(static_cast<unsigned>(std::clamp(std::min(4.0 * longest, most), 64.0, 256.0))));
}

// For hair, a mesh or points.
int map_side(std::size_t primitives) {
    return primitives > 10'000 ? 512 : 256;
}

std::vector<const Object*> objects_of(std::span<const DataFile> files) {
    std::vector<const Object*> objects;
    for (const DataFile& data : files)
        for (const Object& object : data.scene.objects) objects.push_back(&object);
    return objects;
}

ordered_json rays_for(std::span<const DataFile> files) {
    int volume_side = 0, surface_side = 0;
    for (const Object* object : objects_of(files)) {
        const auto& shape = object->shape;
        if (const auto* volume = std::get_if<GridVolume>(&shape))
            volume_side = volume_side == 0 ? map_side(*volume) : std::min(volume_side, map_side(*volume));
        if (const auto* hair = std::get_if<Hair>(&shape))
            surface_side = std::max(surface_side, map_side(hair->points.size()));
        if (const auto* mesh = std::get_if<Mesh>(&shape))
            surface_side = std::max(surface_side, map_side(mesh->triangles.size()));
        if (const auto* points = std::get_if<Particles>(&shape))
            surface_side = std::max(surface_side, map_side(points->centres.size()));
    }
    if (volume_side > 0) return {{"resolution", volume_side}, {"samples_per_pixel", media_rays}};
    return {{"resolution", surface_side}, {"samples_per_pixel", surface_rays}};
}

bool any_media(std::span<const DataFile> files) {
    const std::vector<const Object*> objects = objects_of(files);
    return std::any_of(objects.begin(), objects.end(), [](const Object* object) {
        return std::holds_alternative<GridVolume>(object->shape) || std::holds_alternative<Particles>(object->shape);
    });
}

ordered_json ground_quad(const Stage& stage) {
    return {{"type", "quad"},
            {"name", "ground"},
            {"corner", point(stage.ground_corner)},
            {"edge_u", point(stage.ground_u)},
            {"edge_v", point(stage.ground_v)},
            {"casts_shadow", false}};
}

bool any_mesh(std::span<const DataFile> files) {
    const std::vector<const Object*> objects = objects_of(files);
    return std::any_of(objects.begin(), objects.end(),
                       [](const Object* object) { return std::holds_alternative<Mesh>(object->shape); });
}

// A surface shadows itself where its depth changes over a map pixel.
ordered_json camera_of(const Stage& stage, bool media, bool surfaces) {
    ordered_json camera{
        {"type", "camera"}, {"position", point(stage.camera.position)}, {"target", point(stage.camera.target)}};
    if (stage.camera.up != Vec3d(0, 1, 0)) camera["up"] = point(stage.camera.up);
    camera["resolution"] = {picture_width, picture_height};
    if (media) camera["media_lookups"] = 32;
    camera["bias"] = number(stage.bias);
    if (surfaces) camera["slope_bias"] = 1;
    return camera;
}

ordered_json deep_scenario(const DataFile& data, const std::string& name) {
    return {{"scene", {{"deep_image", deep_object(data, name)}}}, {"receivers", {{"type", "probes"}}}};
}

// Everything but a name and techniques.
ordered_json object_scenario(std::span<const DataFile> files, std::span<const std::string> names, UpAxis up) {
    Box3d box;
    ordered_json objects = ordered_json::array();
    bool waits = false;  // whether the last object is a mesh that takes a texture
    for (std::size_t i = 0; i < files.size(); ++i) {
        std::vector<ordered_json> made = scene_objects(files[i], names[i]);
        if (waits && made[0].contains("alpha_texture")) {
            objects.back()["alpha_texture"] = made[0]["alpha_texture"];
            waits = false;
            continue;
        }
        check_bounds(files[i]);
        box.extendBy(bounds(files[i]));
        for (ordered_json& object : made) objects.push_back(std::move(object));
        waits = takes_texture(files[i]);
    }
    const Stage stage = stage_around(box, up);
    objects.push_back(ground_quad(stage));
    const ordered_json sun{{"type", "directional"}, {"name", "sun"}, {"direction", point(stage.light)}};
    return {{"scene", {{"objects", std::move(objects)}}},
            {"lights", ordered_json::array({sun})},
            {"rays", rays_for(files)},
            {"receivers", camera_of(stage, any_media(files), any_mesh(files))}};
}

}  // namespace

std::vector<ordered_json> scene_objects(const DataFile& data, const std::string& name) {
    if (data.scene.deep_image) return {deep_object(data, name)};
    std::vector<ordered_json> made;
    for (const Object& object : data.scene.objects)
        if (casts_shadow(object)) made.push_back(object_of(data, object, name));
    return made;
}

bool is_opaque(std::span<const DataFile> files) {
    if (std::any_of(files.begin(), files.end(), [](const DataFile& data) { return data.scene.deep_image.has_value(); }))
        return false;
    const std::vector<const Object*> objects = objects_of(files);
    return std::all_of(objects.begin(), objects.end(), [](const Object* object) {
        const auto* mesh = std::get_if<Mesh>(&object->shape);
        return mesh && !mesh->alpha;
    });
}

ordered_json new_scenario(std::span<const DataFile> files, std::span<const std::string> names,
                          std::span<const std::string_view> techniques, UpAxis up) {
    for (std::size_t i = 0; i < files.size(); ++i) {
        if (!base::is_utf8(names[i])) refuse_file(files[i], "its name is not UTF-8, as a scenario is: rename it");
        if (files[i].scene.deep_image && files.size() > 1)
            throw Error(ErrorCode::usage, files[i].file.string(),
                        "a deep image is a scene of its own: name no other file with it");
        check_shadow(files[i]);
    }
    const bool deep = files[0].scene.deep_image.has_value();
    ordered_json scenario{{"name", as_name(files[0].file.stem().string())},
                          {"purpose", "Made by shadowbench new, to start from."}};
    scenario.update(deep ? deep_scenario(files[0], names[0]) : object_scenario(files, names, up));
    ordered_json& list = scenario["techniques"] = ordered_json::array();
    for (const std::string_view type : techniques) list.push_back(ordered_json{{"type", std::string(type)}});
    return scenario;
}

}  // namespace shadowbench::scene
