// What Trials measured, as a result.
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/hash_text.h"
#include "bench/light_report.h"
#include "bench/verdict.h"
#include "recommend/trials.h"
#include "results/machine.h"
#include "results/program.h"
#include "scene/file_lines.h"
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
    results::LightResult light = bench::describe_light(*scenario_, *light_, layout, all_);
    bench::report_capture(*rays.source, rays.setup_seconds, light);
    light.reference = bench::report_reference(layout, judged_.queries, truth_);
    return recorded_.emplace_back(choice(setting, 0), std::move(light)).second;
}

const results::Cell& Trials::keep(results::LightResult& light, const Contender& contender) const {
    results::Cell cell = contender.cell;
    bench::judge(cell, contender.promises, light.reference.noise_tolerance);
    return put_cell(light, std::move(cell));
}

// A later measurement of the same setting takes the place of the earlier one.
const results::Cell& Trials::put_cell(results::LightResult& light, results::Cell cell) {
    for (results::Cell& other : light.cells)
        if (other.technique == cell.technique && other.parameters_json == cell.parameters_json)
            return other = std::move(cell);
    return light.cells.emplace_back(std::move(cell));
}

results::VariantResult Trials::variant_of(const bench::RayChoice& rays, results::LightResult light) {
    const base::Vec2i sides = rays.resolution;
    results::VariantResult variant;
    variant.settings = {{"/rays/resolution",
                         sides.x == sides.y ? fmt::format("{}", sides.x) : fmt::format("[{},{}]", sides.x, sides.y)},
                        {"/rays/samples_per_pixel", fmt::format("{}", rays.samples)}};
    variant.lights.push_back(std::move(light));
    return variant;
}

results::Result Trials::result_without_variants() const {
    results::Result result;
    const nlohmann::json document = nlohmann::json::parse(document_);
    result.name = document.at("name").get<std::string>();
    result.purpose = document.value("purpose", "");
    result.notes = scene::notes(*scenario_);
    result.files = scene::file_lines(document, scenario_->scene);
    result.document = document_;
    result.hash = base::hash_text(document_);
    result.only = options_.only;
    result.program = results::this_program();
    result.machine = results::this_machine();
    result.times = times_;
    result.times.seconds = seconds_;
    result.times.threads = base::thread_count();
    return result;
}

results::Result Trials::result() const {
    results::Result result = result_without_variants();
    for (const auto& [rays, light] : recorded_) result.variants.push_back(variant_of(rays, light));
    return result;
}

}  // namespace shadowbench::recommend
