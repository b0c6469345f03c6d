#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/table.h"
#include "results/report.h"
#include "results/settled.h"
#include "results/table_lines.h"

namespace shadowbench::results {
namespace {

using base::bytes_text;
using base::error_text;

constexpr const char* legend =
    "ns/seg: build time per segment of the light rays. image ns, random ns: time of a lookup in image and in random\n"
    "order. x floor: its ratio to reading the same cache lines. x fewest: nodes over the fewest that do within the\n"
    "tolerance without rising. curve max: largest |stored - uncompressed|. lookup: error against the truth. rms 95 %:\n"
    "interval of the RMS expected over seeds of the rays; with ?: of the truth's uncertainty only. front: T certainly\n"
    "no other technique beats it in time (random order) and error, B in bytes and error; T? and B? perhaps none "
    "does.\n";

std::string status_text(const Cell& cell) {
    if (cell.status == CellStatus::failed) return "failed: " + cell.reason;
    return cell.outside_promise ? "ok, but promised for opaque scenes only" : "ok";
}

std::vector<std::string> row_of(const Cell& cell, const LightResult& light) {
    const auto ratio = [](const LookupTimes& times) {
        return times.ratio ? fmt::format("{:.1f}", times.ratio->median) : "-";
    };
    std::vector<std::string> row{title(cell)};
    if (cell.times) {
        const CellTimes& t = *cell.times;
        row.insert(row.end(),
                   {time_text(t.build_ms, light), time_text(t.ns_per_segment), time_text(t.image_order.ns, light),
                    ratio(t.image_order), time_text(t.random_order.ns, light), ratio(t.random_order)});
    } else {
        row.insert(row.end(), 6, "-");
    }
    row.insert(row.end(),
               {bytes_text(cell.bytes), fmt::format("{:.1f}", cell.nodes.mean()), fmt::format("{}", cell.nodes.max),
                cell.nodes.over_fewest ? fmt::format("{:.3f}", cell.nodes.over_fewest->ratio()) : "-"});
    row.push_back(cell.curve ? error_text(cell.curve->norms.max) : "-");
    if (cell.lookup) {
        const metrics::ErrorNorms& e = cell.lookup->norms;
        row.insert(row.end(), {error_text(e.rms), interval_text(*cell.lookup), error_text(e.p99), error_text(e.max)});
    } else {
        row.insert(row.end(), 4, "-");
    }
    row.insert(row.end(), {front_text(cell), status_text(cell)});
    return row;
}

}  // namespace

std::string to_table(const Result& result) {
    std::string text = heading_text(result);
    bool marked = false;
    for (const VariantResult& variant : result.variants) {
        text += settings_lines(variant);
        for (const LightResult& light : variant.lights) {
            base::Table table({"technique", "build ms", "ns/seg", "image ns", "x floor", "random ns", "x floor",
                               "bytes", "nodes mean", "max", "x fewest", "curve max", "lookup rms", "rms 95 %", "p99",
                               "max", "front", "status"});
            for (const Cell& cell : light.cells) table.add(row_of(cell, light));
            const Settling found = settling(light);
            marked = marked || !found.uncertain.empty();
            text += text_above(light, result.times.threads) + table.text("    ") + text_below(light, found);
        }
    }
    return text + legend + (marked ? uncertain_legend : "");
}

}  // namespace shadowbench::results
