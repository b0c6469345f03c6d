#include "bench/light_report.h"

#include <cmath>

namespace shadowbench::bench {

results::LightResult describe_light(const scene::Scenario& scenario, const scene::Light& light,
                                    const rays::MapLayout& layout, const QuerySet& set) {
    results::LightResult result;
    result.name = light.name;
    result.layout = {layout.width, layout.height,   layout.samples_x, layout.samples_y, layout.jittered,
                     layout.seed,  layout.channels, layout.media,     layout.z_min,     layout.z_max};
    result.deep_image = scenario.scene.deep_image.has_value();
    result.receivers = set.queries.size();
    result.dropped = set.dropped;
    return result;
}

void report_capture(const RaySource& source, double setup_seconds, results::LightResult& result) {
    result.rays = source.rays();
    result.segments = source.segments();
    result.ray_bytes = source.bytes();
    result.kept = source.kept();
    result.translucent = source.translucent();
    result.times = {source.seconds(), setup_seconds, static_cast<double>(source.rays()) / source.seconds()};
}

results::ReferenceReport report_reference(const rays::MapLayout& layout, std::span<const techniques::Query> judged,
                                          const Truth& truth) {
    results::ReferenceReport report;
    const metrics::ErrorNorms error = metrics::error_norms(truth.standard_error);
    report.judged = judged.size();
    report.samples_per_pixel = truth.samples_per_pixel;
    report.degrees = truth.degrees;
    report.error_rms = error.rms;
    report.error_max = error.max;
    report.noise_tolerance = 0.5 / std::sqrt(static_cast<double>(layout.samples()));
    return report;
}

}  // namespace shadowbench::bench
