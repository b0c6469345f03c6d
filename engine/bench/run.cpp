#include "bench/run.h"

#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/parallel.h"
#include "bench/clock.h"
#include "bench/estimate.h"
#include "bench/load.h"
#include "bench/prepared_light.h"
#include "bench/variant_runs.h"
#include "document/document.h"
#include "rays/light_view.h"

namespace shadowbench::bench {
namespace {

void add_cost(const scene::Scenario& scenario, std::size_t index, const PreparedLight& light,
              std::span<const Contender> contenders, Validated& validated, std::vector<LightWork>& works) {
    const rays::MapLayout& layout = light.layout;
    validated.largest_side = std::max({validated.largest_side, layout.width, layout.height});
    validated.most_samples = std::max({validated.most_samples, layout.samples(), scenario.reference.samples_per_pixel});
    validated.least_bytes = std::max(validated.least_bytes, light.least_bytes);
    works.push_back(count_work(scenario, index, layout, light.view, contenders));
    validated.seconds += estimate_seconds(works.back(), scenario.timing, base::thread_count());
}

}  // namespace

results::Result run(const nlohmann::json& document, const RunOptions& options, const ProgressCallback& progress) {
    const base::ThreadLimit threads(options.threads);
    const Stopwatch stopwatch;
    VariantRuns runs(document, options);
    results::Result result = runs.describe();
    for (std::size_t v = 0; v < runs.variants().size(); ++v) {
        const scene::Scenario& scenario = runs.load(v, progress);
        add_notes(scenario, result.notes);
        add_files(runs.variants()[v], scenario.scene, result.files);
        results::VariantResult& out = result.variants.emplace_back();
        out.settings = runs.variants()[v].settings;
        for (std::size_t l = 0; l < scenario.lights.size(); ++l) out.lights.push_back(runs.measure(l, progress));
        add_missing(runs.seam_notes(), result.notes);
    }
    result.times.seconds = stopwatch.seconds();
    return result;
}

Validated validate(const nlohmann::json& document, const RunOptions& options, const ProgressCallback& progress,
                   const FirstVariant& first) {
    const base::ThreadLimit threads(options.threads);
    Validated validated;
    ScenarioLoader loader(options.data);
    for (const document::Variant& variant : variants_of(document, options.only)) {
        const scene::Scenario& scenario = loader.load(variant, load_watch("", progress));
        const std::vector<Contender> contenders = make_contenders(scenario, variant);
        add_notes(scenario, validated.notes);
        add_files(variant, scenario.scene, validated.files);
        std::vector<LightWork> works;
        for (std::size_t l = 0; l < scenario.lights.size(); ++l) {
            const PreparedLight light = prepare_light(scenario, l, contenders, options.limits);
            const std::string& name = scenario.lights[l].name;
            const bool known = std::count(validated.blind.begin(), validated.blind.end(), name) > 0;
            if (!known && rays::misses_all(light.view, scenario.scene)) validated.blind.push_back(name);
            add_cost(scenario, l, light, contenders, validated, works);
            if (scenario.scene.deep_image) check_served(contenders, {light.layout, light.view, nullptr});
        }
        validated.seconds +=
            estimate_reading(loader.file_bytes()) + estimate_preparing(scenario, base::thread_count());
        if (validated.variants++ > 0) continue;
        if (first) first({scenario, works, loader.file_bytes()});
        validated.name = scenario.name;
        validated.lights = scenario.lights.size();
        validated.techniques = contenders.size();
    }
    return validated;
}

}  // namespace shadowbench::bench
