#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/table.h"
#include "bench/functions.h"
#include "results/report.h"

namespace shadowbench::bench {
namespace {

using json = nlohmann::ordered_json;

json to_json(const results::Sample& sample) {
    return {
        {"median", sample.median}, {"interval95", {sample.interval.low, sample.interval.high}}, {"raw", sample.raw}};
}

template <class Number>
json or_null(const std::optional<Number>& value) {
    return value ? json(*value) : json(nullptr);
}

}  // namespace

nlohmann::ordered_json to_json(const FunctionResult& result) {
    json times = nullptr;
    if (result.times)
        times = {{"build_ns_per_vertex", to_json(result.times->build_ns_per_vertex)},
                 {"lookup_random_ns", to_json(result.times->lookup_random_ns)},
                 {"lookup_coherent_ns", to_json(result.times->lookup_coherent_ns)}};
    return {{"technique", result.technique},
            {"parameters", json::parse(result.parameters_json)},
            {"functions", result.functions},
            {"vertices_in", result.vertices_in},
            {"nodes_out", result.nodes_out},
            {"nodes_over_fewest", result.over_fewest ? results::to_json(*result.over_fewest) : json(nullptr)},
            {"bytes", result.bytes},
            {"curve_error", {{"max", result.error_max}, {"rms", result.error_rms}}},
            {"tolerance", or_null(result.tolerance)},
            {"over_tolerance", or_null(result.over_tolerance)},
            {"rise_max", result.rise_max},
            {"outside_max", result.outside_max},
            {"broken", result.broken},
            {"times", std::move(times)}};
}

std::string to_table(std::span<const FunctionResult> results) {
    base::Table table({"technique", "functions", "vertices in", "nodes out", "x fewest", "bytes", "curve err max",
                       "rms", "over tolerance", "rises by", "leaves [0,1] by", "broken", "ns/vertex", "random ns",
                       "coherent ns", "status"});
    for (const FunctionResult& r : results) {
        const auto time = [&](const results::Sample FunctionTimes::*sample) {
            return r.times ? fmt::format("{:.2f}", ((*r.times).*sample).median) : std::string("-");
        };
        table.add({results::title(r.technique, r.parameters), fmt::format("{}", r.functions),
                   fmt::format("{}", r.vertices_in), fmt::format("{}", r.nodes_out),
                   r.over_fewest ? fmt::format("{:.3f}", r.over_fewest->ratio()) : "-", fmt::format("{}", r.bytes),
                   fmt::format("{:.6g}", r.error_max), fmt::format("{:.6g}", r.error_rms),
                   r.over_tolerance ? fmt::format("{}", *r.over_tolerance) : "-", fmt::format("{:.3g}", r.rise_max),
                   fmt::format("{:.3g}", r.outside_max), fmt::format("{}", r.broken),
                   time(&FunctionTimes::build_ns_per_vertex), time(&FunctionTimes::lookup_random_ns),
                   time(&FunctionTimes::lookup_coherent_ns), r.times ? "ok" : "failed: a promise is broken"});
    }
    return table.text("") +
           "x fewest: nodes over the fewest that do within the tolerance, starting at the exact value and never "
           "rising\n"
           "broken: functions that rise or leave [0, 1] although the technique promises the contrary\n";
}

}  // namespace shadowbench::bench
