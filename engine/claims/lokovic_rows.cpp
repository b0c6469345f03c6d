#include "claims/lokovic_rows.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <string>

#include <fmt/format.h>

#include "bench/lookup_timing.h"
#include "claims/answers_over_seeds.h"
#include "claims/lokovic.h"
#include "claims/lokovic_filtering.h"
#include "claims/seeded_light.h"

namespace shadowbench::claims::lokovic {
namespace {

using results::Cell;
using results::LightResult;
using techniques::Query;

std::vector<std::string> settings(int samples, const std::string& techniques) {
    return {fmt::format("rays.samples_per_pixel={}", samples), "reference.samples_per_pixel=256",
            set_techniques(techniques)};
}

std::string both_maps(int samples) {
    return published_deep() + "," + pcf(samples, "sample");
}

Row measure_row(const Context& context, int samples) {
    const std::string more = "," + published_deep("pixels") + R"(,{"type":"deep","tolerance":0})";
    const results::Result result = context.run(ball_scene, settings(samples, both_maps(samples) + more), smaller_row());
    const LightResult& light = light_of(result);
    const Cell &deep = cell_of(light, "deep", {"compression=published", "kernel=box"}),
               &nearest = cell_of(light, "deep", {"compression=published", "kernel=pixels"}),
               &lossless = cell_of(light, "deep", {"compression=bounded"}), &depth = cell_of(light, "pcf");
    return {samples,        bytes_of(deep),  bytes_of(depth),   bytes_of(lossless),
            error_of(deep), error_of(depth), error_of(nearest), deep.nodes.mean()};
}

// The maps of a row in the order of Rows, and a fourth: the depth map filtered over all its samples. In the middle of a
// pixel that one answers the pixel's function before it is compressed.
enum Map { deep_map, depth_map, nearest_map, all_of_depth_map };

struct Built {
    Built(const Context& context, int samples)
        : light(context, ball_scene,
                settings(samples,
                         both_maps(samples) + "," + published_deep("pixels") + "," + placed_pcf(samples, "subset")),
                {}),
          maps(light.build(0)) {}

    SeededLight light;
    std::vector<bench::Maps> maps;  // of the scenario's own seed
};

// In the picture's pixels, moved to the middles of the map's.
std::vector<Query> middles_of(const bench::QuerySet& image) {
    std::vector<Query> middles;
    for (const std::size_t i : bench::choose_judged(image.queries.size(), 2048, 1)) {
        const Query& q = image.queries[i];
        middles.push_back({std::floor(q.x) + 0.5f, std::floor(q.y) + 0.5f, q.z, 1.0f});
    }
    return middles;
}

AtMiddles measure_middles(const Built& built, int samples, std::span<const Query> middles, const bench::Truth& truth) {
    const double tolerance = 0.25 / std::sqrt(static_cast<double>(samples));
    AtMiddles found;
    AnswersOverSeeds deep(truth), depth(truth), uncompressed(truth);
    const auto add = [&](const std::vector<bench::Maps>& maps) {
        const std::vector<float> answers = bench::lookup_all(maps[deep_map], middles),
                                 all = bench::lookup_all(maps[all_of_depth_map], middles);
        for (std::size_t q = 0; q < middles.size(); ++q)
            found.difference =
                std::max(found.difference, std::abs(static_cast<double>(answers[q]) - all[q]) / tolerance);
        deep.add(answers);
        uncompressed.add(all);
        depth.add(bench::lookup_all(maps[depth_map], middles));
    };
    add(built.maps);
    for (int seed = 1; seed < ray_seeds; ++seed) add(built.light.build(seed));
    found.depth_error = depth.rms();
    found.ratio = deep.over(depth);
    found.compressed = deep.over(uncompressed);
    return found;
}

Turns time_lookups(const std::vector<std::unique_ptr<const Built>>& rows, const bench::QuerySet& image) {
    const bench::QuerySet asked = bench::pick(image.asked(), bench::choose_runs(image.queries.size(), 8192));
    std::vector<TimedLookups> timed;
    std::vector<Compared> compared{{Rows::depth(most), Rows::depth(few)}};
    for (std::size_t row = 0; row < rows.size(); ++row) {
        for (const Map map : {deep_map, depth_map, nearest_map})
            timed.push_back({&rows[row]->maps[map], asked.asked()});
        for (const std::size_t deep : {Rows::deep(row), Rows::nearest(row)})
            compared.push_back({deep, Rows::depth(row)});
        for (std::size_t fewer = 0; fewer < std::min(row, few + 1); ++fewer) {
            compared.push_back({Rows::deep(row), Rows::deep(fewer)});
            compared.push_back({Rows::nearest(row), Rows::nearest(fewer)});
        }
    }
    return lookup_turns(timed, compared);
}

}  // namespace

Rows measure_rows(const Context& context) {
    Rows found;
    for (const int samples : all_samples) found.rows.push_back(measure_row(context, samples));
    std::vector<std::unique_ptr<const Built>> built;
    for (const int samples : all_samples) built.push_back(std::make_unique<const Built>(context, samples));
    const bench::QuerySet image = built.back()->light.queries();  // the same for all
    const std::vector<Query> middles = middles_of(image);
    const bench::Truth truth = built.back()->light.truth(middles);
    found.ns = time_lookups(built, image);
    for (std::size_t row = 0; row < built.size(); ++row)
        found.middles.push_back(measure_middles(*built[row], all_samples[row], middles, truth));
    return found;
}

std::vector<std::string> settings_of_row(int samples) {
    return settings(samples, both_maps(samples));
}

std::vector<std::string> smaller_row() {
    return {"reference.samples_per_pixel=64", "reference.spread_seeds=0"};
}

}  // namespace shadowbench::claims::lokovic
