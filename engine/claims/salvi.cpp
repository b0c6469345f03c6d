// Salvi, Vidimce, Lauritzen, Lefohn, Adaptive Volumetric Shadow Maps, 2010: section 5.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "claims/paper.h"
#include "claims/sheet.h"
#include "claims/texel.h"

namespace shadowbench::claims {
namespace {

using results::Cell;
using results::LightResult;

// A column of table 1: the paper's milliseconds on a Radeon 5870 (lookup, compression) and megabytes (of the map).
struct Column {
    const char* name;
    const char* technique;
    std::vector<std::string> parameters;
    double lookup_ms, build_ms, megabytes;  // 0: not given
};
const Column columns[] = {
    {"AVSM 4", "avsm", {"nodes=4", "order=sorted"}, 3.0, 0.5, 2.0},
    {"AVSM 8", "avsm", {"nodes=8", "order=sorted"}, 5.4, 0.7, 4.0},
    {"AVSM 16", "avsm", {"nodes=16", "order=sorted"}, 9.5, 1.6, 8.0},
    {"OSM 32", "opacity", {}, 1.4, 1.0, 8.0},
    {"FOM 16", "fourier", {}, 8.9, 1.1, 8.0},
    {"DSM 0.01", "deep", {}, 52.0, 193.0, 40.0},
    {"uncompressed", "uncompressed", {}, 278.0, 0.0, 20.0},
};

const Cell& avsm(const LightResult& light, int nodes, const char* order = "sorted") {
    return cell_of(light, "avsm", {fmt::format("nodes={}", nodes), fmt::format("order={}", order)});
}

std::string ratio_text(double theirs, const Value& ours) {
    return theirs > 0.0 ? fmt::format("{:.3g}", theirs) + " / " + to_text(ours) : "- / " + to_text(ours);
}

// Every column as a ratio to AVSM 8, the paper's value beside ours.
void table_1(const LightResult& light, PaperReport& report) {
    const Cell& eight = avsm(light, 8);
    Table table{fmt::format("Table 1: ratios to AVSM 8, theirs / ours ({} x {} texels)", light.layout.width,
                            light.layout.height),
                {"", "lookup", "build", "bytes", "ns a lookup here", "x floor", "ms a build here", "MiB here",
                 "error rms", "curve error max"},
                {}};
    for (const Column& c : columns) {
        const Cell& cell = cell_of(light, c.technique, c.parameters);
        const double bytes = static_cast<double>(cell.bytes) / static_cast<double>(eight.bytes);
        table.rows.push_back({c.name, ratio_text(c.lookup_ms / 5.4, time_of(cell) / time_of(eight)),
                              ratio_text(c.build_ms / 0.7, of(cell.times->build_ms) / of(eight.times->build_ms)),
                              ratio_text(c.megabytes / 4.0, exactly(bytes)), to_text(time_of(cell)),
                              cell.times->image_order.ratio ? to_text(of(*cell.times->image_order.ratio)) : "-",
                              to_text(of(cell.times->build_ms)),
                              fmt::format("{:.3g}", static_cast<double>(cell.bytes) / 1048576.0),
                              to_text(error_of(cell)),
                              fmt::format("{:.3g}", cell.curve ? cell.curve->norms.max : 0.0)});
        if (&cell == &eight) continue;
        const Value lookup = time_of(cell) / time_of(eight);
        report.claims.push_back(
            {"section 5.3, table 1",
             fmt::format("{} looks up in {:.2g} times AVSM 8's time", c.name, c.lookup_ms / 5.4),
             to_text(lookup) + " times",
             not_comparable(),
             "Theirs is a GPU's shader, ours one thread of a processor; both bilinear, over the same texels.",
             {lookup}});
        if (c.build_ms == 0.0) continue;
        const Value build = of(cell.times->build_ms) / of(eight.times->build_ms);
        report.claims.push_back({"section 5.3, table 1",
                                 fmt::format("{} builds in {:.2g} times AVSM 8's time", c.name, c.build_ms / 0.7),
                                 to_text(build) + " times",
                                 not_comparable(),
                                 "Our times exclude capture, and segments come sorted.",
                                 {build}});
    }
    report.tables.push_back(std::move(table));
}

void memory(const LightResult& light, PaperReport& report) {
    for (const auto& [nodes, megabytes] : {std::pair{4, 2.0}, {8, 4.0}, {16, 8.0}}) {
        const Value size = exactly(static_cast<double>(avsm(light, nodes).bytes) / 1048576.0);
        const double texels = static_cast<double>(light.layout.width) * light.layout.height / 65536.0;
        report.claims.push_back(
            {"section 5.3, table 1",
             fmt::format("an AVSM of {} nodes takes {:.0f} MB at 256 x 256", nodes, megabytes),
             fmt::format("{} MiB at {} x {}", to_text(size), light.layout.width, light.layout.height),
             by_construction(std::abs(size.value / (megabytes * texels) - 1.0) < 0.05),
             "8 bytes a node, all nodes of all texels.",
             {size}});
    }
}

void quality(const LightResult& light, PaperReport& report) {
    const Cell &eight = avsm(light, 8), &osm = cell_of(light, "opacity"), &fom = cell_of(light, "fourier");
    const double other = std::min(osm.curve->norms.rms, fom.curve->norms.rms);
    report.claims.push_back(
        {"section 5.1, figure 4",
         "AVSM 8 is much closer to the uncompressed result than OSM 32 and FOM 16",
         fmt::format("curve error rms {:.3g} against {:.3g} and {:.3g}", eight.curve->norms.rms, osm.curve->norms.rms,
                     fom.curve->norms.rms),
         judge_much_less(exactly(eight.curve->norms.rms), exactly(other)),
         "Root mean square over texels of each texel's largest error.",
         {exactly(eight.curve->norms.rms), exactly(osm.curve->norms.rms), exactly(fom.curve->norms.rms)}});
    const Value four = error_of(avsm(light, 4)), closer = error_of(eight), twelve = error_of(avsm(light, 12)),
                all = error_of(cell_of(light, "uncompressed"));
    report.claims.push_back({"section 5.2",
                             "4 nodes deviate clearly, 8 match closely, 12 often match almost exactly",
                             fmt::format("lookup error rms {}, {}, {}; uncompressed {}", to_text(four), to_text(closer),
                                         to_text(twelve), to_text(all)),
                             both(both(judge_visible(four / all), judge_less(closer, four)),
                                  both(judge_alike(closer, all), judge_alike(twelve, all))),
                             "The uncompressed error is that of one ray a texel.",
                             {four, closer, twelve, all}});
    for (const int nodes : {4, 8}) {
        const Value sorted = error_of(avsm(light, nodes)), captured = error_of(avsm(light, nodes, "captured")),
                    shuffled = error_of(avsm(light, nodes, "shuffled"));
        const Value least_one = least(sorted, least(captured, shuffled)),
                    largest_one = largest(sorted, largest(captured, shuffled));
        report.claims.push_back({"section 4.1",
                                 fmt::format("with {} nodes, errors from not sorting are {}", nodes,
                                             nodes >= 8 ? "mostly imperceptible" : "visible"),
                                 fmt::format("lookup error rms sorted {}, as captured {}, shuffled {}", to_text(sorted),
                                             to_text(captured), to_text(shuffled)),
                                 nodes >= 8 ? judge_alike(largest_one, least_one) : judge_visible(largest_one / least_one),
                                 "The spread between orders of insertion of the same segments.",
                                 {sorted, captured, shuffled}});
    }
    const Value slower = time_of(cell_of(light, "deep")) / time_of(eight);
    const Value build = of(cell_of(light, "deep").times->build_ms) / of(eight.times->build_ms);
    report.claims.push_back({"section 5",
                             "AVSM is one to two orders of magnitude faster than deep shadow maps",
                             fmt::format("building {} times, lookup {} times as fast", to_text(build), to_text(slower)),
                             both(judge_gain(10.0, build), judge_gain(10.0, slower)),
                             "Theirs were linked lists on a GPU; here a deep map is one array, searched in a few "
                             "steps, and shorter than AVSM's nodes where little happens.",
                             {build, slower}});
}

// The same smoke within its own depth range, and with one puff far behind it.
void depth_range(const Context& context, const LightResult& near) {
    const results::Result result = context.run("salvi2010_depth", {}, {"rays.resolution=128"});
    const LightResult& with_puff = light_of(result);
    const auto growth = [&](const char* technique, const std::vector<std::string>& parameters) {
        return cell_of(with_puff, technique, parameters).curve->norms.rms /
               cell_of(near, technique, parameters).curve->norms.rms;
    };
    const double nodes = growth("avsm", {"nodes=8", "order=sorted"}), slices = growth("opacity", {}),
                 terms = growth("fourier", {});
    context.report->claims.push_back(
        {"section 5.1",
         "AVSM's quality is much less affected by the depth range of the occluders than OSM's and FOM's",
         fmt::format(
             "with {:.1f} times the depth range curve errors rms grow by {:.2f} (AVSM 8), {:.2f} (OSM 32), {:.2f} "
             "(FOM 16)",
             (with_puff.layout.z_max - with_puff.layout.z_min) / (near.layout.z_max - near.layout.z_min), nodes, slices,
             terms),
         judge_much_less(exactly(nodes), exactly(std::min(slices, terms))),
         "One puff far behind the smoke stretches the range over which slices and terms are spread evenly.",
         {exactly(nodes), exactly(slices), exactly(terms)}});
}

// Hair in smoke: steps and slopes over a large depth range.
void figure_5(const Context& context) {
    const results::Result result = context.run("salvi2010_hair", {}, {"rays.resolution=128"});
    const LightResult& light = light_of(result);
    const auto rms = [&](const char* technique) { return cell_of(light, technique).curve->norms.rms; };
    const double nodes = rms("avsm"), slices = rms("opacity"), terms = rms("fourier");
    context.report->claims.push_back(
        {"section 5.1, figure 5",
         "with hair in smoke AVSM 12 is nearly exact, OSM 32 and FOM 16 show substantial artifacts",
         fmt::format("curve error rms {:.3g} against {:.3g} and {:.3g}", nodes, slices, terms),
         judge_much_less(exactly(nodes), exactly(std::min(slices, terms))),
         "Slices smear a step over their interval, and a series rings at it.",
         {exactly(nodes), exactly(slices), exactly(terms)}});
}

enum class Figure { smoke_and_hair, puffs };

void curve_figure(const Context& context, const char* scenario, const char* name, const char* place, Figure figure) {
    PaperReport& report = *context.report;
    const TexelCurves curves = busiest_texel(context.document(scenario), context.data);
    Plot plot{name,
              fmt::format("Transmittance of texel ({}, {})", curves.x, curves.y),
              "depth from light",
              "transmittance",
              false,
              false,
              curves.series};
    report.plots.push_back(std::move(plot));
    Table table{fmt::format("{}: largest error of each curve", place), {"curve", "largest error"}, {}};
    const auto error = [&](const char* start) {
        for (std::size_t i = 0; i < curves.error.size(); ++i)
            if (curves.series[i].name.starts_with(start)) return curves.error[i];
        throw base::Error(base::ErrorCode::internal, scenario, fmt::format("there is no curve \"{}...\"", start));
    };
    for (std::size_t i = 0; i < curves.error.size(); ++i)
        table.rows.push_back({curves.series[i].name, fmt::format("{:.3g}", curves.error[i])});
    report.tables.push_back(std::move(table));
    const double twelve = error("avsm nodes=12");
    const std::string on = fmt::format("on a curve of {} segments", curves.segments);
    const char* texel = "The texel has the most segments of those that are not dark by half their depth.";
    if (figure == Figure::smoke_and_hair) {
        const double slices = error("opacity"), terms = error("fourier");
        report.claims.push_back(
            {place, "AVSM of 12 nodes matches a curve of 238 nodes much more closely than slices or terms",
             fmt::format("largest error {:.3g} against {:.3g} (OSM 32) and {:.3g} (FOM 16) {}", twelve, slices, terms, on),
             judge_much_less(exactly(twelve), exactly(std::min(slices, terms))), texel,
             {exactly(twelve), exactly(slices), exactly(terms)}});
        const double deep = error("deep");
        report.claims.push_back({place, "and is similar to the deep shadow map",
                                 fmt::format("largest error {:.3g} against {:.3g} {}", twelve, deep, on),
                                 both(judge_fit(exactly(twelve)), judge_fit(exactly(deep))), texel,
                                 {exactly(twelve), exactly(deep)}});
    } else {
        const double sixteen = error("avsm nodes=16");
        report.claims.push_back({place, "12 and 16 nodes produce a close fit to a curve of 282 nodes",
                                 fmt::format("largest error {:.3g} and {:.3g} {}", twelve, sixteen, on),
                                 both(judge_fit(exactly(twelve)), judge_fit(exactly(sixteen))), texel,
                                 {exactly(twelve), exactly(sixteen)}});
    }
}

}  // namespace

void measure_salvi(const Context& context) {
    context.report->conditions =
        "Three procedural smoke columns, one light ray a texel, on one thread of a processor where the paper used a "
        "GPU (Radeon 5870): times are given as ratios to AVSM with 8 nodes. Lookups are bilinear over four texels. The "
        "scene "
        "with smoke and hair and the game level of the paper are not public.";
    const results::Result result = context.run("salvi2010_smoke", {}, {"rays.resolution=128"});
    const LightResult& light = light_of(result);
    table_1(light, *context.report);
    memory(light, *context.report);
    quality(light, *context.report);
    depth_range(context, light);
    figure_5(context);
    curve_figure(context, "salvi2010_hair", "salvi2010_figure6", "section 5.2, figure 6", Figure::smoke_and_hair);
    context.report->sheets.push_back(picture_sheet(
        context, "salvi2010_smoke",
        {R"(techniques=[{"type":"avsm","cells":"sample","nodes":4,"filter":"bilinear"},{"type":"avsm","cells":"sample","filter":"bilinear"},)"
         R"({"type":"avsm","cells":"sample","nodes":12,"filter":"bilinear"},{"type":"opacity","cells":"sample","filter":"bilinear"},)"
         R"({"type":"fourier","cells":"sample","filter":"bilinear"}])"}));
    curve_figure(context, "salvi2010_curves", "salvi2010_figure7", "section 5.2, figure 7", Figure::puffs);
}

}  // namespace shadowbench::claims
