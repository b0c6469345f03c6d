#include "recommend/trials.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "bench/build_timing.h"
#include "bench/clock.h"
#include "bench/curve_check.h"
#include "bench/one_light.h"
#include "bench/prepared_light.h"
#include "bench/quick_timing.h"
#include "bench/reference.h"
#include "document/document.h"
#include "recommend/attempt.h"
#include "recommend/check.h"
#include "results/machine.h"

namespace shadowbench::recommend {
namespace {

using base::Error;
using base::ErrorCode;
using bench::Contender;
using bench::QuerySet;
using bench::Stopwatch;
using bench::StoredRays;

constexpr double most_rays = 1 << 28;               // of one map; more take many minutes
constexpr double quickly_checked_rays = 1 << 18;    // of a map whose functions a short measurement checks
constexpr std::size_t quickly_checked_cells = 256;  // of it
constexpr std::size_t checked_cells = 4096;         // of any map, if the error of the stored functions is asked for
constexpr std::size_t most_kept = 12;               // maps, for settings that differ only in their lookups

Contender contender_of(const Setting& setting) {
    const std::string where = fmt::format("technique {}", setting.row->id);
    return bench::make_contender({setting.row->id, techniques::to_json(setting.values).dump(), where}, where);
}

}  // namespace

bool same_map(const Setting& a, const Setting& b) {
    if (a.row != b.row || a.resolution != b.resolution || a.samples != b.samples) return false;
    const auto only_lookups = [&](const std::string& parameter) {
        const auto& trades = a.row->traits.trades;
        return std::any_of(trades.begin(), trades.end(), [&](const techniques::Trade& trade) {
            return trade.only_lookups && parameter == trade.parameter;
        });
    };
    return std::all_of(a.values.values.begin(), a.values.values.end(), [&](const auto& named) {
        return named.second == b.values.at(named.first) || only_lookups(named.first);
    });
}

Trials::Trials(const nlohmann::json& document, const bench::RunOptions& options, const std::string& light,
               Measure measure, const bench::ProgressCallback& progress)
    : options_(options),
      threads_(options.threads),
      times_(results::times_at_start()),
      loader_(options.data),
      progress_(progress),
      measure_(measure) {
    const Stopwatch stopwatch;
    const nlohmann::json single = without_explored_sweeps(document);
    document_ = single.dump();
    scenario_ = &loader_.load(bench::only_variant(single));
    index_ = chosen_light(bench::names_of(scenario_->lights), light);
    light_ = &scenario_->lights[index_];
    space_.emplace(*scenario_, options_.only);
    store_.emplace(*scenario_, index_, options_.limits);
    const bench::PreparedLight prepared = bench::prepare_light(*scenario_, index_, {}, options_.limits);
    own_ = std::make_shared<const bench::Frame>(bench::Frame{prepared.view, prepared.layout});
    if (rays::misses_all(own_->view, scenario_->scene))
        throw Error(ErrorCode::bad_input, light_->where,
                    fmt::format("light \"{}\" sees nothing that casts a shadow", light_->name));
    std::vector<bench::CameraPoint> seen;
    if (!scenario_->scene.objects.empty()) {
        casters_ = std::make_unique<rays::Tracer>(scenario_->scene, true);
        if (scenario_->receivers.camera)
            seen = bench::camera_points(scenario_->receivers, rays::Tracer(scenario_->scene, false));
    }
    all_ = bench::scenario_queries(*scenario_, *light_, seen, own_->view);
    judged_ = bench::judged_queries(*scenario_, all_);
    bench::ReferenceWatch watch;
    if (progress_) watch = [&](std::size_t done, std::size_t total) { progress_({"", "reference", done, total}); };
    truth_ = bench::reference_visibility(scenario_->scene, own_->view, bench::reference_settings(*scenario_),
                                         judged_.queries, watch);
    const metrics::ErrorNorms doubt = metrics::error_norms(truth_.standard_error);
    truth_doubt_ = {doubt.rms, doubt.max};
    seconds_ = stopwatch.seconds();
}

Trials::~Trials() = default;

bench::RayChoice Trials::choice(const Setting& setting, int seed) const {
    return {setting.resolution, setting.samples, scenario_->rays.seed + static_cast<std::uint64_t>(seed)};
}

const rays::MapLayout& Trials::layout(const Setting& setting) const {
    const auto [place, is_new] =
        layouts_.try_emplace({std::max(setting.resolution.x, setting.resolution.y), setting.samples});
    if (is_new) place->second = store_->frame(choice(setting, 0))->layout;
    return place->second;
}

std::optional<double> Trials::footprint_share() const {
    const scene::FilterWidth width = light_->softness.value_or(scenario_->receivers.filter_width);
    if (width.unit != scene::WidthUnit::map_pixels) return {};
    return width.value / scenario_->rays.resolution.x;
}

// Why a setting is not measured at all; empty: it is.
std::string Trials::refusal(const Setting& setting, const Contender& contender) const {
    const rays::MapLayout& layout = this->layout(setting);
    const double rays = static_cast<double>(layout.width) * layout.height * layout.samples();
    if (rays > most_rays)
        return fmt::format("needs {:.3g} light rays; more than {:.3g} are not tried", rays, most_rays);
    // The rays are kept for further settings.
    const double kept = std::min(bench::least_ray_bytes(layout), static_cast<double>(options_.limits.kept_rays));
    const double need = kept + bench::least_bytes(layout, layout, std::span(&contender, 1));
    if (need > static_cast<double>(options_.limits.all))
        return fmt::format("needs at least {:.3g} GiB of memory: more than the limit", need / (1 << 30));
    return "";
}

// Keeps the map for settings that differ only in their lookups, and drops the longest unused ones beyond a limit.
void Trials::keep_map(const Setting& setting, Attempt attempt) {
    attempt.rays = nullptr;
    kept_.push_front({setting, std::move(attempt)});
    std::size_t sum = 0;
    for (const Kept& kept : kept_) sum += kept.attempt.contender.cell.bytes;
    while (kept_.size() > 1 && (sum > options_.limits.kept_rays / 4 || kept_.size() > most_kept)) {
        sum -= kept_.back().attempt.contender.cell.bytes;
        kept_.pop_back();
    }
}

// A kept map that this setting stores too, or the end.
std::list<Trials::Kept>::iterator Trials::find_kept(const Setting& setting) {
    return std::find_if(kept_.begin(), kept_.end(), [&](const Kept& kept) { return same_map(kept.setting, setting); });
}

// The kept map, with the lookups of this setting.
Trials::Attempt Trials::take_kept(std::list<Kept>::iterator kept, const Setting& setting) {
    Attempt attempt = std::move(kept->attempt);
    kept_.erase(kept);
    Contender wanted = contender_of(setting);
    Contender& contender = attempt.contender;
    contender.values = std::move(wanted.values);
    contender.cell.parameters = std::move(wanted.cell.parameters);
    contender.cell.parameters_json = std::move(wanted.cell.parameters_json);
    contender.cell.defaults = wanted.cell.defaults;
    bench::set_lookups(contender.maps, contender.values);
    return attempt;
}

// Captures the light rays and builds one map; `timed`: on one thread, and times that.
Trials::Attempt Trials::build(const Setting& setting, int seed, bool timed) {
    Attempt attempt{contender_of(setting), nullptr, nullptr};
    Contender& contender = attempt.contender;
    if (const std::string reason = refusal(setting, contender); !reason.empty()) {
        bench::fail(contender, reason);
        return attempt;
    }
    attempt.rays = store_->rays(choice(setting, seed), contender.needs);
    attempt.frame = attempt.rays->frame;
    attempt.segments = attempt.rays->source->segments();
    if (!setting.row->traits.traces)
        attempt.capture_ms = 1e3 * (attempt.rays->setup_seconds + attempt.rays->capture_seconds);
    const bench::RaySource& source = *attempt.rays->source;
    const techniques::BuildInput input{attempt.frame->layout, attempt.frame->view, casters_.get()};
    const std::span<Contender> one(&contender, 1);
    if (contender.needs.apron > 0) source.for_each_batch(contender.needs.apron, [](bench::RaySource::Batch) {});
    const bool kept = source.kept(contender.needs.apron);
    try {
        if (timed && kept) {
            const base::ThreadLimit one_thread(1);
            const Stopwatch building;
            bench::build_all(one, source, input, options_.limits.all, {});
            attempt.build_ms = 1e3 * building.seconds();
        } else {
            bench::build_all(one, source, input, options_.limits.all, {});
            std::vector<std::vector<double>> seconds(1);
            results::TimedPasses passes;
            if (timed) bench::time_builds(one, source, input, seconds, passes);
            if (!seconds[0].empty()) attempt.build_ms = 1e3 * seconds[0][0];
        }
    } catch (const Error& error) {  // the technique cannot serve this layout
        if (error.code() != ErrorCode::bad_input) throw;
        bench::fail(contender, error.message());
    }
    return attempt;
}

// Compares the answers of a built map with the truth.
void Trials::judge_lookups(Attempt& attempt) const {
    if (!attempt.contender.ok()) return;
    bench::check_lookups(std::span(&attempt.contender, 1), asked(judged_, attempt.frame->view).asked(), truth_);
}

QuerySet Trials::asked(const QuerySet& set, const rays::LightView& view) const {
    return bench::rescaled(set.asked(), own_->view, view);
}

double Trials::error_of(const results::Cell& cell) const {
    if (measure_ == Measure::curve) return cell.curve ? cell.curve->norms.max : 0.0;
    return norm_of(cell.lookup->norms, measure_);
}

// Fails the contender if a lookup answers what it must not.
void Trials::time_quickly(Attempt& attempt) const {
    Contender& contender = attempt.contender;
    const bench::QuickTimes quick =
        bench::quick_lookup_times(contender.maps, asked(all_, attempt.frame->view).asked(),
                                  static_cast<std::size_t>(scenario_->timing.lookups), scenario_->receivers.seed);
    bench::check_answers(contender, quick.asked, quick.answers);
    if (!contender.ok()) return;
    results::CellTimes& times = contender.cell.times.emplace();
    times.build_ms = results::summarise({attempt.build_ms});
    times.ns_per_segment = attempt.ns_per_segment(attempt.build_ms);
    times.image_order.ns = quick.image_ns;
    times.random_order.ns = quick.random_ns;
    times.lookups = quick.lookups;
}

// Compares an even share of the stored functions with those of the light rays. Unless their error is asked for, only in
// small maps: an exploration measures every family in small maps too, and a confirmation checks all functions.
void Trials::check_some(Attempt& attempt) const {
    Contender& contender = attempt.contender;
    const bool asked_for = measure_ == Measure::curve;
    if (!asked_for && static_cast<double>(attempt.rays->source->rays()) > quickly_checked_rays) return;
    const bench::CheckedMap checked{&contender.maps, contender.promises, contender.cell.error_bound,
                                    !contender.cell.outside_promise, contender.needs.apron};
    bench::CurveVerdict verdict =
        bench::check_curves(*attempt.rays->source, attempt.frame->layout, std::span(&checked, 1),
                            asked_for ? checked_cells : quickly_checked_cells, {})[0];
    contender.cell.curve = std::move(verdict.errors);
    if (!verdict.broken.empty())
        bench::fail(contender, verdict.broken);
    else if (asked_for && !contender.cell.curve)
        bench::fail(contender, no_curve);
}

// A map that is kept was checked when it was built.
Trial Trials::measure(const Point& point) {
    const Stopwatch stopwatch;
    const Setting setting = space_->setting(point);
    if (const FiledTrial* filed = files_ ? files_->find(filed_name(point, setting)) : nullptr)
        return take(*filed, point, setting);
    const auto there = find_kept(setting);
    const bool built = there == kept_.end();
    Attempt attempt = built ? build(setting, 0, true) : take_kept(there, setting);
    const Contender& contender = attempt.contender;
    FiledTrial fresh;
    const Stopwatch after_capture;
    judge_lookups(attempt);
    if (built) {
        fresh.seconds = 1e-3 * attempt.build_ms + after_capture.seconds();
        if (attempt.rays) fresh.rays = static_cast<double>(attempt.rays->source->rays());
        note_effort(setting, fresh.seconds, fresh.rays, static_cast<double>(contender.cell.bytes));
    }
    if (built && contender.ok()) check_some(attempt);
    if (contender.ok()) time_quickly(attempt);
    Trial& trial = fresh.trial;
    trial.failed = attempt.failed();
    if (contender.ok()) {
        trial.error = error_of(contender.cell);
        trial.cost = {contender.cell.times->random_order.ns.median, static_cast<double>(contender.cell.bytes),
                      attempt.capture_ms + attempt.build_ms};
        trials_.emplace_back(point, trial);
    }
    if (attempt.frame) {
        results::LightResult& light = attempt.rays ? record(setting, *attempt.rays) : *recorded(setting);
        const results::Cell& cell = keep(light, contender);
        if (files_) file(point, setting, light, cell, fresh);
    }
    if (contender.ok()) keep_map(setting, std::move(attempt));
    seconds_ += stopwatch.seconds();
    return trial;
}

}  // namespace shadowbench::recommend
