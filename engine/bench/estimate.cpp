#include "bench/estimate.h"

#include <algorithm>
#include <cmath>

namespace shadowbench::bench {
namespace {

// Seconds of a timed round of a technique: its passes take no longer, however many lookups there are. Passes at random
// make more lookups than a branch predictor learns. Reading the floors takes a share of all.
constexpr double longest_pass = 0.01, least_pass = 0.002, warming = 0.025, warm_passes = 6.0, longest_warm = 0.1,
                 random_lookups = 65536.0, smallest_pass_lookups = 64.0, with_floors = 1.3, longest_warm_builds = 0.5;
// Seconds of a lookup of most techniques, and of each further pixel in its footprint: the mean is that of few slow
// ones.
constexpr double usual_lookup = 0.05e-6, usual_pixel = 0.02e-6;
// What each technique costs however small the map is: its rows, its floors, its checks.
constexpr double technique = 0.03;
// Of a ray of a camera, and of a byte of a file.
constexpr double view_ray = 0.6e-6, file_byte = 15e-9;

// The rounds that a rule makes: as many as it must, and a part of the way to as many as it may, within its seconds.
double rounds_of(const scene::Timing& timing, double seconds_a_round) {
    const double least = timing.repetitions, most = timing.most_repetitions;
    const double beyond = 0.6 * std::max(0.0, std::sqrt(least * std::max(most, least)) - least);
    return least + std::min(beyond, timing.seconds / std::max(seconds_a_round, 1e-9));
}

// The passes of one technique in a round, in image order and at random, with those that warm the caches and the floors.
double passes_of(double lookups, double seconds_a_lookup) {
    const double once = seconds_a_lookup * std::min(lookups, smallest_pass_lookups);
    const double longest = std::max(once, longest_pass);
    const double image = std::min(seconds_a_lookup * lookups, longest);
    if (image > longest_warm) return 2.0 * image;
    const double random = std::max(image, std::min(seconds_a_lookup * random_lookups, longest_pass));
    const double warm = std::clamp(warming, 2.0 * image, warm_passes * image) + 2.0 * random;
    return with_floors * (warm + std::max(image, least_pass) + std::max(random, least_pass));
}

}  // namespace

double estimate_seconds(const LightWork& work, const scene::Timing& timing, int threads) {
    // Of all threads: the truth, the rays and maps of each seed and of the light, and the check of each function.
    const double build = build_seconds(work);
    const double shared =
        truth_seconds(work, work.truth_rays) +
        gather_seconds(work, work.judged, work.truth_samples, work.truth_rays, work.truth_sets) +
        (1.0 + work.spread_seeds) * (capture_seconds(work, work.rays) + build + lookups_seconds(work, work.judged)) +
        work.spread_seeds * gather_seconds(work, work.judged, work.footprint, work.rays, 1.0) + check_seconds(work);
    // Of one thread: the rounds of builds and of lookups. Short builds follow others that warm the caches.
    const bool warm = build <= longest_warm_builds;
    const double lookups = std::min(work.receivers, static_cast<double>(timing.lookups));
    const double usual = usual_lookup + usual_pixel * std::max(0.0, work.footprint / work.samples - 1.0);
    const double slow = passes_of(lookups, work.traced > 0.0 ? traced_lookup_seconds(work) / work.traced : 0.0);
    const double round =
        (warm ? 2.0 : 1.0) * build + work.techniques * work.channels * passes_of(lookups, usual) + work.traced * slow;
    return technique * (work.techniques + work.traced) + shared / threads + compare_seconds(work) +
           (warm ? 0.0 : build) + rounds_of(timing, round) * round;
}

double estimate_reading(std::uint64_t file_bytes) {
    return file_byte * static_cast<double>(file_bytes);
}

double estimate_preparing(const scene::Scenario& scenario, int threads) {
    const scene::Receivers& receivers = scenario.receivers;
    const double seen = receivers.camera ? static_cast<double>(receivers.resolution.x) * receivers.resolution.y : 0.0;
    // A tracer of the casters and one of all objects; for each light the captures of the truth, of its rays and of each
    // further seed.
    double structures = receivers.camera ? 2.0 : 1.0;
    const double captures = 2.0 + std::max(0, scenario.reference.spread_seeds);
    structures += capture_share * captures * static_cast<double>(scenario.lights.size());
    return structures * structure_seconds(scenario.scene) + view_ray * seen / threads;
}

}  // namespace shadowbench::bench
