// Salvi et al. 2010, section 5.3 and table 1: times and memory on the scene of figure 4.
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "claims/salvi.h"
#include "claims/seeded_light.h"

namespace shadowbench::claims::salvi {
namespace {

using results::Cell;
using results::LightResult;

// A column of table 1: the paper's milliseconds on a Radeon 5870 (lookup, compression) and megabytes of the map alone.
// Of the deep map the table gives 40 MB with the buffer of the capture, which is 20 MB in the columns of AVSM.
struct Column {
    const char* name;
    const char* technique;
    std::vector<std::string> parameters;
    double lookup_ms, build_ms, megabytes;  // 0: not given
};
constexpr double capture_megabytes = 20.0;
const Column table_columns[] = {
    {"AVSM 4", "avsm", {"nodes=4"}, 3.0, 0.5, 2.0},
    {"AVSM 8", "avsm", {"nodes=8"}, 5.4, 0.7, 4.0},
    {"AVSM 16", "avsm", {"nodes=16"}, 9.5, 1.6, 8.0},
    {"OSM 32", "opacity", {}, 1.4, 1.0, 8.0},
    {"FOM 16", "fourier", {}, 8.9, 1.1, 8.0},
    {"DSM 0.01", "deep", {}, 52.0, 193.0, 20.0},
    {"uncompressed", "uncompressed", {}, 278.0, 0.0, 20.0},
};

const Cell& avsm(const LightResult& light, int nodes) {
    return cell_of(light, "avsm", {fmt::format("nodes={}", nodes)});
}

double mebibytes(const Cell& cell) {
    return static_cast<double>(cell.bytes) / 1048576.0;
}

std::string ratio_text(double theirs, const Value& ours) {
    return theirs > 0.0 ? fmt::format("{:.3g}", theirs) + " / " + to_text(ours) : "- / " + to_text(ours);
}

// The place of a cell among the techniques.
std::size_t place_of(const Cell& cell, const LightResult& light) {
    return static_cast<std::size_t>(&cell - light.cells.data());
}

const std::vector<std::string> smaller{"rays.resolution=128"};

// Nanoseconds a lookup in the map of each technique.
Turns time_lookups(const Context& context, const LightResult& light) {
    TimedMaps timed;
    timed.add(context, columns, {}, smaller, 8192);
    const std::size_t twelve = place_of(avsm(light, 12), light);
    const Compared judged[] = {{place_of(cell_of(light, "deep"), light), twelve},
                               {place_of(cell_of(light, "uncompressed"), light), twelve},
                               {place_of(avsm(light, 16), light), place_of(avsm(light, 4), light)}};
    return timed.take(judged);
}

// Every column as a ratio to AVSM 8, the paper's value beside ours.
void ratios(const LightResult& light, const Turns& ns, PaperReport& report) {
    const Cell& eight = avsm(light, 8);
    Table table{fmt::format("Table 1: ratios to AVSM 8, theirs / ours ({} x {} texels); bytes are of the map alone, "
                            "theirs allocated, ours used; the floor of a lookup is the time of only reading the cache "
                            "lines that it reads",
                            light.layout.width, light.layout.height),
                {"", "lookup", "build", "bytes", "ns a lookup here", "times its floor", "ms a build here", "MiB here",
                 "error rms", "curve error max"},
                {}};
    for (const Column& c : table_columns) {
        const Cell& cell = cell_of(light, c.technique, c.parameters);
        const double bytes = static_cast<double>(cell.bytes) / static_cast<double>(eight.bytes);
        const std::size_t place = place_of(cell, light);
        const Value lookup = ns.ratio(place, place_of(eight, light));
        table.rows.push_back(
            {c.name, ratio_text(c.lookup_ms / 5.4, lookup), ratio_text(c.build_ms / 0.7, build_ratio(cell, eight)),
             ratio_text(c.megabytes / 4.0, exactly(bytes)), to_text(ns.time(place)),
             cell.times->image_order.ratio ? to_text(of(*cell.times->image_order.ratio)) : "-",
             to_text(of(cell.times->build_ms)), fmt::format("{:.3g}", mebibytes(cell)), to_text(error_of(cell)),
             fmt::format("{:.3g}", cell.curve ? cell.curve->norms.max : 0.0)});
        if (&cell == &eight) continue;
        report.claims.push_back(
            {"section 5.3, table 1",
             fmt::format("{} looks up in {:.3g} times AVSM 8's time", c.name, c.lookup_ms / 5.4),
             to_text(lookup) + " times",
             not_comparable(),
             "Theirs is a GPU's shader, ours one thread of a processor; both bilinear, over the same texels.",
             {lookup}});
        if (c.build_ms == 0.0) continue;
        const Value build = build_ratio(cell, eight);
        report.claims.push_back({"section 5.3, table 1",
                                 fmt::format("{} builds in {:.3g} times AVSM 8's time", c.name, c.build_ms / 0.7),
                                 to_text(build) + " times",
                                 not_comparable(),
                                 "Our times exclude capture, and segments come sorted.",
                                 {build}});
    }
    report.tables.push_back(std::move(table));
}

void memory(const LightResult& light, PaperReport& report) {
    const double texels = static_cast<double>(light.layout.width) * light.layout.height / 65536.0;
    for (const Column& c : table_columns) {
        const Cell& cell = cell_of(light, c.technique, c.parameters);
        const Value size = exactly(mebibytes(cell));
        const std::string technique = c.technique;
        const bool fixed = technique != "deep" && technique != "uncompressed";
        const std::string says =
            technique == "deep"
                ? fmt::format("{} takes {:.0f} MB at 256 x 256, with the {:.0f} MB of the capture's buffer", c.name,
                              c.megabytes + capture_megabytes, capture_megabytes)
                : fmt::format("{} takes {:.0f} MB at 256 x 256", c.name, c.megabytes);
        report.claims.push_back(
            {"section 5.3, table 1", says,
             fmt::format("{} MiB at {} x {}", to_text(size), light.layout.width, light.layout.height),
             fixed ? by_construction(std::abs(size.value / (c.megabytes * texels) - 1.0) < 0.05) : not_comparable(),
             fixed ? "Every texel has the same size: 8 bytes a node, 4 a slice, 8 a term."
                   : "Theirs is the memory that was allocated, not what was used; ours is the map alone, and what it "
                     "uses. Theirs uncompressed is the buffer of the capture.",
             {size}});
    }
}

// What nodes bring, and what they cost.
void more_nodes(const LightResult& light, const Turns& ns, PaperReport& report) {
    constexpr int counts[] = {4, 8, 12, 16};
    std::vector<Value> values;
    std::vector<Judged> better;
    std::string text;
    for (const int nodes : counts) {
        values.push_back(error_of(avsm(light, nodes)));
        if (values.size() > 1) better.push_back(judge_less(values.back(), values[values.size() - 2]));
        text += (text.empty() ? "" : ", ") + to_text(values.back());
    }
    const Cell &few = avsm(light, 4), &many = avsm(light, 16);
    const Value build = build_ratio(many, few), lookup = ns.ratio(place_of(many, light), place_of(few, light));
    values.insert(values.end(), {build, lookup});
    report.claims.push_back(
        {"section 3",
         "more nodes allow for a better approximation and shadows of higher quality, at the expense of storage and "
         "computation",
         fmt::format("error rms {} with 4, 8, 12, 16 nodes; 16 are built in {} times the time of 4 and looked up in {} "
                     "times",
                     text, to_text(build), to_text(lookup)),
         both(in_all(better), in_readings({judge_less(exactly(1.0), build), judge_less(exactly(1.0), lookup)})),
         "The paper gives directions and no sizes. Computation is read as building and as looking up. That storage "
         "grows is so by construction.",
         values});
}

// Two claims about whole methods, whose times a processor can set beside each other: figure 3 has AVSM with 12 nodes.
void speed(const LightResult& light, const Turns& ns, PaperReport& report) {
    const Cell &twelve = avsm(light, 12), &eight = avsm(light, 8), &deep = cell_of(light, "deep"),
               &all = cell_of(light, "uncompressed");
    const std::size_t place = place_of(twelve, light), place_of_deep = place_of(deep, light);
    const Value build = build_ratio(deep, twelve), lookup = ns.ratio(place_of_deep, place),
                build_of_eight = build_ratio(deep, eight),
                lookup_of_eight = ns.ratio(place_of_deep, place_of(eight, light));
    report.claims.push_back(
        {"section 5.2",
         "AVSM is one to two orders of magnitude faster than deep shadow maps",
         fmt::format("12 nodes: building {} times, lookup {} times as fast; 8 nodes: {} and {}", to_text(build),
                     to_text(lookup), to_text(build_of_eight), to_text(lookup_of_eight)),
         both(judge_gain(10.0, build), judge_gain(10.0, lookup)),
         "Judged, as table 1's rows are not: section 5.2 says it of the methods, and a factor of 10 or more should show "
         "on any machine, where a row gives the time of one GPU. Figure 3 says it of \"a GPU implementation of\" deep "
         "shadow maps, and section 5.3 adds that \"it may be possible to create a faster deep shadow map "
         "implementation than ours\": here a deep map is one array, searched in a few steps; theirs were linked lists. "
         "With the 12 nodes of figures 3 and 6, on the scene and with the deep map of table 1.",
         {build, lookup, build_of_eight, lookup_of_eight}});
    const Value plain = ns.ratio(place_of(all, light), place);
    report.claims.push_back(
        {"figure 3",
         "AVSM is one to two orders of magnitude faster than the uncompressed algorithm",
         fmt::format("12 nodes: lookup {} times as fast", to_text(plain)),
         not_comparable(),
         "Figure 3 says it of a GPU implementation, and nowhere of the method. On the scene of table 1, where an "
         "uncompressed lookup searches functions of hundreds of nodes. Theirs has no build to compare.",
         {plain}});
}

// Beside the real-time methods: the times of a frame without the sort, of which the paper gives those of one GPU.
void real_time(const LightResult& light, const Turns& ns, PaperReport& report) {
    const Cell &eight = avsm(light, 8), &slices = cell_of(light, "opacity"), &terms = cell_of(light, "fourier");
    const std::size_t place = place_of(eight, light);
    const Value build_slices = build_ratio(eight, slices), build_terms = build_ratio(eight, terms),
                lookup_slices = ns.ratio(place, place_of(slices, light)),
                lookup_terms = ns.ratio(place, place_of(terms, light));
    report.claims.push_back(
        {"section 5.3",
         "without sorting, AVSM renders in a time nearly identical to that of OSM and FOM (frames of table 1: 12.1 ms "
         "with AVSM 8, 8.6 ms and 15 ms; sorting takes 3 ms)",
         fmt::format("AVSM 8 over OSM 32: build {}, lookup {}; over FOM 16: {} and {}", to_text(build_slices),
                     to_text(lookup_slices), to_text(build_terms), to_text(lookup_terms)),
         not_comparable(),
         "Their frames hold the rendering of the scene, too, of which a map's work is a part. The abstract's "
         "\"performs competitively\" says no more.",
         {build_slices, lookup_slices, build_terms, lookup_terms}});
}

}  // namespace

void table_1(const Context& context) {
    const results::Result result = context.run(columns, {}, smaller, Times::taken);
    const LightResult& light = light_of(result);
    const Turns ns = time_lookups(context, light);
    ratios(light, ns, *context.report);
    memory(light, *context.report);
    more_nodes(light, ns, *context.report);
    speed(light, ns, *context.report);
    real_time(light, ns, *context.report);
}

}  // namespace shadowbench::claims::salvi
