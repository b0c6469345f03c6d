#include "recommend/of_run.h"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "metrics/student.h"
#include "recommend/check.h"
#include "recommend/error_interval.h"
#include "scene/scenario.h"
#include "scene/scene.h"
#include "techniques/technique.h"

namespace shadowbench::recommend {
namespace {

using base::Error;
using base::ErrorCode;
using results::Cell;
using results::LightResult;

using Side = std::pair<int, int>;  // width and height, pixels

// The values of the rays' axes in all variants.
struct RayAxes {
    std::vector<Side> resolutions;  // by their number of pixels
    std::vector<int> samples;
};

Side side_of(const LightResult& light) {
    return {light.layout.width, light.layout.height};
}

template <class Value>
int index_in(const std::vector<Value>& values, const Value& value) {
    return static_cast<int>(std::find(values.begin(), values.end(), value) - values.begin());
}

RayAxes ray_axes(const std::vector<const LightResult*>& lights) {
    RayAxes axes;
    for (const LightResult* light : lights) {
        axes.resolutions.push_back(side_of(*light));
        axes.samples.push_back(light->layout.samples());
    }
    std::sort(axes.resolutions.begin(), axes.resolutions.end(), [](const Side& a, const Side& b) {
        return std::tuple(static_cast<double>(a.first) * a.second, a) <
               std::tuple(static_cast<double>(b.first) * b.second, b);
    });
    axes.resolutions.erase(std::unique(axes.resolutions.begin(), axes.resolutions.end()), axes.resolutions.end());
    std::sort(axes.samples.begin(), axes.samples.end());
    axes.samples.erase(std::unique(axes.samples.begin(), axes.samples.end()), axes.samples.end());
    return axes;
}

void check_sweeps(const results::Result& run, const std::string& origin) {
    for (const results::VariantResult& variant : run.variants)
        for (const document::Setting& setting : variant.settings)
            if (setting.pointer != "/rays/resolution" && setting.pointer != "/rays/samples_per_pixel")
                throw Error(ErrorCode::bad_input, origin,
                            fmt::format("the run sweeps {}, so its rows do not answer one question; only "
                                        "/rays/resolution, /rays/samples_per_pixel and the techniques may be swept",
                                        setting.pointer));
}

// The width of all footprints of the light as a share of the map, if the scenario gives it in map pixels.
std::optional<double> footprint_share(const results::Result& run, const RayAxes& axes, const std::string& light,
                                      const std::string& origin) try {
    const nlohmann::json document = nlohmann::json::parse(run.document);
    const nlohmann::json receivers = document.value("receivers", nlohmann::json::object());
    for (const char* bias : {"slope_bias", "normal_bias"})
        if (axes.resolutions.size() > 1 && receivers.value(bias, 0.0) > 0.0)
            throw Error(ErrorCode::bad_input, origin,
                        fmt::format("the run sweeps the resolution, and its {} is in map pixels: finer maps were asked "
                                    "at other places; give receivers.bias alone and run it again",
                                    bias));
    const scene::FilterWidth width = scene::lookup_width(document, light);
    if (width.unit != scene::WidthUnit::map_pixels) return {};
    if (axes.resolutions.size() > 1)
        throw Error(ErrorCode::bad_input, origin,
                    "the run sweeps the resolution, and its footprints are in map pixels: finer maps were asked for "
                    "smaller footprints; give receivers.footprint and run it again");
    return width.value / axes.resolutions.front().first;
} catch (const nlohmann::json::exception& error) {
    throw Error(ErrorCode::bad_input, origin, fmt::format("the run holds no valid scenario: {}", error.what()));
}

// The parameters that differ from the row's defaults.
std::vector<Family::Word> words_of(const Cell& cell, const techniques::Technique& row) {
    const nlohmann::json defaults =
        techniques::to_json(techniques::read_parameters(row.parameters, nlohmann::json::object(), ""));
    const nlohmann::json values = nlohmann::json::parse(cell.parameters_json);
    std::vector<Family::Word> words;
    for (const auto& [name, value] : values.items())
        if (name != "type" && (!defaults.contains(name) || defaults[name] != value))
            words.push_back({name, value.dump()});
    return words;
}

Confirmed confirmed_of(const LightResult& light, const Cell& cell, bool traces, Measure measure,
                       const std::string& origin) {
    Confirmed confirmed;
    std::vector<double> errors{norm_of(cell.lookup->norms, measure)};
    for (const results::SeedErrors& seed : cell.over_seeds) errors.push_back(norm_of(seed.lookup, measure));
    const bool same_rays = !light.layout.jittered || light.deep_image;
    if (errors.size() == 1 && !same_rays)
        throw Error(ErrorCode::bad_input, origin,
                    "the run measured one seed of its light rays, so its errors have no interval; run it again with "
                    "reference.spread_seeds of at least 2");
    if (errors.size() == 1) errors.push_back(errors.front());
    confirmed.error = error_interval(errors, measure, {light.reference.error_rms, light.reference.error_max});
    confirmed.mean_error = metrics::mean_and_variance(errors).mean;
    const double capture_ms = traces || !light.agreement
                                  ? 0.0
                                  : 1e3 * (light.times.setup_seconds + results::capture_seconds_on_one_thread(light));
    const results::Sample& build = cell.times->build_ms;
    const double bytes = static_cast<double>(cell.bytes);
    confirmed.cost = {cell.times->random_order.ns.median, bytes, capture_ms + build.median};
    confirmed.interval = {cell.times->random_order.ns.interval, metrics::Interval{bytes, bytes},
                          metrics::Interval{capture_ms + build.interval.low, capture_ms + build.interval.high}};
    return confirmed;
}

std::vector<std::string> names_of(const results::Result& run) {
    std::vector<std::string> names;
    for (const LightResult& light : run.variants.front().lights) names.push_back(light.name);
    return names;
}

}  // namespace

Recommendation recommendation_of(const results::Result& run, const std::string& light, Measure measure,
                                 const std::string& origin) {
    if (measure == Measure::curve)
        throw Error(ErrorCode::bad_input, origin,
                    "a run measures the errors of stored functions with one seed, so they have no interval; ask for "
                    "the rms, max or p99 of lookups");
    if (run.variants.empty()) throw Error(ErrorCode::bad_input, origin, "the run has no rows");
    check_sweeps(run, origin);
    const std::size_t index = chosen_light(names_of(run), light);
    std::vector<const LightResult*> lights;
    for (const results::VariantResult& variant : run.variants) lights.push_back(&variant.lights.at(index));
    const RayAxes axes = ray_axes(lights);
    const std::string& name = lights.front()->name;
    Recommendation found{run.name, name, measure, footprint_share(run, axes, name, origin), {}};
    found.exploration.end = End::given;
    found.truth_error = lights.front()->reference.error_rms;

    Axis resolutions{"resolution", {}}, samples{"samples_per_pixel", {}};
    for (const auto& [x, y] : axes.resolutions)
        resolutions.values.push_back(x == y ? fmt::format("{}", x) : fmt::format("[{},{}]", x, y));
    for (const int count : axes.samples) samples.values.push_back(fmt::format("{}", count));
    std::map<std::string, std::size_t> numbers;  // of the families, by technique and parameters
    for (const LightResult* one : lights)
        for (const Cell& cell : one->cells) {
            const techniques::Technique& row = techniques::find(cell.technique, origin);
            const auto [number, added] =
                numbers.emplace(cell.technique + cell.parameters_json, found.exploration.families.size());
            if (added) {
                Family family{cell.technique, results::title(cell), {resolutions, samples}, words_of(cell, row)};
                family.mapless = row.traits.traces;
                found.exploration.families.push_back(std::move(family));
            }
            const Point point{
                number->second,
                {index_in(axes.resolutions, side_of(*one)), index_in(axes.samples, one->layout.samples())}};
            Trial trial{cell.status == results::CellStatus::ok ? "" : cell.reason, 0.0, {}};
            if (trial.failed.empty() && !(cell.lookup && cell.times)) trial.failed = "it was not measured";
            if (trial.failed.empty()) {
                const Confirmed confirmed = confirmed_of(*one, cell, row.traits.traces, measure, origin);
                trial.error = norm_of(cell.lookup->norms, measure);
                trial.cost = confirmed.cost;
                found.exploration.confirmed.push_back({point, confirmed});
            }
            found.exploration.measured.push_back({point, std::move(trial)});
        }
    return found;
}

}  // namespace shadowbench::recommend
