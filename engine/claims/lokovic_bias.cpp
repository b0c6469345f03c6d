// Lokovic and Veach, Deep Shadow Maps, 2000: section 4, incorrect self-shadowing.
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/parallel.h"
#include "claims/intervals.h"
#include "claims/lokovic.h"
#include "claims/lokovic_filtering.h"
#include "claims/seeded_light.h"

namespace shadowbench::claims::lokovic {
namespace {

constexpr int bias_widths[] = {1, 2, 4, 8};  // pixels
constexpr std::size_t width_count = std::size(bias_widths);

// The mean shadow of all receivers in the maps of each seed: of the deep map, whose pixels are weighted by their
// covered parts or by their centres, and of the depth map.
struct FalseShadow {
    std::vector<double> deep, centres, depth;  // [seed]

    Value ratio() const { return mean_ratio_of(deep, depth); }
    Value centres_ratio() const { return mean_ratio_of(centres, depth); }
};

double mean_shadow(const bench::Maps& map, const std::vector<techniques::Query>& queries) {
    double shadow = 0.0;
    for (const float visibility : bench::lookup_all(map, queries)) shadow += 1.0 - visibility;
    return shadow / static_cast<double>(queries.size());
}

// Only the ground and the backdrop cast shadows, and the light reaches all of both: every shadow is false. The bias is
// small enough to leave some.
std::vector<FalseShadow> measure(const Context& context) {
    const SeededLight light(
        context, ball_scene,
        {"/scene/objects/0/casts_shadow=false", "receivers.bias=0.005", "rays.samples_per_pixel=64",
         set_techniques(published_deep() + "," + published_deep("pixels") + "," + pcf(64, "sample"))},
        {"rays.resolution=128"});
    const bench::QuerySet all = light.queries();
    bench::QuerySet asked = bench::pick(all.asked(), bench::choose_judged(all.queries.size(), 8192, 1));
    std::vector<FalseShadow> found(width_count);
    for (int seed = 0; seed < ray_seeds; ++seed) {
        const std::vector<bench::Maps> maps = light.build(seed);
        for (std::size_t w = 0; w < width_count; ++w) {
            for (techniques::Query& query : asked.queries) query.width = static_cast<float>(bias_widths[w]);
            found[w].deep.push_back(mean_shadow(maps[0], asked.queries));
            found[w].centres.push_back(mean_shadow(maps[1], asked.queries));
            found[w].depth.push_back(mean_shadow(maps[2], asked.queries));
        }
    }
    return found;
}

}  // namespace

void biases(const Context& context) {
    const base::ThreadLimit threads(context.threads);
    const std::vector<FalseShadow> found = measure(context);
    Table table{
        "Section 4: false shadow on a lit ground and backdrop, with a bias of 0.005; means over three seeds of "
        "the light rays",
        {"filter width, pixels", "deep map", "deep map by pixel centres", "depth map", "deep / depth",
         "by pixel centres / depth"},
        {}};
    std::vector<Judged> no_worse, centres_no_worse;
    std::vector<Value> ratios;
    std::string text, centres_text;
    for (std::size_t w = 0; w < width_count; ++w) {
        const Value ratio = found[w].ratio(), centres_ratio = found[w].centres_ratio();
        table.rows.push_back({std::to_string(bias_widths[w]), to_text(mean_of(found[w].deep)),
                              to_text(mean_of(found[w].centres)), to_text(mean_of(found[w].depth)), to_text(ratio),
                              to_text(centres_ratio)});
        no_worse.push_back(judge_alike(largest(ratio, exactly(1.0)), exactly(1.0)));
        centres_no_worse.push_back(judge_alike(largest(centres_ratio, exactly(1.0)), exactly(1.0)));
        ratios.insert(ratios.end(), {ratio, centres_ratio});
        const char* between = w == 0 ? "" : ", ";
        text += fmt::format("{}{} over {} pixels", between, to_text(ratio), bias_widths[w]);
        centres_text += between + to_text(centres_ratio);
    }
    context.report->tables.push_back(std::move(table));
    context.report->claims.push_back(
        {"section 4",
         "bias problems are no worse than they would be for an ordinary shadow map at the same filter width",
         fmt::format(
             "false shadow of the deep map over that of a depth map of as many samples: {}; by pixel centres {}", text,
             centres_text),
         in_readings({in_all(no_worse), in_all(centres_no_worse)}),
         "Less counts as alike. Two readings of the deep map's filter. Both read whole functions: by covered parts the "
         "filter reaches up to a pixel further to each side than one of the same width over depths, by centres up to "
         "half a pixel.",
         std::move(ratios)});
}

}  // namespace shadowbench::claims::lokovic
