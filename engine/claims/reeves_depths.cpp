// Reeves, Salesin, Cook 1987: section 1, depths as floating point numbers and as integers.
#include <cstdint>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/parallel.h"
#include "bench/camera_points.h"
#include "bench/queries.h"
#include "bench/reference.h"
#include "claims/first_light.h"
#include "claims/intervals.h"
#include "claims/reeves.h"
#include "claims/seen.h"
#include "claims/sixteen_bits.h"
#include "metrics/statistics.h"
#include "rays/tracer.h"

namespace shadowbench::claims::reeves {
namespace {

enum Technique { point, filtered };  // the document's, by their places

// The errors of point sampling with depths of both kinds, and of filtering; one value for each place of the cells.
struct Errors {
    std::vector<double> floats, integers, filter;
};

double rms_error(const bench::Maps& map, const bench::QuerySet& asked, const bench::Truth& truth) {
    const std::vector<float> answers = bench::lookup_all(map, asked.asked());
    std::vector<double> off(answers.size());
    for (std::size_t q = 0; q < answers.size(); ++q) off[q] = answers[q] - truth.value[q];
    return metrics::error_norms(off).rms;
}

void measure(const FirstLight& first, Errors& errors) {
    const scene::Scenario& scenario = first.scenario;
    const rays::Tracer all(scenario.scene, false);
    const std::vector<bench::CameraPoint> seen = bench::camera_points(scenario.receivers, all);
    const bench::QuerySet asked = bench::judged_queries(
        scenario, bench::scenario_queries(scenario, scenario.lights.front(), seen, first.light.view));
    const bench::Truth truth = bench::reference_visibility(scenario.scene, first.light.view,
                                                           bench::reference_settings(scenario), asked.queries, {});
    std::vector<rays::LightRays> tiles = first.tiles();
    errors.floats.push_back(rms_error(first.build(first.contenders[point], tiles), asked, truth));
    errors.filter.push_back(rms_error(first.build(first.contenders[filtered], tiles), asked, truth));
    for (rays::LightRays& tile : tiles)
        for (float& z : tile.z_front) z = in_sixteen_bits(z, first.light.layout.z_min, first.light.layout.z_max);
    errors.integers.push_back(rms_error(first.build(first.contenders[point], tiles), asked, truth));
}

}  // namespace

// Without a bias, so that aliases of the surfaces themselves count too.
void depths(const Context& context) {
    const base::ThreadLimit threads(context.threads);
    const nlohmann::json document = context.document(
        sphere,
        {"receivers.bias=0", R"(techniques=[{"type":"shadow_map"},{"type":"pcf","num_samples":16,"res_factor":1}])"});
    Errors errors;
    for (std::uint64_t place = 0; place < map_places; ++place) {
        const nlohmann::json at_place = with_moved_map(document, place);
        note_document(context, sphere, at_place);
        measure(FirstLight(at_place, context.data), errors);
    }
    const Value floats = mean_of(errors.floats), integers = mean_of(errors.integers), filter = mean_of(errors.filter),
                more = mean_ratio_of(errors.integers, errors.floats);
    context.report->claims.push_back(
        {"section 1",
         "floating point depths instead of integers of 16 bits reduce the aliasing of point-sampled depth maps, but do "
         "not solve it",
         fmt::format("error rms {} with floating point depths, {} with integers, {} times as much; {} filtered",
                     to_text(floats), to_text(integers), to_text(more), to_text(filter)),
         both(judge_less(exactly(1.0), more), judge_less(filter, floats)),
         "By both halves, without a bias. The integers span the depths that occur in the scene. Percentage closer "
         "filtering shows what floating point depths leave.",
         {floats, integers, more, filter}});
}

}  // namespace shadowbench::claims::reeves
