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

// The mean shadow of all receivers in the maps of each seed.
struct FalseShadow {
    std::vector<double> deep, depth, ratio;  // [seed]; deep over depth
};

double mean_shadow(const bench::Maps& map, const std::vector<techniques::Query>& queries) {
    double shadow = 0.0;
    for (const float visibility : bench::lookup_all(map, queries)) shadow += 1.0 - visibility;
    return shadow / static_cast<double>(queries.size());
}

// Only the ground and the backdrop cast shadows, and the light reaches all of both: every shadow is false. The bias is
// small enough to leave some.
std::vector<FalseShadow> measure(const Context& context) {
    const SeededLight light(context, ball_scene,
                            {"/scene/objects/0/casts_shadow=false", "receivers.bias=0.005", "rays.samples_per_pixel=64",
                             set_techniques(published_deep() + "," + pcf(64, "sample"))},
                            {"rays.resolution=128"});
    const bench::QuerySet all = light.queries();
    bench::QuerySet asked = bench::pick(all.asked(), bench::choose_judged(all.queries.size(), 8192, 1));
    std::vector<FalseShadow> found(width_count);
    for (int seed = 0; seed < ray_seeds; ++seed) {
        const std::vector<bench::Maps> maps = light.build(seed);
        for (std::size_t w = 0; w < width_count; ++w) {
            for (techniques::Query& query : asked.queries) query.width = static_cast<float>(bias_widths[w]);
            const double deep = mean_shadow(maps[0], asked.queries), depth = mean_shadow(maps[1], asked.queries);
            found[w].deep.push_back(deep);
            found[w].depth.push_back(depth);
            found[w].ratio.push_back(deep / depth);
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
        {"filter width, pixels", "deep map", "depth map", "deep / depth"},
        {}};
    std::vector<Judged> no_worse;
    std::vector<Value> ratios;
    std::string text;
    for (std::size_t w = 0; w < width_count; ++w) {
        const Value ratio = mean_of(found[w].ratio);
        table.rows.push_back({std::to_string(bias_widths[w]), to_text(mean_of(found[w].deep)),
                              to_text(mean_of(found[w].depth)), to_text(ratio)});
        no_worse.push_back(judge_alike(largest(ratio, exactly(1.0)), exactly(1.0)));
        ratios.push_back(ratio);
        text += fmt::format("{}{} over {} pixels", text.empty() ? "" : ", ", to_text(ratio), bias_widths[w]);
    }
    context.report->tables.push_back(std::move(table));
    context.report->claims.push_back(
        {"section 4",
         "bias problems are no worse than they would be for an ordinary shadow map at the same filter width",
         "false shadow of the deep map over that of a depth map of as many samples: " + text, in_all(no_worse),
         "Less counts as alike. A deep filter reads whole functions, and so reaches up to half a pixel further to each "
         "side than one of the same width over depths.",
         std::move(ratios)});
}

}  // namespace shadowbench::claims::lokovic
