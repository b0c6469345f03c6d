#include "claims/volume_crossings.h"

#include <cmath>
#include <string>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "base/parallel.h"
#include "claims/intervals.h"
#include "claims/seeded_light.h"
#include "claims/volume_depths.h"
#include "claims/volume_map.h"
#include "claims/volume_rays.h"
#include "metrics/statistics.h"
#include "rays/grid_media.h"

namespace shadowbench::claims::volume {
namespace {

constexpr std::size_t judged = 16384;  // receivers

// The places of the techniques.
enum Place : std::size_t { smooth, bucket, smooth_few, bucket_few, standard };

std::string request(const char* interpolation, int steps) {
    return fmt::format(R"({{"type":"volume_deep","cells":"sample","filter":"point","interpolation":"{}","steps":{}}})",
                       interpolation, steps);
}

// The light at each receiver, without rays or steps.
std::vector<double> exact_light(const SeededLight& light, std::span<const techniques::Query> queries) {
    const rays::GridMedia media(light.scenario().scene, true);
    std::vector<double> result(queries.size());
    base::parallel_for(queries.size(), [&](std::size_t q) {
        const double z = queries[q].z;
        base::Vec3d depth;
        media.optical_depths(light.view(), queries[q].x, queries[q].y, scene::mid_shutter, std::span(&z, 1),
                             std::span(&depth, 1));
        result[q] = std::exp(-depth.x);
    });
    return result;
}

struct Answers {
    std::vector<float> lookups;
    std::vector<double> opacities;  // along view rays
};

template <class Other>
std::vector<double> differences(const std::vector<float>& a, const std::vector<Other>& b) {
    std::vector<double> result(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) result[i] = static_cast<double>(a[i]) - b[i];
    return result;
}

double mean_of_all(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
}

void add_seed(const Answers& of_smooth, const Answers& of_bucket, const std::vector<double>& exact,
              std::span<const render::BoxRay> rays, StepNumbers& numbers) {
    const std::vector<double> smooth_errors = differences(of_smooth.lookups, exact),
                              bucket_errors = differences(of_bucket.lookups, exact);
    numbers.smooth.push_back(metrics::error_norms(smooth_errors).rms);
    numbers.bucket.push_back(metrics::error_norms(bucket_errors).rms);
    numbers.smooth_mean.push_back(mean_of_all(smooth_errors));
    numbers.bucket_mean.push_back(mean_of_all(bucket_errors));
    numbers.apart.push_back(metrics::error_norms(differences(of_smooth.lookups, of_bucket.lookups)).rms);
    numbers.light_apart.push_back(rms(rays, of_smooth.opacities, of_bucket.opacities));
}

// "box 0.1, bucky 0.2, ..."
template <class Number>
std::string list(const std::vector<Crossings>& sets, const Number& number) {
    std::vector<std::string> parts;
    for (const Crossings& set : sets) parts.push_back(fmt::format("{} {}", set.name, to_text(number(set))));
    return fmt::format("{}", fmt::join(parts, ", "));
}

template <class Number>
std::vector<Value> values(const std::vector<Crossings>& sets, const Number& number) {
    std::vector<Value> result;
    for (const Crossings& set : sets) result.push_back(number(set));
    return result;
}

template <class Judge>
std::vector<Judged> judge_each(const std::vector<Value>& numbers, const Judge& judge) {
    std::vector<Judged> cases;
    for (const Value& number : numbers) cases.push_back(judge(number));
    return cases;
}
Judged below_one(const Value& ratio) {
    return judge_less(ratio, exactly(1.0));
}
Judged above_one(const Value& ratio) {
    return judge_less(exactly(1.0), ratio);
}

Value more_error(const Crossings& set) {
    return mean_ratio_of(set.all.bucket, set.all.smooth);
}
Value farther(const Crossings& set) {
    return mean_ratio_of(set.all.bucket_depth, set.all.smooth_depth);
}
Value lookups_apart(const Crossings& set) {
    return mean_of(set.all.apart);
}

Value light_apart(const Crossings& set) {
    return mean_of(set.all.light_apart);
}
Value faster(const Crossings& set) {
    return set.builds.ratio(smooth, bucket);
}

void add_table(const std::vector<Crossings>& sets, PaperReport& report) {
    Table table{fmt::format("Smooth and bucket crossings: rms (and mean) error of lookups of one texel at {} receivers "
                            "against the exact light there, and mean distances of the stored depths from the exact "
                            "ones, in steps of the map; means over {} seeds of jittered light rays, each with a view "
                            "of its own",
                            judged, views),
                {"data", "steps", "smooth", "bucket", "rms, bucket over smooth", "rms difference of both lookups",
                 "rms difference of the average opacities of view rays", "distance of depths, smooth",
                 "distance of depths, bucket"},
                {}};
    for (const Crossings& set : sets)
        for (const auto& [steps, numbers] : {std::pair{map_steps, &set.all}, std::pair{few_steps, &set.few}}) {
            const auto error = [](const std::vector<double>& rms_errors, const std::vector<double>& mean_errors) {
                return fmt::format("{} ({})", to_text(mean_of(rms_errors)), to_text(mean_of(mean_errors)));
            };
            table.rows.push_back({set.name, std::to_string(steps), error(numbers->smooth, numbers->smooth_mean),
                                  error(numbers->bucket, numbers->bucket_mean),
                                  to_text(mean_ratio_of(numbers->bucket, numbers->smooth)),
                                  to_text(mean_of(numbers->apart)), to_text(mean_of(numbers->light_apart)),
                                  to_text(mean_of(numbers->smooth_depth)), to_text(mean_of(numbers->bucket_depth))});
        }
    report.tables.push_back(std::move(table));
}

void bucket_claims(const std::vector<Crossings>& sets, PaperReport& report) {
    const std::vector<Value> errors = values(sets, more_error), depths = values(sets, farther),
                             lookups = values(sets, lookups_apart), view_rays = values(sets, light_apart);
    const Judged less_accurate =
                     in_readings({in_all(judge_each(errors, above_one)), in_all(judge_each(depths, above_one))}),
                 not_noticed = in_readings(
                     {in_most(judge_each(lookups, judge_unnoticed)), in_most(judge_each(view_rays, judge_unnoticed))});
    std::vector<Value> all;
    for (const std::vector<Value>& part : {errors, depths, lookups, view_rays})
        all.insert(all.end(), part.begin(), part.end());
    report.claims.push_back(
        {"section Implementation",
         "recording the step before a crossing is less accurate, in most cases not noticeably",
         fmt::format("bucket over smooth, error rms of lookups: {}; mean distance of the stored depths from the "
                     "exact ones: {}; rms difference of lookups: {}; of the average opacities of view rays: {}",
                     list(sets, more_error), list(sets, farther), list(sets, lookups_apart), list(sets, light_apart)),
         both(less_accurate, not_noticed),
         "Less accurate in all data sets, since the paper says that it will be, read in two ways: of what lookups "
         "answer, and of the depths that the map stores. Not noticed in most, read in two ways: of lookups, and of the "
         "average opacity of a view ray, which darkens its colour. A lookup answers 1 up to the first depth, which is "
         "too bright; the earlier depths of the bucket make up for some of that. The table has both signs.",
         std::move(all)});
    const auto more_steps = [](const Crossings& set) {
        return mean_ratio_of(set.all.light_apart, set.few.light_apart);
    };
    report.claims.push_back({"section Implementation", "the more steps, the less the difference is noticed",
                             fmt::format("rms difference of the average opacities of view rays, {} over {} steps: {}",
                                         map_steps, few_steps, list(sets, more_steps)),
                             in_all(judge_each(values(sets, more_steps), below_one)),
                             "Of the smooth and the bucket map, as in the table.", values(sets, more_steps)});
    report.claims.push_back(
        {"section Implementation", "and it is faster",
         fmt::format("build time smooth over bucket: {}", list(sets, faster)),
         in_all(judge_each(values(sets, faster), above_one)),
         "In all data sets, since the paper says so of none in particular. Maps of 256 x 256 texels from captured "
         "rays; here a step is expensive and the three crossings of a ray are not.",
         values(sets, faster)});
}

void step_claims(const std::vector<Crossings>& sets, PaperReport& report) {
    const auto finer = [](const Crossings& set) { return mean_ratio_of(set.all.smooth, set.few.smooth); };
    report.claims.push_back(
        {"section Implementation, step 3", "the smaller the steps, the better the results",
         fmt::format("error rms of lookups, {} over {} steps: {}", map_steps, few_steps, list(sets, finer)),
         in_all(judge_each(values(sets, finer), below_one)), "Of the smooth map, as in the table.",
         values(sets, finer)});
    const auto share = [](const Crossings& set) { return mean_ratio_of(set.all.smooth, set.shadow_map); };
    report.claims.push_back(
        {"section Introduction",
         "a standard shadow map cannot tell how much light a partially transparent volume lets through; this map can",
         fmt::format("error rms of lookups over that of a standard shadow map: {}", list(sets, share)),
         in_all(judge_each(values(sets, share), [](const Value& v) { return judge_much_less(v, exactly(1.0)); })),
         "The standard map keeps the depth at which a ray enters the volume. Both have the same rays and receivers.",
         values(sets, share)});
}

}  // namespace

Crossings measure_crossings(const Context& context, const DataSet& set) {
    const base::ThreadLimit threads(context.threads);
    const SeededLight light(
        context, set.scenario,
        {"rays.pattern=jittered",
         fmt::format(R"(techniques=[{},{},{},{},{{"type":"shadow_map"}}])", request("smooth", map_steps),
                     request("bucket", map_steps), request("smooth", few_steps), request("bucket", few_steps))},
        {"rays.resolution=128", "receivers.resolution=64"});
    const bench::QuerySet all = light.queries();
    const bench::QuerySet asked = bench::pick(all.asked(), bench::choose_judged(all.queries.size(), judged, 1));
    const std::vector<double> exact = exact_light(light, asked.queries);
    const scene::Scene& scene = light.scenario().scene;
    const auto& grid = std::get<scene::GridVolume>(volume_of(light.scenario()).shape);
    Crossings crossings{set.name, {}, {}, {}, {}};
    for (int view = 0; view < views; ++view) {
        const std::vector<bench::Maps> maps = light.build(view);
        const std::vector<render::BoxRay> rays = view_rays(scene, grid, context.quick ? 32 : 64, view);
        const auto answers = [&](Place place) {
            return Answers{bench::lookup_all(maps[place], asked.asked()),
                           render::mean_opacities(rays, view_lookups, light.view(), maps[place])};
        };
        add_seed(answers(smooth), answers(bucket), exact, rays, crossings.all);
        add_seed(answers(smooth_few), answers(bucket_few), exact, rays, crossings.few);
        const std::vector<TexelRay> texels = texel_rays(scene, light.view(), *maps[smooth].layout);
        crossings.all.smooth_depth.push_back(depth_error(maps[smooth], texels, map_steps));
        crossings.all.bucket_depth.push_back(depth_error(maps[bucket], texels, map_steps));
        crossings.few.smooth_depth.push_back(depth_error(maps[smooth_few], texels, few_steps));
        crossings.few.bucket_depth.push_back(depth_error(maps[bucket_few], texels, few_steps));
        const std::vector<float> standard_lookups = bench::lookup_all(maps[standard], asked.asked());
        crossings.shadow_map.push_back(metrics::error_norms(differences(standard_lookups, exact)).rms);
    }
    const SeededLight timed(context, set.scenario,
                            {"rays.resolution=256", fmt::format("techniques=[{},{}]", request("smooth", map_steps),
                                                                request("bucket", map_steps))},
                            {"rays.resolution=128"});
    crossings.builds = timed.build_turns({}, fixed_rounds);
    return crossings;
}

void add_crossings(const std::vector<Crossings>& sets, PaperReport& report) {
    add_table(sets, report);
    bucket_claims(sets, report);
    step_claims(sets, report);
}

}  // namespace shadowbench::claims::volume
