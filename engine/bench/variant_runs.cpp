#include "bench/variant_runs.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/hash_text.h"
#include "base/parallel.h"
#include "bench/camera_points.h"
#include "bench/light_run.h"
#include "rays/light_view.h"
#include "results/machine.h"
#include "results/program.h"
#include "scene/file_lines.h"

namespace shadowbench::bench {
namespace {

// "2/5 key" if there are several variants or lights.
std::string place_of(std::size_t variant, std::size_t variants, const scene::Scenario& scenario, std::size_t light) {
    std::string place = variants > 1 ? fmt::format("{}/{}", variant + 1, variants) : "";
    if (scenario.lights.size() > 1) place += (place.empty() ? "" : " ") + scenario.lights[light].name;
    return place;
}

// Names the variant by the values that change its lookups; empty if there are none.
std::string lookups_of(const document::Variant& variant) {
    std::string text;
    for (const document::Setting& setting : variant.settings) {
        bool changes = true;
        for (const char* other : {"/techniques/", "/reference/", "/timing/"})
            changes = changes && !setting.pointer.starts_with(other);
        if (changes) text += fmt::format(", {} = {}", setting.pointer, setting.value);
    }
    return text;
}

}  // namespace

std::vector<document::Variant> variants_of(const nlohmann::json& document, const std::vector<std::string>& only) {
    std::vector<document::Variant> variants = document::expand(document);
    for (document::Variant& variant : variants) document::keep_only(variant, only);
    return variants;
}

void add_missing(std::vector<std::string> lines, std::vector<std::string>& to) {
    for (std::string& line : lines)
        if (std::count(to.begin(), to.end(), line) == 0) to.push_back(std::move(line));
}

void add_notes(const scene::Scenario& scenario, std::vector<std::string>& notes) {
    add_missing(scene::notes(scenario), notes);
}

void add_files(const document::Variant& variant, const scene::Scene& scene, std::vector<std::string>& files) {
    add_missing(scene::file_lines(*variant.document, scene), files);
}

scene::LoadWatch load_watch(const std::string& place, const ProgressCallback& progress) {
    if (!progress) return {};
    return [=](std::size_t done, std::size_t total) { progress({place, "load", done, total}); };
}

VariantRuns::VariantRuns(const nlohmann::json& document, const RunOptions& options)
    : document_(std::make_shared<const nlohmann::json>(document)),
      options_(options),
      variants_(variants_of(document, options.only)),
      loader_(options.data) {}

results::Result VariantRuns::describe() const {
    results::Result result;
    result.times = results::times_at_start();
    result.times.threads = base::thread_count();
    result.program = results::this_program();
    result.machine = results::this_machine();
    result.name = document_->at("name").get<std::string>();
    result.purpose = document_->value("purpose", "");
    result.document = document_->dump();
    result.hash = base::hash_text(result.document);
    result.only = options_.only;
    return result;
}

const scene::Scenario& VariantRuns::load(std::size_t variant, const ProgressCallback& progress) {
    // What belongs to the old scene goes first.
    contenders_.clear();
    casters_.reset();
    seen_.clear();
    loaded_ = variant;
    const std::string place = variants_.size() > 1 ? fmt::format("{}/{}", variant + 1, variants_.size()) : "";
    scenario_ = &loader_.load(variants_.at(variant), load_watch(place, progress));
    contenders_ = make_contenders(*scenario_, variants_[variant]);
    if (scenario_->scene.objects.empty()) return *scenario_;
    casters_ = std::make_unique<rays::Tracer>(scenario_->scene, true);
    if (scenario_->receivers.camera) seen_ = camera_points(scenario_->receivers, rays::Tracer(scenario_->scene, false));
    return *scenario_;
}

results::LightResult VariantRuns::measure(std::size_t light, const ProgressCallback& progress) const {
    StageWatch watch;
    if (progress)
        watch = [&, place = place_of(loaded_, variants_.size(), *scenario_, light)](const char* stage, std::size_t done,
                                                                                    std::size_t total) {
            progress({place, stage, done, total});
        };
    std::vector<Contender> fresh;
    for (const Contender& contender : contenders_) fresh.push_back(unbuilt(contender));
    return run_light({*scenario_, light, casters_.get(), seen_, options_.limits, watch, options_.times},
                     std::move(fresh));
}

std::vector<std::string> VariantRuns::seam_notes() const {
    struct Seams {
        CutLookups cut;
        std::size_t lookups = 0;
    };
    std::map<std::string, Seams> of;  // by the light's place in the document
    for (const scene::Light& light : scenario_->lights) {
        const scene::FilterWidth width = light.softness.value_or(scenario_->receivers.filter_width);
        if (!light.face || width.unit != scene::WidthUnit::receiver_pixels) continue;
        const rays::LightView view =
            rays::make_light_view(light, scenario_->scene, scenario_->rays.resolution, light.where);
        const QuerySet set = scenario_queries(*scenario_, light, seen_, view);
        const CutLookups cut = cut_at_seams(set.queries, view);
        Seams& seams = of[light.where];
        seams.cut.count += cut.count;
        seams.cut.border = std::max(seams.cut.border, cut.border);
        seams.lookups += set.queries.size();
    }
    constexpr double widest = 10.0;  // border
    const std::string variant = lookups_of(variants_.at(loaded_));
    std::vector<std::string> notes;
    for (const auto& [where, seams] : of)
        if (seams.cut.count > 0)
            notes.push_back(fmt::format(
                "{}{}: {} of {} lookups reach over the border of their map, so at seams a part of them is cut off: {}",
                where, variant, seams.cut.count, seams.lookups,
                seams.cut.border > widest
                    ? "make them narrower"
                    : fmt::format("with a border of {} none is", std::ceil(1e3 * seams.cut.border) / 1e3)));
    return notes;
}

}  // namespace shadowbench::bench
