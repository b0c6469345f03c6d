// Lokovic and Veach, Deep Shadow Maps, 2000: section 6, figure 7.
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "claims/intervals.h"
#include "claims/lokovic.h"

namespace shadowbench::claims::lokovic {
namespace {

using results::Cell;
using results::LightResult;

struct Row {
    int samples;
    Value deep_ns, pcf_ns;
    double deep_bytes, pcf_bytes;
    Value deep_rms, pcf_rms;
    double nodes;
    Value build_share;  // of the time of the capture
};

Row measure_row(const Context& context, int samples) {
    const results::Result result =
        context.run(ball_scene,
                    {fmt::format("rays.samples_per_pixel={}", samples), "reference.samples_per_pixel=256",
                     set_techniques(published_deep() + "," + pcf(samples, "sample"))},
                    {"reference.samples_per_pixel=64", "reference.spread_seeds=0"});
    const LightResult& light = light_of(result);
    const Cell &deep = cell_of(light, "deep"), &depth = cell_of(light, "pcf");
    const double capture_ms = 1e3 * results::capture_seconds_on_one_thread(light);
    return {samples,
            time_of(deep),
            time_of(depth),
            bytes_of(deep).value,
            bytes_of(depth).value,
            error_of(deep),
            error_of(depth),
            deep.nodes.mean(),
            (1.0 / capture_ms) * of(deep.times->build_ms)};
}

const Row& row_of(const std::vector<Row>& rows, int samples) {
    return *std::find_if(rows.begin(), rows.end(), [&](const Row& row) { return row.samples == samples; });
}

void add_figure_7_table(PaperReport& report, const std::vector<Row>& rows) {
    Table table{
        "Figure 7: deep maps and depth maps with equal numbers of samples, 256 x 256 pixels, over the width of a "
        "pixel (a deep map filters whole pixels, which adds to its error)",
        {"N", "0.5 / sqrt N", "deep ns", "depth ns", "deep bytes", "depth bytes", "deep rms", "depth rms",
         "nodes a pixel"},
        {}};
    for (const Row& r : rows)
        table.rows.push_back({std::to_string(r.samples), fmt::format("{:.3g}", 0.5 / std::sqrt(r.samples)),
                              to_text(r.deep_ns), to_text(r.pcf_ns), bytes_text(r.deep_bytes), bytes_text(r.pcf_bytes),
                              to_text(r.deep_rms), to_text(r.pcf_rms), fmt::format("{:.2f}", r.nodes)});
    report.tables.push_back(std::move(table));
}

}  // namespace

void sampling(const Context& context) {
    PaperReport& report = *context.report;
    std::vector<Row> rows;
    for (const int samples : {1, 4, 16, 36, 64, 144, 256}) rows.push_back(measure_row(context, samples));
    add_figure_7_table(report, rows);

    const Row &sixteen = row_of(rows, 16), &next = row_of(rows, 36);
    report.claims.push_back(
        {"section 6, figure 7",
         "depth maps are faster only at 4 x 4 samples and fewer",
         fmt::format("deep over depth: {} times at N = 16, {} times at N = 36",
                     to_text(sixteen.deep_ns / sixteen.pcf_ns), to_text(next.deep_ns / next.pcf_ns)),
         both(judge_less(sixteen.pcf_ns, sixteen.deep_ns), judge_less(next.deep_ns, next.pcf_ns)),
         "Where the times cross depends on the cost of a search against that of a depth test.",
         {sixteen.deep_ns / sixteen.pcf_ns, next.deep_ns / next.pcf_ns}});
    const Value growth = rows.back().deep_ns / sixteen.deep_ns;
    report.claims.push_back({"section 6, figure 7",
                             "deep lookup times are virtually constant as N grows",
                             fmt::format("N = 256 takes {} times as long as N = 16", to_text(growth)),
                             judge_constant(growth),
                             "16 times the samples would cost 16 times the tests in a depth map.",
                             {growth}});
    const Value pcf_growth = rows.back().pcf_ns / sixteen.pcf_ns;
    report.claims.push_back({"section 6, figure 7",
                             "depth maps become much more expensive as the error threshold decreases",
                             fmt::format("N = 256 takes {} times as long as N = 16", to_text(pcf_growth)),
                             judge_growth(pcf_growth),
                             "Each lookup compares N depths.",
                             {pcf_growth}});
    std::vector<std::pair<double, double>> bytes;
    for (const Row& r : rows)
        if (r.samples >= 16) bytes.emplace_back(r.samples, r.deep_bytes);
    const Value exponent = fitted_exponent(bytes);
    report.claims.push_back({"section 6, figure 7",
                             "deep maps grow very slowly in size as the error falls: as N^(1/4), section 4",
                             fmt::format("bytes grow as N^{}; 16 times the samples: {:.3g} times the bytes",
                                         to_text(exponent), rows.back().deep_bytes / sixteen.deep_bytes),
                             judge_exponent(0.25, exponent),
                             "Fitted over N from 16 to 256; the interval is that of the fit (Student's t).",
                             {exponent}});
    report.claims.push_back({"section 6",
                             "compression overhead is negligible beside sampling",
                             fmt::format("at N = 256 sweep and compression take {} of the capture's time (one thread)",
                                         to_text(rows.back().build_share)),
                             judge_negligible(rows.back().build_share),
                             "Capture here is a projection many times faster than the scanline renderer of the paper.",
                             {rows.back().build_share}});
}

}  // namespace shadowbench::claims::lokovic
