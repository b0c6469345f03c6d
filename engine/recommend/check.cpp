#include "recommend/check.h"

#include <algorithm>
#include <iterator>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/parallel.h"
#include "bench/estimate.h"
#include "bench/load.h"
#include "bench/one_light.h"
#include "bench/prepared_light.h"
#include "bench/variant_runs.h"
#include "rays/light_view.h"
#include "recommend/space.h"

namespace shadowbench::recommend {
namespace {

using base::Error;
using base::ErrorCode;

// Wrong usage of the command line is bad input of a request.
template <class Action>
auto asked_at(const std::string& place, const Action& action) {
    try {
        return action();
    } catch (const Error& error) {
        if (error.code() != ErrorCode::usage) throw;
        throw Error(ErrorCode::bad_input, place, error.message());
    }
}

}  // namespace

nlohmann::json without_explored_sweeps(nlohmann::json document) {
    const auto sweeps = document.is_object() ? document.find("sweeps") : document.end();
    if (sweeps == document.end() || !sweeps->is_object()) return document;
    for (auto sweep = sweeps->begin(); sweep != sweeps->end();) {
        const bool explored = sweep.key() == "/rays/samples_per_pixel" || sweep.key().rfind("/techniques/", 0) == 0;
        sweep = explored ? sweeps->erase(sweep) : std::next(sweep);
    }
    if (sweeps->empty()) document.erase("sweeps");
    return document;
}

std::size_t chosen_light(const std::vector<std::string>& lights, const std::string& name) {
    if (!name.empty() || lights.size() == 1) return bench::find_light(lights, name, "--light ");
    throw Error(ErrorCode::usage, "--light",
                fmt::format("the scenario has {} lights, and each may need other settings; name one of: {}",
                            lights.size(), fmt::join(lights, ", ")));
}

bench::Validated check(const nlohmann::json& document, const bench::RunOptions& options, const Request& request,
                       const std::string& where) {
    const nlohmann::json single = without_explored_sweeps(document);
    const std::vector<document::Variant> variants = document::expand(single);
    if (variants.size() > 1)
        throw Error(ErrorCode::bad_input, "/sweeps",
                    "a recommendation is for one scene; leave only sweeps over the samples a pixel and the techniques, "
                    "which are explored");
    bench::ScenarioLoader loader(options.data);
    const scene::Scenario& scenario = loader.load(variants.front());
    const std::size_t index =
        asked_at(where + "/light", [&] { return chosen_light(bench::names_of(scenario.lights), request.light); });
    const Space space = asked_at(where + "/only", [&] { return Space(scenario, request.only); });
    const bench::PreparedLight light = bench::prepare_light(scenario, index, {}, options.limits);
    if (rays::misses_all(light.view, scenario.scene))
        throw Error(ErrorCode::bad_input, scenario.lights[index].where,
                    fmt::format("light \"{}\" sees nothing that casts a shadow", scenario.lights[index].name));
    std::set<std::string> techniques;
    for (const Family& family : space.families()) techniques.insert(family.technique);
    bench::Validated checked;
    checked.name = scenario.name;
    checked.variants = checked.lights = 1;
    checked.techniques = techniques.size();
    checked.notes = scene::notes(scenario);
    bench::add_files(variants.front(), scenario.scene, checked.files);
    checked.largest_side = std::max(light.layout.width, light.layout.height);
    checked.most_samples = std::max(light.layout.samples(), scenario.reference.samples_per_pixel);
    checked.least_bytes = light.least_bytes;
    checked.seconds = bench::estimate_seconds(bench::count_work(scenario, index, light.layout, light.view, {}),
                                              scenario.timing, base::thread_count()) +
                      bench::estimate_reading(loader.file_bytes()) +
                      bench::estimate_preparing(scenario, base::thread_count());
    checked.budget = request.goal.budget;
    return checked;
}

}  // namespace shadowbench::recommend
