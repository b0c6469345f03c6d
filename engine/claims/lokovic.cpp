// Lokovic and Veach, Deep Shadow Maps, 2000: section 6 and sections 5.2 to 5.5.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "claims/fit.h"
#include "claims/paper.h"
#include "claims/sheet.h"

namespace shadowbench::claims {
namespace {

using results::Cell;
using results::LightResult;

constexpr const char* hair_ball = "lokovic2000_hairball";

// Filters over exactly the width of the lookup, with this number of samples.
std::string pcf(int samples, const char* cells) {
    return fmt::format(R"({{"type":"pcf","num_samples":{},"res_factor":1,"min_size":0,"min_samples":1,"cells":"{}"}})",
                       samples, cells);
}

// The paper's filter weighs whole pixels (section 3.4). A tent filter is as wide as a pixel wherever it lies. A box
// filter of a pixel's width leaves only the nearest pixel.
constexpr const char* tent = R"({"type":"deep","kernel":"tent"})";
constexpr const char* pixels = R"({"type":"deep","kernel":"pixels"})";

std::string set_techniques(const std::string& list) {
    return "techniques=[" + list + "]";
}

std::string bytes_text(double bytes) {
    return bytes < 1048576.0 ? fmt::format("{:.3g} KiB", bytes / 1024.0) : fmt::format("{:.3g} MiB", bytes / 1048576.0);
}

// A depth map of 512 x 512, one of 4096 x 4096, and a deep map of 512 x 512 pixels of 256 samples. All lookups are over
// one pixel of the smaller maps.
void figure_6(const Context& context) {
    PaperReport& report = *context.report;
    const results::Result small = context.run(
        hair_ball,
        {"rays.resolution=512", "rays.samples_per_pixel=1", "rays.pattern=regular", set_techniques(pcf(16, "centre"))},
        {"rays.resolution=128"});
    const results::Result large =
        context.run(hair_ball,
                    {"rays.resolution=4096", "rays.samples_per_pixel=1", "rays.pattern=regular",
                     "receivers.filter_width=8", set_techniques(pcf(400, "centre"))},
                    {"rays.resolution=1024"});
    const results::Result deep = context.run(hair_ball,
                                             {"rays.resolution=512", "rays.samples_per_pixel=256",
                                              "timing.repetitions=7", "reference.spread_seeds=2",
                                              set_techniques(tent + std::string(",") + pixels)},
                                             {"rays.resolution=128"});
    const Cell& coarse = cell_of(light_of(small), "pcf");
    const Cell& fine = cell_of(light_of(large), "pcf");
    const Cell& stored = cell_of(light_of(deep), "deep", {"kernel=tent"});

    Table table{"Figure 6: one pixel's width of hair shadow by three maps",
                {"map", "ns a lookup", "bytes", "error rms", "error max"},
                {}};
    const auto add = [&](const std::string& name, const Cell& cell) {
        table.rows.push_back({name, to_text(time_of(cell)), bytes_text(static_cast<double>(cell.bytes)),
                              to_text(error_of(cell)), fmt::format("{:.3g}", cell.lookup->norms.max)});
    };
    const auto map = [](const results::Result& result) { return light_of(result).layout; };
    add(fmt::format("depth map {}, 16 samples", map(small).width), coarse);
    add(fmt::format("depth map {}, 400 samples", map(large).width), fine);
    add(fmt::format("deep map {}, {} samples a pixel", map(deep).width, map(deep).samples()), stored);
    add("the same, only the nearest pixel", cell_of(light_of(deep), "deep", {"kernel=pixels"}));
    report.tables.push_back(table);

    const Value faster = time_of(fine) / time_of(stored);
    report.claims.push_back(
        {"section 6, figure 6",
         "deep map lookups take 37 s where the 4096 map with 400 samples takes 559 s: 15 times faster",
         to_text(faster) + " times faster",
         judge_gain(15.0, faster),
         "A deep lookup searches the short functions of a few pixels; the depth map reads 400 scattered depths.",
         {faster}});
    const Value slower = time_of(stored) / time_of(coarse);
    report.claims.push_back(
        {"section 6, figure 6",
         "deep map lookups take 37 s where the 512 map with 16 samples takes 19 s: 1.9 times slower",
         to_text(slower) + " times the time",
         judge_ratio(37.0 / 19.0, slower),
         "The paper had not optimised deep lookups. Its lookups are compared with 16 depth tests.",
         {slower}});
    const Value smaller = exactly(static_cast<double>(fine.bytes) / static_cast<double>(stored.bytes));
    report.claims.push_back({"section 6, figure 6",
                             "the deep map needs one sixth of the 4096 map's storage",
                             fmt::format("1 / {}", to_text(smaller)),
                             judge_gain(6.0, smaller),
                             "Both are measured in bytes held; the depth map is raw floats.",
                             {smaller}});
    report.claims.push_back(
        {"section 6, figure 6",
         "quality slightly better than the 4096 map, since every depth sample counts",
         fmt::format("error rms {} against {}", to_text(error_of(stored)), to_text(error_of(fine))),
         judge_less(error_of(stored), error_of(fine)),
         "The truth is a box of one pixel; the tent over whole pixels of the deep map is wider than that, the depth "
         "map's region is not.",
         {error_of(stored), error_of(fine)}});
}

struct Row {
    int samples;
    Value deep_ns, pcf_ns;
    double deep_bytes, pcf_bytes;
    Value deep_rms, pcf_rms;
    double nodes, build_share;
};

Row measure_row(const Context& context, int samples) {
    const results::Result result = context.run(hair_ball,
                                               {fmt::format("rays.samples_per_pixel={}", samples),
                                                set_techniques(tent + std::string(",") + pcf(samples, "sample"))},
                                               {"rays.resolution=96"});
    const LightResult& light = light_of(result);
    const Cell &deep = cell_of(light, "deep"), &depth = cell_of(light, "pcf");
    const double capture_ms = 1e3 * results::capture_seconds_on_one_thread(light);
    return {samples,
            time_of(deep),
            time_of(depth),
            static_cast<double>(deep.bytes),
            static_cast<double>(depth.bytes),
            error_of(deep),
            error_of(depth),
            deep.nodes.mean(),
            deep.times->build_ms.median / capture_ms};
}

const Row& row_of(const std::vector<Row>& rows, int samples) {
    return *std::find_if(rows.begin(), rows.end(), [&](const Row& row) { return row.samples == samples; });
}

void add_figure_7_table(PaperReport& report, const std::vector<Row>& rows) {
    Table table{"Figure 7: deep maps and depth maps with equal numbers of samples, 256 x 256 pixels",
                {"N", "0.5 / sqrt N", "deep ns", "depth ns", "deep bytes", "depth bytes", "deep rms", "depth rms",
                 "nodes a pixel"},
                {}};
    for (const Row& r : rows)
        table.rows.push_back({std::to_string(r.samples), fmt::format("{:.3g}", 0.5 / std::sqrt(r.samples)),
                              to_text(r.deep_ns), to_text(r.pcf_ns), bytes_text(r.deep_bytes), bytes_text(r.pcf_bytes),
                              to_text(r.deep_rms), to_text(r.pcf_rms),
                              fmt::format("{:.2f}", r.nodes)});
    report.tables.push_back(std::move(table));
}

void figures_7_and_8(const Context& context) {
    PaperReport& report = *context.report;
    std::vector<Row> rows;
    for (const int samples : {1, 4, 16, 36, 64, 144, 256}) rows.push_back(measure_row(context, samples));
    add_figure_7_table(report, rows);

    const Row &sixteen = row_of(rows, 16), &next = row_of(rows, 36);
    report.claims.push_back({"section 6, figure 7",
                             "depth maps are faster only at 4 x 4 samples and fewer",
                             fmt::format("deep over depth: {} times at N = 16, {} times at N = 36",
                                         to_text(sixteen.deep_ns / sixteen.pcf_ns), to_text(next.deep_ns / next.pcf_ns)),
                             both(judge_less(sixteen.pcf_ns, sixteen.deep_ns), judge_less(next.deep_ns, next.pcf_ns)),
                             "Where the times cross depends on the cost of a search against that of a depth test.",
                             {sixteen.deep_ns / sixteen.pcf_ns, next.deep_ns / next.pcf_ns}});
    const Value growth = rows.back().deep_ns / rows[2].deep_ns;
    report.claims.push_back({"section 6, figure 7",
                             "deep lookup times are virtually constant as N grows",
                             fmt::format("N = 256 takes {} times as long as N = 16", to_text(growth)),
                             judge_constant(growth),
                             "16 times the samples would cost 16 times the tests in a depth map.",
                             {growth}});
    const Value size = exactly(rows.back().deep_bytes / rows[2].deep_bytes);
    report.claims.push_back({"section 6, figure 7",
                             "deep maps grow very slowly in size as the error falls: as N^(1/4), section 4",
                             fmt::format("16 times the samples: {} times the bytes", to_text(size)),
                             judge_exponent(0.25, exactly(std::log(size.value) / std::log(16.0))),
                             "The fourth root of 16 is 2; the exponent is that of the bytes.",
                             {size}});
    report.claims.push_back(
        {"section 6",
         "compression overhead is negligible beside sampling",
         fmt::format("at N = 256 sweep and compression take {:.2g} of the capture's time (one thread)",
                     rows.back().build_share),
         judge_negligible(exactly(rows.back().build_share)),
         "Capture here is a projection many times faster than the scanline renderer of the paper.",
         {exactly(rows.back().build_share)}});

    std::vector<std::pair<double, double>> nodes;
    for (const Row& r : rows)
        if (r.samples >= 16) nodes.emplace_back(r.samples, r.nodes);
    const PowerLaw law = fit_power(nodes);
    const Value exponent{law.exponent, law.exponent - 3.18 * law.standard_error,
                         law.exponent + 3.18 * law.standard_error};
    report.claims.push_back({"section 4, figure 8",
                             "vertices a pixel grow as N^(1/4)",
                             fmt::format("as N^{}", to_text(exponent)),
                             judge_exponent(0.25, exponent),
                             "Fitted over N from 16 to 256; the interval is t = 3.18 standard errors (95 %, 5 points).",
                             {exponent}});
    Plot plot{"lokovic2000_figure8", "Vertices a pixel over samples a pixel", "N", "vertices a pixel", true, true, {}};
    Series measured{"measured", nodes, true}, theory{"N^(1/4)", {}, true};
    for (const auto& [n, v] : nodes)
        theory.points.emplace_back(n, nodes.front().second * std::pow(n / nodes.front().first, 0.25));
    plot.series = {measured, theory};
    report.plots.push_back(std::move(plot));
}

void figure_9(const Context& context) {
    PaperReport& report = *context.report;
    const std::vector<int> widths{1, 2, 4, 8, 16, 32};
    const results::Result result = context.run(
        hair_ball,
        {"rays.samples_per_pixel=64", "reference.samples_per_pixel=64", "reference.queries=512",
         fmt::format(R"(sweeps={{"/receivers/filter_width":[{}]}})", fmt::join(widths, ",")),
         set_techniques(
             R"({"type":"deep","mip":"none","kernel":"tent"},{"type":"deep","mip":"nearest","kernel":"tent"},)" +
             pcf(64, "sample"))},
        {"rays.resolution=128"});
    Plot plot{"lokovic2000_figure9",
              "Lookup time over filter width",
              "filter width, share of the map",
              "ns a lookup",
              true,
              true,
              {}};
    const auto series = [&](const char* name, const char* technique, const std::vector<std::string>& parameters) {
        Series s{name, {}, true};
        for (const int width : widths) {
            const LightResult& light = light_of(result, {fmt::format("/receivers/filter_width={}", width)});
            s.points.emplace_back(static_cast<double>(width) / light.layout.width,
                                  time_of(cell_of(light, technique, parameters)).value);
        }
        plot.series.push_back(std::move(s));
    };
    series("depth map, 8 x 8 samples", "pcf", {});
    series("deep map", "deep", {"mip=none"});
    series("deep map with mip levels", "deep", {"mip=nearest"});
    report.plots.push_back(plot);

    const auto over = [&](const char* technique, const std::vector<std::string>& parameters, int from) {
        return time_of(cell_of(light_of(result, {"/receivers/filter_width=32"}), technique, parameters)) /
               time_of(
                   cell_of(light_of(result, {fmt::format("/receivers/filter_width={}", from)}), technique, parameters));
    };
    const Value depth = over("pcf", {}, 1), mip = over("deep", {"mip=nearest"}, 1),
                plain = over("deep", {"mip=none"}, 1);
    report.claims.push_back({"section 6, figure 9",
                             "depth map filtering time grows rapidly with width, at 8 x 8 samples",
                             fmt::format("width 32 takes {} times as long as width 1", to_text(depth)),
                             judge_growth(depth),
                             "The paper's growth is cache misses; here the whole map may stay in the cache.",
                             {depth}});
    report.claims.push_back({"section 6, figure 9",
                             "with mip levels deep filtering time is virtually constant in width",
                             fmt::format("width 32 takes {} times as long as width 1", to_text(mip)),
                             judge_constant(mip),
                             "Each lookup reads the same number of pixels of some level.",
                             {mip}});
    report.claims.push_back({"section 5.3",
                             "without mip levels the number of pixels read grows with the width",
                             fmt::format("width 32 takes {} times as long as width 1", to_text(plain)),
                             judge_exponent(2.0, {std::log(plain.value) / std::log(32.0),
                                                  std::log(plain.low) / std::log(32.0),
                                                  std::log(plain.high) / std::log(32.0)}),
                             "1,024 times the area covers about 1,024 times the functions; the exponent is that of the "
                             "time over the width.",
                             {plain}});
    const LightResult& light = light_of(result, {"/receivers/filter_width=1"});
    const Value size = exactly(static_cast<double>(cell_of(light, "deep", {"mip=nearest"}).bytes) /
                               static_cast<double>(cell_of(light, "deep", {"mip=none"}).bytes));
    report.claims.push_back({"section 5.3",
                             "all mip levels together are about 1.55 times as large as the base",
                             to_text(size) + " times",
                             judge_size(1.55, 4.0 / 3.0, size),
                             "The tolerance is halved from level to level, as the paper suggests.",
                             {size}});
}

void section_5_2(const Context& context) {
    PaperReport& report = *context.report;
    const std::string deep = set_techniques(pixels);
    const results::Result grey = context.run(hair_ball, {deep}, {"rays.resolution=128"});
    const results::Result colour =
        context.run(hair_ball, {"/scene/objects/0/opacity=[0.9,0.6,0.35]", deep}, {"rays.resolution=128"});
    const results::Result one_channel =
        context.run(hair_ball, {"/scene/objects/0/opacity=0.6", deep}, {"rays.resolution=128"});
    const Cell &three = cell_of(light_of(colour), "deep"), &single = cell_of(light_of(one_channel), "deep");
    const Value size = exactly(static_cast<double>(three.bytes) / static_cast<double>(single.bytes));
    report.claims.push_back({"section 5.2",
                             "three-channel maps are only twice as large as one-channel maps",
                             to_text(size) + " times",
                             judge_size(2.0, 3.0, size),
                             "Hair of opacity (0.9, 0.6, 0.35) against hair of opacity 0.6 in one channel.",
                             {size}});
    const bool grey_is_one = light_of(grey).layout.channels == 1;
    report.claims.push_back(
        {"section 5.2",
         "monochrome maps store one channel",
         grey_is_one ? "a grey scene makes a map of one channel" : "a grey scene makes three channels",
         by_construction(grey_is_one),
         "This holds for single pixels too: if the three functions are equal, one is kept.",
         {}});
}

void figure_12(const Context& context) {
    PaperReport& report = *context.report;
    const results::Result moving = context.run("lokovic2000_motion", {}, {"rays.resolution=96"});
    const results::Result still =
        context.run("lokovic2000_motion", {"/scene/objects/0/motion=[0,0,0]"}, {"rays.resolution=96"});
    const Cell &a = cell_of(light_of(moving), "deep"), &b = cell_of(light_of(still), "deep");
    const Value cost = time_of(a) / time_of(b);
    report.claims.push_back(
        {"section 5.5, figure 12",
         "motion blur costs no more at lookup",
         fmt::format("{} times the time of the still sphere; {} against {} bytes", to_text(cost), a.bytes, b.bytes),
         judge_constant(cost),
         "A blurred pixel stores a function of more steps, and is searched in the same way.",
         {cost}});
}

}  // namespace

void measure_lokovic(const Context& context) {
    context.report->conditions =
        "The hair ball is procedural (50,000 curly opaque hairs), lit by one of the paper's three spot lights; the "
        "paper's times are of whole images less the time without shadows, on one processor of its day, and here of "
        "lookups in "
        "image order, on one thread. Errors are against 1024 rays a pixel over the same footprint.";
    figure_6(context);
    figures_7_and_8(context);
    figure_9(context);
    section_5_2(context);
    figure_12(context);
    context.report->sheets.push_back(
        picture_sheet(context, hair_ball,
                      {"rays.resolution=512", "rays.samples_per_pixel=16",
                       set_techniques(pcf(16, "centre") + "," + pcf(16, "sample") + "," + pixels +
                                      R"(,{"type":"deep","tolerance":0.02,"kernel":"tent"})")}));
}

}  // namespace shadowbench::claims
