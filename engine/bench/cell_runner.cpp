#include "bench/cell_runner.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "bench/clock.h"
#include "scene/scenario.h"

namespace shadowbench::bench {

std::vector<CellOfDocument> cells_of(const nlohmann::json& document, const std::vector<std::string>& only) {
    const std::vector<document::Variant> variants = variants_of(document, only);
    std::vector<CellOfDocument> cells;
    for (std::size_t v = 0; v < variants.size(); ++v) {
        std::string title = document.at("name").get<std::string>();
        for (const document::Setting& setting : variants[v].settings)
            title += fmt::format(" {}={}", setting.pointer, setting.value);
        const std::vector<std::string> lights = scene::light_names(*variants[v].document);
        for (std::size_t l = 0; l < lights.size(); ++l) cells.push_back({{v, l}, title + " light " + lights[l]});
    }
    return cells;
}

CellRunner::CellRunner(const nlohmann::json& document, const RunOptions& options)
    : threads_(options.threads), runs_(document, options) {}

results::SweepCell CellRunner::measure(const results::CellPlace& place, const ProgressCallback& progress) {
    const Stopwatch stopwatch;
    results::SweepCell cell{place, results::this_node(), runs_.describe()};
    if (loaded_ != place.variant) {
        loaded_.reset();
        scenario_ = &runs_.load(place.variant, progress);
        notes_.clear();
        add_notes(*scenario_, notes_);
        try {
            add_missing(runs_.seam_notes(), notes_);
        } catch (const base::Error&) {  // of a light whose map no receiver is in: its own cell says so
        }
        loaded_ = place.variant;
    }
    add_missing(notes_, cell.result.notes);
    add_files(runs_.variants()[place.variant], scenario_->scene, cell.result.files);
    results::VariantResult& variant = cell.result.variants.emplace_back();
    variant.settings = runs_.variants()[place.variant].settings;
    variant.lights.push_back(runs_.measure(place.light, progress));
    cell.result.times.seconds = stopwatch.seconds();
    return cell;
}

}  // namespace shadowbench::bench
