// Lokovic and Veach, Deep Shadow Maps, 2000: section 6, figure 7.
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/parallel.h"
#include "claims/intervals.h"
#include "claims/lokovic.h"
#include "claims/seeded_light.h"

namespace shadowbench::claims::lokovic {
namespace {

using results::Cell;
using results::LightResult;

constexpr int all_samples[] = {1, 4, 16, 36, 64, 144, 256};
constexpr std::size_t sixteen = 2, next = 3, most = std::size(all_samples) - 1;  // places in that list

struct Row {
    int samples;
    Value deep_bytes, pcf_bytes;
    Value deep_rms, pcf_rms;
    double nodes;
};

// Nanoseconds a lookup in the maps of each row: the deep map, then the depth map.
std::size_t deep_of(std::size_t row) {
    return 2 * row;
}
std::size_t depth_of(std::size_t row) {
    return 2 * row + 1;
}

std::vector<std::string> settings(int samples) {
    return {fmt::format("rays.samples_per_pixel={}", samples), "reference.samples_per_pixel=256",
            set_techniques(published_deep() + "," + pcf(samples, "sample"))};
}

const std::vector<std::string> smaller{"reference.samples_per_pixel=64", "reference.spread_seeds=0"};

Row measure_row(const Context& context, int samples) {
    const results::Result result = context.run(ball_scene, settings(samples), smaller);
    const LightResult& light = light_of(result);
    const Cell &deep = cell_of(light, "deep"), &depth = cell_of(light, "pcf");
    return {samples, bytes_of(deep), bytes_of(depth), error_of(deep), error_of(depth), deep.nodes.mean()};
}

Turns time_lookups(const Context& context) {
    TimedMaps timed;
    for (const int samples : all_samples) timed.add(context, ball_scene, settings(samples), smaller, 8192);
    const Compared compared[] = {{deep_of(sixteen), depth_of(sixteen)},
                                 {deep_of(next), depth_of(next)},
                                 {deep_of(most), deep_of(sixteen)},
                                 {depth_of(most), depth_of(sixteen)}};
    return timed.take(compared);
}

// The build of the deep map of the most samples, over the capture of its rays.
Value build_over_capture(const Context& context) {
    std::vector<std::string> set = settings(all_samples[most]);
    set.back() = set_techniques(published_deep());
    const SeededLight light(context, ball_scene, set, smaller);
    const std::size_t capture = light.capture_place();
    const Compared compared[] = {{0, capture}};
    return light.build_turns(compared).ratio(0, capture);
}

void add_figure_7_table(PaperReport& report, const std::vector<Row>& rows, const Turns& ns) {
    Table table{
        "Figure 7: deep maps and depth maps with equal numbers of samples, 256 x 256 pixels, over the width of a "
        "pixel (a deep map weighs the means of pixels, which adds to its error)",
        {"N", "0.5 / sqrt N", "deep ns", "depth ns", "deep bytes", "depth bytes", "deep rms", "depth rms",
         "nodes a pixel"},
        {}};
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const Row& r = rows[i];
        table.rows.push_back({std::to_string(r.samples), fmt::format("{:.3g}", 0.5 / std::sqrt(r.samples)),
                              to_text(ns.time(deep_of(i))), to_text(ns.time(depth_of(i))),
                              bytes_text(r.deep_bytes.value), bytes_text(r.pcf_bytes.value), to_text(r.deep_rms),
                              to_text(r.pcf_rms),
                              fmt::format("{:.2f}", r.nodes)});
    }
    report.tables.push_back(std::move(table));
}

// Section 4, and the sizes that section 1 promises.
void equal_samples(const std::vector<Row>& rows, PaperReport& report) {
    std::vector<Judged> alike;
    std::vector<Value> errors;
    std::string text;
    for (const Row& r : rows) {
        errors.push_back(r.deep_rms / r.pcf_rms);
        alike.push_back(judge_alike(r.deep_rms, r.pcf_rms));
        text += fmt::format("{}{} at N = {}", text.empty() ? "" : ", ", to_text(errors.back()), r.samples);
    }
    report.claims.push_back(
        {"section 4, and section 6, figure 7",
         "a deep lookup is equivalent to percentage closer filtering of all depth samples within the filter, so N "
         "samples achieve the same accuracy",
         "error rms of the deep map over that of the depth map: " + text,
         in_all(alike),
         "Judged at each N, over filters as wide as a pixel. A filter that lies over several pixels takes part of each "
         "of their means, and so depth samples outside it. This error does not fall with N.",
         errors});
    const Value smaller_by = rows[most].pcf_bytes / rows[most].deep_bytes;
    report.claims.push_back({"section 1",
                             "for high-quality shadows, deep maps are smaller than equivalent depth maps by an order "
                             "of magnitude",
                             fmt::format("{} times smaller at N = {}", to_text(smaller_by), rows[most].samples),
                             judge_gain(10.0, smaller_by),
                             "High quality is the most samples that are measured, near the paper's 250; the depth map "
                             "has as many. Of bytes held.",
                             {smaller_by}});
}

}  // namespace

