#include "claims/seeded_light.h"

#include <nlohmann/json.hpp>

#include "base/parallel.h"
#include "base/random.h"
#include "bench/camera_points.h"
#include "bench/lookup_timing.h"
#include "claims/intervals.h"
#include "claims/seen.h"
#include "document/document.h"
#include "rays/tracer.h"

namespace shadowbench::claims {

SeededLight::SeededLight(const Context& context, const std::string& name, const std::vector<std::string>& set,
                         const std::vector<std::string>& smaller)
    : loader_(context.data) {
    nlohmann::json document = context.document(name, set);
    if (context.quick)
        for (const std::string& assignment : smaller) document::set_value(document, assignment);
    note_document(context, name, document);
    const document::Variant variant = document::expand(document).front();
    scenario_ = &loader_.load(variant);
    contenders_ = bench::make_contenders(*scenario_, variant);
    light_ = bench::prepare_light(*scenario_, 0, contenders_, {});
    capture_ = std::make_unique<rays::Capture>(scenario_->scene, light_.view, light_.layout);
}

bench::QuerySet SeededLight::queries() const {
    const rays::Tracer all(scenario_->scene, false);
    const std::vector<bench::CameraPoint> seen = bench::camera_points(scenario_->receivers, all);
    return bench::scenario_queries(*scenario_, scenario_->lights.front(), seen, light_.view);
}

std::vector<bench::Maps> SeededLight::build(int seed) const {
    rays::MapLayout layout = light_.layout;
    if (seed > 0) layout.seed = base::hash(layout.seed, static_cast<std::uint64_t>(seed));
    const rays::Capture capture(*capture_, layout.seed);
    std::vector<bench::Maps> maps;
    for (const bench::Contender& contender : contenders_)
        maps.push_back(bench::begin_maps(*contender.row, contender.values, {layout, light_.view, nullptr}));
    base::parallel_for(static_cast<std::size_t>(layout.tiles()), [&](std::size_t t) {
        const rays::LightRays tile = capture.tile(static_cast<int>(t));
        for (bench::Maps& map : maps) bench::add(map, tile);
    });
    for (bench::Maps& map : maps) bench::finish(map);
    return maps;
}

std::vector<Value> lookup_times(std::span<const TimedLookups> all) {
    constexpr int passes = 15;
    std::vector<std::vector<double>> ns(all.size());
    std::vector<float> answers;
    for (int pass = 0; pass <= passes; ++pass)
        for (std::size_t i = 0; i < all.size(); ++i) {
            const auto& [maps, asked] = all[i];
            answers.resize(asked.queries.size() * maps->channels());
            const double seconds = bench::seconds_of_pass(*maps, asked, 1, answers);
            if (pass > 0) ns[i].push_back(1e9 * seconds / static_cast<double>(asked.queries.size()));
        }
    std::vector<Value> times;
    for (std::vector<double>& raw : ns) times.push_back(median_of(std::move(raw)));
    return times;
}

}  // namespace shadowbench::claims
