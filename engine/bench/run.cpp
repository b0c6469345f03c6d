#include "bench/run.h"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/hash_text.h"
#include "base/parallel.h"
#include "base/utc.h"
#include "bench/clock.h"
#include "bench/estimate.h"
#include "bench/light_run.h"
#include "bench/load.h"
#include "bench/prepared_light.h"
#include "bench/queries.h"
#include "document/document.h"
#include "rays/capture.h"
#include "results/machine.h"
#include "results/program.h"

namespace shadowbench::bench {
namespace {

std::vector<document::Variant> variants_of(const nlohmann::json& document, const RunOptions& options) {
    std::vector<document::Variant> variants = document::expand(document);
    for (document::Variant& variant : variants) document::keep_only(variant, options.only);
    return variants;
}

// "2/5 key" if there are several variants or lights.
std::string place_of(std::size_t variant, std::size_t variants, const scene::Scenario& scenario, std::size_t light) {
    std::string place = variants > 1 ? fmt::format("{}/{}", variant + 1, variants) : "";
    if (scenario.lights.size() > 1) place += (place.empty() ? "" : " ") + scenario.lights[light].name;
    return place;
}

// Shared by all lights of a variant: Embree's trees and the camera's receivers.
struct Shared {
    std::unique_ptr<rays::Tracer> casters;
    std::vector<CameraPoint> seen;
};

Shared prepare(const scene::Scenario& scenario) {
    Shared shared;
    if (scenario.scene.objects.empty()) return shared;
    shared.casters = std::make_unique<rays::Tracer>(scenario.scene, true);
    if (scenario.receivers.camera) shared.seen = camera_points(scenario.receivers, rays::Tracer(scenario.scene, false));
    return shared;
}

// Adds the notes of the file readers that are not there yet: variants may share a scene.
void add_notes(const scene::Scene& scene, std::vector<std::string>& notes) {
    for (std::string& note : scene::read_notes(scene))
        if (std::count(notes.begin(), notes.end(), note) == 0) notes.push_back(std::move(note));
}

void add_cost(const scene::Scenario& scenario, const PreparedLight& light, std::size_t techniques,
              Validated& validated) {
    const rays::MapLayout& layout = light.layout;
    validated.largest_side = std::max({validated.largest_side, layout.width, layout.height});
    validated.most_samples = std::max({validated.most_samples, layout.samples(), scenario.reference.samples_per_pixel});
    validated.least_bytes = std::max(validated.least_bytes, light.least_bytes);
    validated.seconds += estimate_seconds(scenario, layout, techniques);
}

}  // namespace

results::Result run(const nlohmann::json& document, const RunOptions& options, const ProgressCallback& progress) {
    const base::ThreadLimit threads(options.threads);
    const Stopwatch stopwatch;
    results::Result result;
    result.times.started = base::now_utc();
    result.times.threads = base::thread_count();
    result.program = results::this_program();
    result.machine = results::this_machine();
    const std::vector<document::Variant> variants = variants_of(document, options);
    result.name = document.at("name").get<std::string>();
    result.purpose = document.value("purpose", "");
    result.document = document.dump();
    result.hash = base::hash_text(result.document);
    result.only = options.only;

    ScenarioLoader loader(options.data);
    for (std::size_t v = 0; v < variants.size(); ++v) {
        const scene::Scenario& scenario = loader.load(variants[v]);
        add_notes(scenario.scene, result.notes);
        const std::vector<Contender> contenders = make_contenders(scenario, variants[v]);
        const Shared shared = prepare(scenario);
        results::VariantResult& out = result.variants.emplace_back();
        out.settings = variants[v].settings;
        for (std::size_t l = 0; l < scenario.lights.size(); ++l) {
            StageWatch watch;
            if (progress)
                watch = [&, place = place_of(v, variants.size(), scenario, l)](const char* stage, std::size_t done,
                                                                               std::size_t total) {
                    progress({place, stage, done, total});
                };
            std::vector<Contender> fresh;
            for (const Contender& c : contenders) fresh.push_back(unbuilt(c));
            out.lights.push_back(
                run_light({scenario, l, shared.casters.get(), shared.seen, options.limits, watch, options.times},
                          std::move(fresh)));
        }
    }
    result.times.seconds = stopwatch.seconds();
    return result;
}

Validated validate(const nlohmann::json& document, const RunOptions& options) {
    const base::ThreadLimit threads(options.threads);
    Validated validated;
    ScenarioLoader loader(options.data);
    for (const document::Variant& variant : variants_of(document, options)) {
        const scene::Scenario& scenario = loader.load(variant);
        const std::vector<Contender> contenders = make_contenders(scenario, variant);
        add_notes(scenario.scene, validated.notes);
        for (std::size_t l = 0; l < scenario.lights.size(); ++l) {
            const PreparedLight light = prepare_light(scenario, l, contenders, options.limits);
            const std::string& name = scenario.lights[l].name;
            const bool known = std::count(validated.blind.begin(), validated.blind.end(), name) > 0;
            if (!known && rays::misses_all(light.view, scenario.scene)) validated.blind.push_back(name);
            add_cost(scenario, light, contenders.size(), validated);
            if (scenario.scene.deep_image) check_served(contenders, {light.layout, light.view, nullptr});
        }
        if (validated.variants++ > 0) continue;
        validated.name = scenario.name;
        validated.lights = scenario.lights.size();
        validated.techniques = contenders.size();
    }
    return validated;
}

}  // namespace shadowbench::bench