void sampling(const Context& context) {
    const base::ThreadLimit threads(context.threads);
    PaperReport& report = *context.report;
    std::vector<Row> rows;
    for (const int samples : all_samples) rows.push_back(measure_row(context, samples));
    const Turns ns = time_lookups(context);
    add_figure_7_table(report, rows, ns);
    equal_samples(rows, report);

    const Value at_sixteen = ns.ratio(deep_of(sixteen), depth_of(sixteen)),
                at_next = ns.ratio(deep_of(next), depth_of(next));
    report.claims.push_back(
        {"section 6, figure 7",
         "depth maps are faster only at 4 x 4 samples and fewer",
         fmt::format("deep over depth: {} times at N = 16, {} times at N = 36",
                     to_text(at_sixteen), to_text(at_next)),
         both(judge_less(exactly(1.0), at_sixteen), judge_less(at_next, exactly(1.0))),
         "Where the times cross depends on the cost of a search against that of a depth test.",
         {at_sixteen, at_next}});
    const Value growth = ns.ratio(deep_of(most), deep_of(sixteen));
    report.claims.push_back({"section 6, figure 7",
                             "deep lookup times are virtually constant as N grows",
                             fmt::format("N = 256 takes {} times as long as N = 16", to_text(growth)),
                             judge_constant(growth),
                             "16 times the samples would cost 16 times the tests in a depth map.",
                             {growth}});
    const Value pcf_growth = ns.ratio(depth_of(most), depth_of(sixteen));
    report.claims.push_back({"section 6, figure 7",
                             "depth maps become much more expensive as the error threshold decreases",
                             fmt::format("N = 256 takes {} times as long as N = 16", to_text(pcf_growth)),
                             judge_growth(pcf_growth),
                             "Each lookup compares N depths.",
                             {pcf_growth}});
    std::vector<std::pair<double, double>> bytes;
    for (const Row& r : rows)
        if (r.samples >= 16) bytes.emplace_back(r.samples, r.deep_bytes.value);
    const Value exponent = fitted_exponent(bytes);
    report.claims.push_back({"section 6, figure 7",
                             "deep maps grow very slowly in size as the error falls: as N^(1/4), section 4",
                             fmt::format("bytes grow as N^{}; 16 times the samples: {:.3g} times the bytes",
                                         to_text(exponent),
                                         rows[most].deep_bytes.value / rows[sixteen].deep_bytes.value),
                             judge_exponent(0.25, exponent),
                             "Fitted over N from 16 to 256; the interval is that of the fit (Student's t).",
                             {exponent}});
    const Value overhead = build_over_capture(context);
    report.claims.push_back({"section 6, figure 7",
                             "compression overhead is negligible beside sampling",
                             fmt::format("at N = 256 sweep and compression take {} of the capture's time (one thread)",
                                         to_text(overhead)),
                             judge_negligible(overhead),
                             "Capture here is a projection many times faster than the scanline renderer of the paper.",
                             {overhead}});
}

}  // namespace shadowbench::claims::lokovic
