// The light rays of one light at several resolutions and numbers of samples: captured once for each, and the last ones
// kept.
#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "bench/memory.h"
#include "bench/ray_source.h"
#include "rays/capture.h"
#include "rays/light_rays.h"
#include "rays/light_view.h"
#include "scene/scene.h"
#include "techniques/technique.h"

namespace shadowbench::bench {

// Which light rays of a light.
struct RayChoice {
    rays::Vec2i resolution;
    int samples = 1;  // a pixel
    std::uint64_t seed = 1;

    bool operator==(const RayChoice&) const = default;
};

// How a light sees the scene at one resolution, and the layout of the rays there.
struct Frame {
    rays::LightView view;
    rays::MapLayout layout;
};

// Captured rays. The frame outlives them in the maps that are built from them.
struct StoredRays {
    std::shared_ptr<const Frame> frame;
    std::unique_ptr<const rays::Capture> capture;
    std::unique_ptr<const RaySource> source;
    double setup_seconds = 0.0;    // preparing the scene, on one thread
    double capture_seconds = 0.0;  // of all tiles on one thread, from an even share of them
};

class RayStore {
public:
    // Keeps a reference to the scenario.
    RayStore(const scene::Scenario& scenario, std::size_t light, const MemoryLimits& limits);

    // The layout has no apron.
    std::shared_ptr<const Frame> frame(const RayChoice& choice) const;

    // Captures the rays unless they are kept, and drops the longest unused ones beyond the budget for kept rays. The
    // result stays valid as long as the caller holds it.
    std::shared_ptr<const StoredRays> rays(const RayChoice& choice, const techniques::RayNeeds& needs);
    bool kept(const RayChoice& choice) const;

    // Seconds that capturing these rays takes, from the captures so far; before the first, a guess.
    double estimate_seconds(const RayChoice& choice) const;

    // Captures an even share of the tiles on one thread for about this many seconds, and returns the seconds for all.
    // Another `draw` takes other tiles.
    static double seconds_on_one_thread(const StoredRays& rays, double enough, std::uint64_t draw);

private:
    struct Entry {
        RayChoice choice;
        std::shared_ptr<const StoredRays> rays;
        std::size_t bytes;  // of the tiles in memory
    };
    std::shared_ptr<const StoredRays> capture(const RayChoice& choice, const techniques::RayNeeds& needs) const;
    void drop_beyond(std::size_t bytes);

    const scene::Scenario& scenario_;
    std::size_t light_;
    MemoryLimits limits_;
    mutable std::map<std::pair<int, int>, rays::LightView> views_;  // by resolution
    std::list<Entry> entries_;                                      // the last used one first
    double rays_captured_ = 0.0, seconds_ = 0.0;                    // of all captures, on all threads
};

}  // namespace shadowbench::bench
