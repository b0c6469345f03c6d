#include "bench/ray_store.h"

#include <algorithm>
#include <numeric>

#include "base/parallel.h"
#include "base/random.h"
#include "bench/clock.h"

namespace shadowbench::bench {
namespace {

constexpr double enough_for_an_estimate = 0.05;  // seconds
constexpr double guessed_seconds_a_ray = 1e-6;

}  // namespace

RayStore::RayStore(const scene::Scenario& scenario, std::size_t light, const MemoryLimits& limits)
    : scenario_(scenario), light_(light), limits_(limits) {}

std::shared_ptr<const Frame> RayStore::frame(const RayChoice& choice) const {
    const auto [place, is_new] = views_.try_emplace({choice.resolution.x, choice.resolution.y});
    if (is_new)
        place->second = rays::make_light_view(scenario_.lights[light_], scenario_.scene, choice.resolution,
                                              scenario_.lights[light_].where);
    scene::RaySettings settings = scenario_.rays;
    settings.resolution = choice.resolution;
    settings.samples_per_pixel = choice.samples;
    settings.seed = choice.seed;
    auto frame = std::make_shared<Frame>();
    frame->view = place->second;
    frame->layout = rays::make_layout(scenario_.scene, frame->view, settings);
    return frame;
}

std::shared_ptr<const StoredRays> RayStore::rays(const RayChoice& choice, const techniques::RayNeeds& needs) {
    const auto found =
        std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) { return entry.choice == choice; });
    if (found != entries_.end()) {
        const rays::MapLayout& layout = found->rays->frame->layout;
        if (layout.apron >= needs.apron && (layout.submission || !needs.submission)) {
            entries_.splice(entries_.begin(), entries_, found);
            return entries_.front().rays;
        }
        entries_.erase(found);
    }
    drop_beyond(limits_.kept_rays / 2);  // the other half is for those that are captured now
    const Stopwatch stopwatch;
    std::shared_ptr<const StoredRays> rays = capture(choice, needs);
    seconds_ += stopwatch.seconds();
    rays_captured_ += static_cast<double>(rays->source->rays());
    entries_.push_front({choice, rays, rays->source->kept() ? rays->source->bytes() : 0});
    return rays;
}

bool RayStore::kept(const RayChoice& choice) const {
    return std::any_of(entries_.begin(), entries_.end(), [&](const Entry& entry) { return entry.choice == choice; });
}

double RayStore::estimate_seconds(const RayChoice& choice) const {
    const double rays = static_cast<double>(choice.resolution.x) * choice.resolution.y * choice.samples;
    return rays * (rays_captured_ > 0.0 ? seconds_ / rays_captured_ : guessed_seconds_a_ray);
}

double RayStore::seconds_on_one_thread(const StoredRays& rays, double enough, std::uint64_t draw) {
    const base::ThreadLimit one_thread(1);
    std::vector<int> tiles(static_cast<std::size_t>(rays.frame->layout.tiles()));
    std::iota(tiles.begin(), tiles.end(), 0);
    base::Random random(base::hash(draw));
    std::size_t done = 0;
    const Stopwatch stopwatch;
    do {
        std::swap(tiles[done], tiles[done + random.below(tiles.size() - done)]);
        rays.capture->tile(tiles[done++]);
    } while (done < tiles.size() && stopwatch.seconds() < enough);
    return stopwatch.seconds() * static_cast<double>(tiles.size()) / static_cast<double>(done);
}

std::shared_ptr<const StoredRays> RayStore::capture(const RayChoice& choice, const techniques::RayNeeds& needs) const {
    auto rays = std::make_shared<StoredRays>();
    auto framed = std::make_shared<Frame>(*frame(choice));
    framed->layout.apron = needs.apron;
    framed->layout.submission = needs.submission;
    rays->frame = framed;
    {
        const base::ThreadLimit one_thread(1);
        const Stopwatch setup;
        rays->capture = std::make_unique<rays::Capture>(scenario_.scene, framed->view, framed->layout);
        rays->setup_seconds = setup.seconds();
    }
    rays->capture_seconds = seconds_on_one_thread(*rays, enough_for_an_estimate, choice.seed);
    rays->source =
        std::make_unique<RaySource>(*rays->capture, framed->layout, limits_.kept_rays / 2, RaySource::Watch());
    return rays;
}

// Drops the longest unused rays until the others take at most this many bytes. Each also holds the scene as prepared
// for its light, which can be large; so at most 16 are kept.
void RayStore::drop_beyond(std::size_t bytes) {
    constexpr std::size_t most_entries = 16;
    std::size_t sum = 0;
    for (const Entry& entry : entries_) sum += entry.bytes + entry.rays->capture->bytes();
    while (!entries_.empty() && (sum > bytes || entries_.size() >= most_entries)) {
        sum -= entries_.back().bytes + entries_.back().rays->capture->bytes();
        entries_.pop_back();
    }
}

}  // namespace shadowbench::bench
