#include "bench/load.h"

#include <utility>

#include <nlohmann/json.hpp>

#include "scene/file_lines.h"

namespace shadowbench::bench {
namespace {

using nlohmann::json;

bool same_part(const json& a, const json& b, const char* part) {
    return a.value(part, json()) == b.value(part, json());
}

// The same settings with a scene that costs nothing to load.
json without_scene(json document) {
    document["scene"] = {{"objects", {{{"type", "sphere"}, {"centre", {0, 0, 0}}, {"radius", 1}}}}};
    document["lights"] = {{{"type", "directional"}, {"direction", {0, -1, 0}}}};
    return document;
}

}  // namespace

ScenarioLoader::ScenarioLoader(scene::SearchPath data) : data_(std::move(data)) {}

const scene::Scenario& ScenarioLoader::load(const document::Variant& variant, const scene::LoadWatch& watch) {
    const json& document = *variant.document;
    // A deep image also sets the size of the map, so it is read again; it is small.
    const bool same_scene = loaded_ && !scenario_.scene.deep_image && same_part(*loaded_, document, "scene") &&
                            same_part(*loaded_, document, "lights");
    file_bytes_ = 0;
    if (same_scene) {
        scene::Scenario next = scene::load_scenario(without_scene(document), data_);
        next.scene = std::move(scenario_.scene);
        next.lights = std::move(scenario_.lights);
        next.fills = std::move(scenario_.fills);
        scenario_ = std::move(next);
        scene::check_marching(scenario_);
    } else {
        loaded_ = nullptr;
        scenario_ = {};  // frees the old scene before the new one is loaded
        scenario_ = scene::load_scenario(document, data_, watch);
        file_bytes_ = scene::file_bytes(document, data_);
    }
    loaded_ = variant.document;
    return scenario_;
}

std::vector<Contender> make_contenders(const scene::Scenario& scenario, const document::Variant& variant) {
    std::vector<Contender> contenders;
    for (std::size_t i = 0; i < scenario.techniques.size(); ++i)
        contenders.push_back(make_contender(scenario.techniques[i], variant.technique_where[i]));
    label(contenders, scenario.techniques, variant.swept);
    return contenders;
}

}  // namespace shadowbench::bench
