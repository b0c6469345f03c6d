#include "bench/ray_source.h"

#include <algorithm>
#include <utility>

#include "base/parallel.h"
#include "bench/clock.h"

namespace shadowbench::bench {
namespace {

// Light fades inside a medium, even if none is left behind it.
bool any_light(const rays::LightRays& tile) {
    for (std::size_t s = 0; s < tile.z_back.size(); ++s)
        if (tile.z_back[s] > tile.z_front[s]) return true;
    return std::any_of(tile.transmittance.begin(), tile.transmittance.end(), [](float t) { return t > 0.0f; });
}

}  // namespace

RaySource::RaySource(const rays::Capture& capture, const rays::MapLayout& layout, std::size_t keep_budget,
                     const Watch& watch)
    : capture_(capture), layout_(layout), budget_(keep_budget), single_pass_(false) {
    std::size_t done = 0;
    Stopwatch stopwatch;
    capture_and_keep(0, [&](std::vector<rays::LightRays>& batch) {
        seconds_ += stopwatch.seconds();
        count(batch);
        if (watch) watch(done += batch.size());
        stopwatch = {};
    });
}

RaySource::RaySource(const rays::Capture& capture, const rays::MapLayout& layout)
    : capture_(capture), layout_(layout), budget_(0), single_pass_(true) {}

void RaySource::count(Batch batch) const {
    for (const rays::LightRays& tile : batch) {
        rays_ += tile.rays();
        segments_ += tile.segments();
        bytes_ += tile.bytes();
        translucent_ = translucent_ || any_light(tile);
    }
}

std::size_t RaySource::kept_bytes() const {
    std::size_t sum = 0;
    for (const auto& [apron, tiles] : tiles_)
        for (const rays::LightRays& tile : tiles) sum += tile.bytes();
    return sum;
}

void RaySource::drop_kept() {
    tiles_.clear();
    budget_ = 0;
}

void RaySource::for_each_batch(int apron, const std::function<void(Batch)>& body) const {
    if (single_pass_)
        capture_all(apron, [&](std::vector<rays::LightRays>& batch) {
            count(batch);
            body(batch);
        });
    else if (kept(apron))
        body(tiles_.at(apron));
    else if (too_large_.contains(apron))
        capture_all(apron, body);
    else
        capture_and_keep(apron, body);
}

// Calls visit with each batch, which it may take. At the end of a batch threads wait for its last tile. So where there
// are several, a batch has many tiles: as many as `most_bytes` hold, if all are as large as the largest so far.
void RaySource::capture_all(int apron, const Visit& visit) const {
    constexpr std::size_t least = 4, most = 32;  // for each thread
    constexpr std::size_t most_bytes = std::size_t{64} << 20;
    const std::size_t threads = static_cast<std::size_t>(base::thread_count());
    const std::size_t tiles = static_cast<std::size_t>(layout_.tiles());
    std::size_t in_flight = least * threads, largest = 1;
    std::vector<rays::LightRays> batch;
    for (std::size_t first = 0; first < tiles;) {
        batch.clear();
        batch.resize(std::min(in_flight, tiles - first));
        base::parallel_for(batch.size(),
                           [&](std::size_t i) { batch[i] = capture_.tile(static_cast<int>(first + i), apron); });
        for (const rays::LightRays& tile : batch) largest = std::max(largest, tile.bytes());
        first += batch.size();
        if (threads > 1) in_flight = std::clamp(most_bytes / largest, least * threads, most * threads);
        visit(batch);
    }
}

void RaySource::capture_and_keep(int apron, const Visit& visit) const {
    std::vector<rays::LightRays> kept;
    std::size_t bytes = 0;
    capture_all(apron, [&](std::vector<rays::LightRays>& batch) {
        visit(batch);
        for (rays::LightRays& tile : batch) {
            bytes += tile.bytes();
            if (bytes <= budget_) kept.push_back(std::move(tile));
        }
        if (bytes > budget_) std::vector<rays::LightRays>().swap(kept);
    });
    if (bytes > budget_) {
        too_large_.insert(apron);
        return;
    }
    budget_ -= bytes;
    tiles_[apron] = std::move(kept);
}

}  // namespace shadowbench::bench
