// What Trials measured, as a result.
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/hash_text.h"
#include "bench/verdict.h"
#include "recommend/trials.h"
#include "results/machine.h"
#include "results/program.h"
#include "scene/scene.h"

namespace shadowbench::recommend {

using bench::Contender;
using bench::StoredRays;

results::LightResult* Trials::recorded(const Setting& setting) {
    const bench::RayChoice own = choice(setting, 0);
    for (auto& [rays, light] : recorded_)
        if (rays == own) return &light;
    return nullptr;
}

// The light of the variant with these rays.
results::LightResult& Trials::record(const Setting& setting, const StoredRays& rays) {
    if (results::LightResult* there = recorded(setting)) return *there;
    const rays::MapLayout& layout = rays.frame->layout;
    results::LightResult light;
    light.name = light_->name;
    light.layout = {layout.width, layout.height,   layout.samples_x, layout.samples_y, layout.jittered,
                    layout.seed,  layout.channels, layout.media,     layout.z_min,     layout.z_max};
    light.deep_image = scenario_->scene.deep_image.has_value();
    light.receivers = all_.queries.size();
    light.dropped = all_.dropped;
    light.rays = rays.source->rays();
    light.segments = rays.source->segments();
    light.ray_bytes = rays.source->bytes();
    light.kept = rays.source->kept();
    light.translucent = rays.source->translucent();
    light.times = {rays.source->seconds(), rays.setup_seconds,
                   static_cast<double>(rays.source->rays()) / rays.source->seconds()};
    light.reference.judged = judged_.queries.size();
    light.reference.samples_per_pixel = light.deep_image ? 1 : scenario_->reference.samples_per_pixel;
    light.reference.error_rms = truth_rms_;
    light.reference.error_max = truth_max_;
    light.reference.noise_tolerance = 0.5 / std::sqrt(static_cast<double>(layout.samples()));
    return recorded_.emplace_back(choice(setting, 0), std::move(light)).second;
}

// A later measurement of the same setting takes the place of the earlier one.
void Trials::keep(results::LightResult& light, const Contender& contender) const {
    results::Cell cell = contender.cell;
    bench::judge(cell, contender.promises, light.reference.noise_tolerance);
    for (results::Cell& other : light.cells)
        if (other.technique == cell.technique && other.parameters_json == cell.parameters_json) {
            other = std::move(cell);
            return;
        }
    light.cells.push_back(std::move(cell));
}

results::Result Trials::result() const {
    results::Result result;
    const nlohmann::json document = nlohmann::json::parse(document_);
    result.name = document.at("name").get<std::string>();
    result.purpose = document.value("purpose", "");
    result.notes = scene::read_notes(scenario_->scene);
    result.document = document_;
    result.hash = base::hash_text(document_);
    result.only = options_.only;
    result.program = results::this_program();
    result.machine = results::this_machine();
    result.times = {started_, seconds_, base::thread_count()};
    for (const auto& [rays, light] : recorded_) {
        results::VariantResult variant;
        const base::Vec2i sides = rays.resolution;
        variant.settings = {{"/rays/resolution", sides.x == sides.y ? fmt::format("{}", sides.x)
                                                                    : fmt::format("[{},{}]", sides.x, sides.y)},
                            {"/rays/samples_per_pixel", fmt::format("{}", rays.samples)}};
        variant.lights.push_back(light);
        result.variants.push_back(std::move(variant));
    }
    return result;
}

}  // namespace shadowbench::recommend
