#include "bench/ray_source.h"

#include <algorithm>
#include <utility>

#include "base/parallel.h"
#include "bench/clock.h"

namespace shadowbench::bench {
namespace {

bool any_light(const rays::LightRays& tile) {
    return std::any_of(tile.transmittance.begin(), tile.transmittance.end(), [](float t) { return t > 0.0f; });
}

}  // namespace

RaySource::RaySource(const rays::Capture& capture, const rays::MapLayout& layout, std::size_t keep_budget,
                     const Watch& watch)
    : capture_(capture), layout_(layout) {
    std::vector<rays::LightRays> batch;
    for (int first = 0; first < layout_.tiles();) {
        const Stopwatch stopwatch;
        capture_from(first, batch);
        seconds_ += stopwatch.seconds();
        first += static_cast<int>(batch.size());
        for (rays::LightRays& tile : batch) {
            rays_ += tile.rays();
            segments_ += tile.segments();
            bytes_ += tile.bytes();
            translucent_ = translucent_ || any_light(tile);
            if (kept_ && bytes_ > keep_budget) {
                kept_ = false;
                std::vector<rays::LightRays>().swap(tiles_);
            }
            if (kept_) tiles_.push_back(std::move(tile));
        }
        if (watch) watch(static_cast<std::size_t>(first));
    }
}

void RaySource::for_each_batch(const std::function<void(Batch)>& body) const {
    if (kept_) return body(tiles_);
    std::vector<rays::LightRays> batch;
    for (int first = 0; first < layout_.tiles(); first += static_cast<int>(batch.size())) {
        capture_from(first, batch);
        body(batch);
    }
}

void RaySource::capture_from(int first, std::vector<rays::LightRays>& tiles) const {
    const int in_flight = 4 * base::thread_count();  // a few a thread, so that uneven tiles leave no thread idle
    tiles.clear();
    tiles.resize(static_cast<std::size_t>(std::min(in_flight, layout_.tiles() - first)));
    base::parallel_for(tiles.size(), [&](std::size_t i) { tiles[i] = capture_.tile(first + static_cast<int>(i)); });
}

}  // namespace shadowbench::bench
