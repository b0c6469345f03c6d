#include "render/write_pictures.h"

#include <cctype>
#include <initializer_list>
#include <set>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/write_files.h"
#include "metrics/flip.h"
#include "render/exposure.h"
#include "render/heat_map.h"
#include "render/image_file.h"
#include "render/shading.h"
#include "results/program.h"
#include "results/write_result.h"

namespace shadowbench::render {
namespace {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

constexpr int difference_factor = 4;  // as in difference_times_four()
constexpr const char* extensions[] = {".exr", ".png"};

std::string file_label(const results::Cell& cell) {
    std::string label = results::title(cell);
    for (char& c : label)
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '.' && c != '=' && c != '-') c = '_';
    return label;
}

// One label per technique; equal labels are numbered.
std::vector<std::string> file_labels(const Rendering& rendering) {
    std::vector<std::string> labels;
    std::set<std::string> used{"reference"};
    for (const TechniquePictures& pictures : rendering.techniques) {
        const std::string label = file_label(pictures.cell);
        std::string unique = label;
        for (int n = 2; !used.insert(unique).second; ++n) unique = label + "_" + std::to_string(n);
        labels.push_back(unique);
    }
    return labels;
}

std::vector<std::string> names(const std::string& label, std::initializer_list<const char*> kinds) {
    std::vector<std::string> result;
    for (const char* kind : kinds)
        for (const char* extension : extensions) result.push_back(label + "." + kind + extension);
    return result;
}

constexpr std::initializer_list<const char*> light_kinds = {"through"};
constexpr std::initializer_list<const char*> reference_kinds = {"shaded", "shadow"};
constexpr std::initializer_list<const char*> technique_kinds = {"shaded", "shadow", "difference", "heat"};

json to_json(const PictureErrors& errors) {
    return {{"max", errors.max},
            {"rms", errors.rms},
            {"flip_mean", errors.flip_mean},
            {"flip_weighted_median", errors.flip_weighted_median},
            {"flip_max", errors.flip_max}};
}

json to_json(const base::Vec3d& v) {
    return {v.x, v.y, v.z};
}

json to_json(const TechniquePictures& pictures, const std::string& label) {
    const bool ok = pictures.cell.status == results::CellStatus::ok;
    return {{"technique", pictures.cell.technique},
            {"version", pictures.cell.version},
            {"parameters", json::parse(pictures.cell.parameters_json)},
            {"label", pictures.cell.parameters},
            {"where", pictures.cell.where},
            {"status", ok ? "ok" : "failed"},
            {"reason", pictures.cell.reason},
            {"outside_promise", pictures.cell.outside_promise},
            {"shaded", ok ? to_json(pictures.shaded) : json(nullptr)},
            {"shadow", ok ? to_json(pictures.shadow) : json(nullptr)},
            {"files", ok ? json(names(label, technique_kinds)) : json::array()}};
}

std::string light_label(std::size_t light) {
    return "light_" + std::to_string(light);
}

json shading_json() {
    return {{"surface_albedo", surface_albedo}, {"hair_diffuse", hair_diffuse},   {"hair_specular", hair_specular},
            {"hair_exponent", hair_exponent},   {"medium_albedo", medium_albedo}, {"falloff", "none"}};
}

}  // namespace

json to_json(const Rendering& rendering) {
    const results::Program build = results::this_program();
    json settings = json::object(), lights = json::array(), techniques = json::array();
    for (const document::Setting& s : rendering.settings) settings[s.pointer] = json::parse(s.value);
    for (std::size_t l = 0; l < rendering.lights.size(); ++l) {
        const LightMap& light = rendering.lights[l];
        lights.push_back({{"light", light.light},
                          {"map", {light.map.x, light.map.y}},
                          {"files", names(light_label(l), light_kinds)}});
    }
    const std::vector<std::string> labels = file_labels(rendering);
    for (std::size_t t = 0; t < labels.size(); ++t) techniques.push_back(to_json(rendering.techniques[t], labels[t]));
    return {{"schema_version", images_schema_version},
            {"name", rendering.name},
            {"scenario_hash", rendering.hash},
            {"settings", settings},
            {"version", build.version},
            {"commit", build.commit},
            {"resolution", {rendering.size.x, rendering.size.y}},
            {"camera",
             {{"position", to_json(rendering.camera.position)},
              {"target", to_json(rendering.camera.target)},
              {"up", to_json(rendering.camera.up)},
              {"fov", rendering.camera.fov},
              {"of_scenario", !rendering.default_camera}}},
            {"view_rays_per_pixel", rendering.rays_per_side * rendering.rays_per_side},
            {"joined_lookups", rendering.joined},
            {"exposure", exposure_of(rendering.reference.shaded, rendering.seen)},
            {"shading", shading_json()},
            {"lookups", rendering.points},
            {"reference",
             {{"samples_per_pixel", rendering.reference_samples},
              {"standard_error_rms", rendering.reference_standard_error},
              {"files", names("reference", reference_kinds)}}},
            {"flip_pixels_per_degree", metrics::flip_pixels_per_degree},
            {"heat_top", rendering.heat_top},
            {"difference_factor", difference_factor},
            {"lights", lights},
            {"techniques", techniques}};
}

void write_pictures(const fs::path& folder, const Rendering& rendering) {
    const std::vector<std::string> labels = file_labels(rendering);
    std::vector<base::NewFile> files;
    const auto add_both = [&](const std::string& name, const Image& values, const Image& shown) {
        files.push_back({folder / (name + ".exr"), encode_exr(values)});
        files.push_back({folder / (name + ".png"), encode_png(shown)});
    };
    const auto add = [&](const std::string& name, const Image& image) { add_both(name, image, image); };
    const double exposure = exposure_of(rendering.reference.shaded, rendering.seen);
    const auto add_shaded = [&](const std::string& label, const Image& image) {
        add_both(label + ".shaded", image, on_grey(image, rendering.seen, exposure));
    };
    for (std::size_t l = 0; l < rendering.lights.size(); ++l)
        add(light_label(l) + ".through", rendering.lights[l].through);
    add_shaded("reference", rendering.reference.shaded);
    add("reference.shadow", rendering.reference.shadow);
    for (std::size_t t = 0; t < labels.size(); ++t) {
        const TechniquePictures& pictures = rendering.techniques[t];
        if (pictures.cell.status == results::CellStatus::failed) continue;
        add_shaded(labels[t], pictures.picture.shaded);
        add(labels[t] + ".shadow", pictures.picture.shadow);
        add(labels[t] + ".difference", difference_times_four(pictures.picture.shaded, rendering.reference.shaded));
        add(labels[t] + ".heat", heat_map(pixel_errors(pictures.picture.shadow, rendering.reference.shadow),
                                          rendering.size.x, rendering.size.y, rendering.heat_top));
    }
    files.push_back({folder / "images.json", to_json(rendering).dump(1) + "\n"});
    base::write_files(files);
}

}  // namespace shadowbench::render
