#include <algorithm>
#include <cstdint>
#include <variant>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scene/json_read.h"
#include "scene/limits.h"
#include "scene/load.h"
#include "scene/readers/files.h"

namespace shadowbench::scene {
namespace {

// The object under a key, or an empty one.
const json& section(const json& document, const char* key) {
    static const json none = json::object();
    const auto found = document.find(key);
    return found == document.end() ? none : *found;
}

double bytes_of(const Mesh& mesh) {
    return 12.0 * static_cast<double>(mesh.positions.size() + mesh.triangles.size()) +
           8.0 * static_cast<double>(mesh.corner_uv.size()) +
           (mesh.alpha ? 4.0 * static_cast<double>(mesh.alpha->alpha.size()) : 0.0);
}
double bytes_of(const Spheres& spheres) {
    return 16.0 * static_cast<double>(spheres.centres.size());
}
double bytes_of(const Hair& hair) {
    return 16.0 * static_cast<double>(hair.points.size());
}
double bytes_of(const GridVolume& volume) {
    return 4.0 * static_cast<double>(volume.density.size());
}
double bytes_of(const Particles& particles) {
    return 20.0 * static_cast<double>(particles.centres.size());
}

// The number of parts into which the volumes cut a ray that crosses all of them.
double parts_of_ray(const Scene& scene, Media media) {
    double parts = 0.0;
    for (const Object& object : scene.objects)
        if (const auto* volume = std::get_if<GridVolume>(&object.shape); volume && object.casts_shadow)
            parts += media == Media::cells ? static_cast<double>(volume->size.x) + volume->size.y + volume->size.z
                                           : longest_way(*volume) / volume->step;
    return parts;
}

void check_marching(const Scene& scene, const char* where, Media media, double rays) {
    const double parts = parts_of_ray(scene, media);
    if (parts * rays <= max_all_march_steps) return;
    const char* name = media == Media::cells ? "cells" : "steps";
    refuse(where, fmt::format("{:.3g} rays of up to {:.3g} {} through volumes; the limit is {:.3g} {} in all: ask for "
                              "fewer rays or give the volumes {}",
                              rays, parts, name, max_all_march_steps, name,
                              media == Media::cells ? "fewer voxels" : "a larger step"));
}

void load_objects(const json& objects, const SearchPath& path, const LoadWatch& watch, Scene& scene) {
    double bytes = 0.0;
    for (std::size_t i = 0; i < objects.size(); ++i) {
        if (watch) watch(i, objects.size());
        const std::string where = fmt::format("/scene/objects/{}", i);
        scene.objects.push_back(load_object(objects[i], i, path, where));
        bytes += std::visit([](const auto& shape) { return bytes_of(shape); }, scene.objects.back().shape);
        if (bytes > max_scene_bytes)
            refuse(where, fmt::format("the objects up to this one take {:.3g} bytes; the limit is {:.3g}: make them "
                                      "coarser or fewer",
                                      bytes, max_scene_bytes));
    }
    if (std::none_of(scene.objects.begin(), scene.objects.end(), [](const Object& o) { return o.casts_shadow; }))
        refuse("/scene/objects", "no object casts a shadow; set casts_shadow to true for at least one");
}

void check_kind(const json& from) {
    if (from.contains("objects") == from.contains("deep_image"))
        refuse("/scene", from.empty() ? "the scene is empty: give objects, or a deep_image"
                                      : "a scene has objects or a deep_image, not both");
}

DeepChoice deep_choice(const json& from) {
    DeepChoice choice;
    if (const auto layer = from.find("layer"); layer != from.end()) choice.layer = layer->get<std::string>();
    if (const auto part = from.find("part"); part != from.end()) {
        if (part->is_string())
            choice.part = part->get<std::string>();
        else
            choice.part = part->get<int>();
    }
    return choice;
}

DeepImage load_deep_image(const json& from, const SearchPath& path) {
    const std::string where = "/scene/deep_image/file";
    const std::filesystem::path file = find_file(path, from["file"].get<std::string>(), where);
    DeepImage image;
    try {
        image = read_deep_image(file, deep_choice(from));
    } catch (const base::Error& error) {
        throw base::Error(error.code(), where, error.what());
    }
    if (image.z_front.empty()) refuse(where, "the deep image has no samples");
    std::size_t sample = 0;
    while (sample < image.z_front.size() && behind_everything(image, sample)) ++sample;
    if (sample == image.z_front.size())
        refuse(where, "all samples of the deep image are at infinity, so nothing casts a shadow");
    return image;
}

Scene load_scene(const json& from, const SearchPath& path, const LoadWatch& watch) {
    Scene scene;
    if (from.contains("objects")) {
        load_objects(from["objects"], path, watch, scene);
        if (watch) watch(scene.objects.size(), scene.objects.size());
        return scene;
    }
    if (watch) watch(0, 1);
    scene.deep_image = load_deep_image(from["deep_image"], path);
    if (watch) watch(1, 1);
    return scene;
}

constexpr const char* deep_image_name = "deep_image";

Light deep_image_light() {
    Light light;
    light.name = deep_image_name;
    light.where = "/scene/deep_image";
    light.type = LightType::deep_image;
    light.direction = Vec3d(0, 0, 1);
    return light;
}

RaySettings load_rays(const json& from) {
    RaySettings rays;
    read(from, "resolution", rays.resolution);
    read(from, "samples_per_pixel", rays.samples_per_pixel);
    std::string pattern = rays.pattern == Pattern::regular ? "regular" : "jittered";
    read(from, "pattern", pattern);
    rays.pattern = pattern == "regular" ? Pattern::regular : Pattern::jittered;
    std::string media = rays.media == Media::cells ? "cells" : "steps";
    read(from, "media", media);
    rays.media = media == "cells" ? Media::cells : Media::steps;
    read(from, "seed", rays.seed);
    const auto total = static_cast<std::uint64_t>(rays.resolution.x) * static_cast<std::uint64_t>(rays.resolution.y) *
                       static_cast<std::uint64_t>(rays.samples_per_pixel);
    if (total > max_light_rays)
        refuse("/rays",
               fmt::format("{} x {} pixels of {} samples are {} light rays; the limit is {}", rays.resolution.x,
                           rays.resolution.y, rays.samples_per_pixel, total, max_light_rays));
    return rays;
}

Reference load_reference(const json& from) {
    Reference reference;
    read(from, "samples_per_pixel", reference.samples_per_pixel);
    read(from, "queries", reference.queries);
    read(from, "spread_seeds", reference.spread_seeds);
    read(from, "seed", reference.seed);
    const auto rays =
        static_cast<std::uint64_t>(reference.queries) * static_cast<std::uint64_t>(reference.samples_per_pixel);
    if (rays > max_reference_rays)
        refuse("/reference", fmt::format("{} queries of {} samples; the limit is {} rays", reference.queries,
                                         reference.samples_per_pixel, max_reference_rays));
    return reference;
}

constexpr int least_open_repetitions = 5;  // fewer fix the number: no interval of theirs can be judged

Timing load_timing(const json& from) {
    Timing timing;
    read(from, "repetitions", timing.repetitions);
    const bool few = timing.repetitions < least_open_repetitions;
    timing.most_repetitions = few ? timing.repetitions : std::max(timing.repetitions, timing.most_repetitions);
    read(from, "most_repetitions", timing.most_repetitions);
    if (timing.most_repetitions < timing.repetitions)
        refuse("/timing/most_repetitions", fmt::format("must be at least repetitions, {}", timing.repetitions));
    read(from, "goal", timing.goal);
    read(from, "seconds", timing.seconds);
    read(from, "lookups", timing.lookups);
    return timing;
}

std::vector<TechniqueRequest> load_techniques(const json& list) {
    std::vector<TechniqueRequest> techniques;
    for (std::size_t i = 0; i < list.size(); ++i) {
        json parameters = list[i];
        parameters.erase("type");
        techniques.push_back({list[i]["type"].get<std::string>(), parameters.dump(), fmt::format("/techniques/{}", i)});
    }
    return techniques;
}

}  // namespace

FilterWidth lookup_width(const json& document, const std::string& light) {
    std::size_t index = 0;
    for (const json& each : section(document, "lights")) {
        const std::vector<std::string> maps = map_names(each, index++);
        if (std::count(maps.begin(), maps.end(), light) > 0 && each.contains("softness"))
            return footprint_width(each.at("softness"));
    }
    return load_filter_width(section(document, "receivers"));
}

std::vector<std::string> light_names(const json& document) {
    if (document["scene"].contains("deep_image")) return {deep_image_name};
    std::vector<std::string> names;
    std::size_t index = 0;
    for (const json& light : section(document, "lights"))
        for (std::string& name : map_names(light, index++)) names.push_back(std::move(name));
    return names;
}

void check_marching(const Scenario& scenario) {
    const RaySettings& rays = scenario.rays;
    check_marching(scenario.scene, "/rays", rays.media,
                   static_cast<double>(rays.resolution.x) * rays.resolution.y * rays.samples_per_pixel);
    check_marching(scenario.scene, "/reference", Media::cells,
                   static_cast<double>(scenario.reference.queries) * scenario.reference.samples_per_pixel);
}

Scenario load_scenario(const json& document, const SearchPath& path, const LoadWatch& watch) {
    check_schema(document, scenario_schema());
    Scenario scenario;
    read(document, "name", scenario.name);
    read(document, "purpose", scenario.purpose);
    // Check the settings first: this finds their faults and limits before files are read.
    scenario.rays = load_rays(section(document, "rays"));
    scenario.receivers = load_receivers(section(document, "receivers"));
    scenario.reference = load_reference(section(document, "reference"));
    scenario.timing = load_timing(section(document, "timing"));
    scenario.techniques = load_techniques(section(document, "techniques"));
    check_kind(document["scene"]);
    const bool deep = document["scene"].contains("deep_image");
    if (deep && (scenario.receivers.camera || !scenario.receivers.points.empty()))
        refuse("/receivers/type", "a deep image has no world space for a camera or points; use probes");
    if (deep && !section(document, "lights").empty()) refuse("/lights", "a deep image is its own light; remove lights");
    if (!deep && section(document, "lights").empty()) refuse("/lights", "at least one light is needed");

    scenario.scene = load_scene(document["scene"], path, watch);
    if (deep) {
        const DeepImage& image = *scenario.scene.deep_image;
        scenario.lights = {deep_image_light()};
        scenario.rays.resolution = Vec2i(image.width, image.height);
        scenario.rays.samples_per_pixel = 1;
        scenario.rays.pattern = Pattern::regular;
    } else {
        check_marching(scenario);
        load_lights(document["lights"], scenario);
    }
    return scenario;
}

}  // namespace shadowbench::scene
