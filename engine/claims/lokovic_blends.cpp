// Lokovic and Veach, Deep Shadow Maps, 2000: section 5.3, the error of mip levels, and lerping between them.
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/parallel.h"
#include "claims/intervals.h"
#include "claims/lokovic.h"
#include "claims/lokovic_filtering.h"
#include "claims/seeded_light.h"
#include "metrics/statistics.h"

namespace shadowbench::claims::lokovic {
namespace {

// The map without loss, and maps whose lookups are compared with it.
struct Filter {
    const char* name;
    const char* mip;
    const char* from;
};
constexpr Filter filters[] = {{"no levels", "none", "compressed"},
                              {"nearest", "nearest", "compressed"},
                              {"blend", "blend", "compressed"},
                              {"nearest, from samples", "nearest", "samples"},
                              {"blend, from samples", "blend", "samples"}};
constexpr std::size_t nearest = 1, blend = 2;  // places in that list
constexpr int filter_widths[] = {1, 2, 4, 8, 16, 32};

// Widths in map pixels at which a lookup of the nearest level goes to the next one, and how far from them it is asked.
constexpr float changes[] = {3.0f, 6.0f, 12.0f, 24.0f};
constexpr float aside = 1e-3f;

double rms_difference(std::span<const float> a, std::span<const float> b) {
    std::vector<double> differences(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) differences[i] = static_cast<double>(a[i]) - b[i];
    return metrics::error_norms(differences).rms;
}

using OverSeeds = std::vector<double>;

struct Measured {
    std::vector<std::vector<OverSeeds>> error;  // [width][filter]
    std::vector<std::vector<OverSeeds>> jump;   // [change][filter]: how much the answers differ on its two sides

    Measured()
        : error(std::size(filter_widths), std::vector<OverSeeds>(std::size(filters))),
          jump(std::size(changes), std::vector<OverSeeds>(std::size(filters))) {}
};

std::vector<float> answers(const bench::Maps& map, std::vector<techniques::Query>& queries, float width) {
    for (techniques::Query& query : queries) query.width = width;
    return bench::lookup_all(map, queries);
}

Measured measure(const Context& context) {
    std::string list = R"({"type":"deep","tolerance":0})";
    for (const Filter& filter : filters)
        list += fmt::format(R"(,{{"type":"deep","mip":"{}","mip_from":"{}"}})", filter.mip, filter.from);
    const SeededLight light(context, ball_scene,
                            {"rays.samples_per_pixel=64", "rays.resolution=128", set_techniques(list)},
                            {"rays.resolution=64"});
    const bench::QuerySet all = light.queries();
    std::vector<techniques::Query> queries =
        bench::pick(all.asked(), bench::choose_judged(all.queries.size(), 8192, 1)).queries;
    Measured found;
    for (int seed = 0; seed < ray_seeds; ++seed) {
        const std::vector<bench::Maps> maps = light.build(seed);
        for (std::size_t w = 0; w < std::size(filter_widths); ++w) {
            const auto width = static_cast<float>(filter_widths[w]);
            const std::vector<float> truth = answers(maps[0], queries, width);
            for (std::size_t f = 0; f < std::size(filters); ++f)
                found.error[w][f].push_back(rms_difference(answers(maps[f + 1], queries, width), truth));
        }
        for (std::size_t c = 0; c < std::size(changes); ++c)
            for (const std::size_t f : {nearest, blend}) {
                const std::vector<float> below = answers(maps[f + 1], queries, (1.0f - aside) * changes[c]);
                found.jump[c][f].push_back(
                    rms_difference(answers(maps[f + 1], queries, (1.0f + aside) * changes[c]), below));
            }
    }
    return found;
}

// The error of blended levels over that of the nearest one.
Value blend_over_nearest(const std::vector<OverSeeds>& error) {
    return mean_ratio_of(error[blend], error[nearest]);
}

Table table_of(const Measured& found) {
    Table table{
        "Section 5.3: RMS error of mip-mapped lookups over the filter width, in pixels, against the exact mean of "
        "the uncompressed functions under the filter; a map of 128 x 128 pixels, means over three seeds of the light "
        "rays",
        {"width"},
        {}};
    for (const Filter& filter : filters) table.header.push_back(filter.name);
    table.header.push_back("blend / nearest");
    for (std::size_t w = 0; w < std::size(filter_widths); ++w) {
        std::vector<std::string> row{std::to_string(filter_widths[w])};
        for (const OverSeeds& of_seeds : found.error[w]) row.push_back(to_text(mean_of(of_seeds)));
        row.push_back(to_text(blend_over_nearest(found.error[w])));
        table.rows.push_back(std::move(row));
    }
    return table;
}

}  // namespace

void blends(const Context& context) {
    const base::ThreadLimit threads(context.threads);
    const Measured found = measure(context);
    context.report->tables.push_back(table_of(found));
    bool smooth = true;
    std::vector<Value> values;
    std::string jumps, errors;
    for (std::size_t c = 0; c < std::size(changes); ++c) {
        const Value blended = mean_of(found.jump[c][blend]), switched = mean_of(found.jump[c][nearest]);
        smooth = smooth && blended.value < switched.value;
        values.insert(values.end(), {blended, switched});
        jumps += fmt::format("{}{} against {} at {} pixels", c == 0 ? "" : ", ", to_text(blended), to_text(switched),
                             changes[c]);
    }
    for (std::size_t w = 0; w < std::size(filter_widths); ++w) {
        values.push_back(blend_over_nearest(found.error[w]));
        errors += fmt::format("{}{} at {}", w == 0 ? "" : ", ", to_text(values.back()), filter_widths[w]);
    }
    context.report->claims.push_back(
        {"section 5.3",
         "mip-mapped deep shadows are filtered just like mip-mapped textures, including lerping between levels",
         fmt::format("where a filter grows past a change of level by 0.2 %, answers change by rms {}, blended against "
                     "nearest; error rms of blended over that of nearest levels: {} pixels",
                     jumps, errors),
         by_construction(smooth),
         "A blend is continuous in the width, as for textures. The paper claims no smaller error for it: a blend takes "
         "part of the coarser level, and blurs more.",
         std::move(values)});
}

}  // namespace shadowbench::claims::lokovic
