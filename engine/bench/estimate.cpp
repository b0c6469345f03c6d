#include "bench/estimate.h"

#include <algorithm>

namespace shadowbench::bench {
namespace {

// Seconds for capturing one ray, for building it into a map or checking it there, and for one lookup. A ray through
// media has tens of segments.
constexpr double capture = 0.4e-6, build = 0.15e-6, lookup = 1e-6, media_factor = 12.0;

}  // namespace

double estimate_seconds(const scene::Scenario& scenario, const rays::MapLayout& layout, std::size_t techniques) {
    const double pixels = static_cast<double>(layout.width) * layout.height;
    const double rays = pixels * layout.samples();
    const double factor = (layout.media ? media_factor : 1.0) * layout.channels;
    const double repetitions = scenario.timing.repetitions, rows = static_cast<double>(techniques);
    // The truth captures whole tiles around its queries, at most all tiles.
    const double tile = static_cast<double>(layout.tile_width) * layout.tile_height;
    const double touched = std::min(pixels, tile * scenario.reference.queries);
    const double judged = scenario.scene.deep_image ? rays : touched * scenario.reference.samples_per_pixel;
    const double spread = rays * scenario.reference.spread_seeds;
    // Repetitions beyond the least ones, at most for as long as the scenario allows.
    const double repetition = factor * build * rays * rows + 2.0 * lookup * rows * scenario.timing.lookups;
    const double beyond =
        std::min(scenario.timing.seconds, (scenario.timing.most_repetitions - repetitions) * repetition);
    return factor * (capture * (2.0 * rays + judged + spread) +
                     build * rays * rows * (repetitions + 3.0 + scenario.reference.spread_seeds)) +
           lookup * rows *
               (2.0 * repetitions * scenario.timing.lookups +
                (1.0 + scenario.reference.spread_seeds) * scenario.reference.queries) +
           beyond;
}

}  // namespace shadowbench::bench
