// The light rays of a map, for as many passes as needed: kept in memory while they fit a budget, else captured anew.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "rays/capture.h"
#include "rays/light_rays.h"

namespace shadowbench::bench {

class RaySource {
public:
    using Batch = std::span<const rays::LightRays>;
    using Watch = std::function<void(std::size_t tiles_done)>;

    // Captures every tile once, in parallel, and counts. Keeps a reference to `capture`.
    RaySource(const rays::Capture& capture, const rays::MapLayout& layout, std::size_t keep_budget, const Watch& watch);

    // Calls body with the tiles of the map, each once, in order: all at once when they are kept, else a few at a time.
    // Tiles are captured in parallel, before and never during a call of body.
    void for_each_batch(const std::function<void(Batch)>& body) const;

    bool kept() const { return kept_; }
    std::uint64_t rays() const { return rays_; }
    std::uint64_t segments() const { return segments_; }
    std::uint64_t bytes() const { return bytes_; }     // of all tiles
    bool translucent() const { return translucent_; }  // some crossing transmits light
    double seconds() const { return seconds_; }        // of the capture, on all threads

private:
    void capture_from(int first, std::vector<rays::LightRays>& tiles) const;

    const rays::Capture& capture_;
    rays::MapLayout layout_;
    std::vector<rays::LightRays> tiles_;  // empty unless kept
    bool kept_ = true, translucent_ = false;
    std::uint64_t rays_ = 0, segments_ = 0, bytes_ = 0;
    double seconds_ = 0.0;
};

}  // namespace shadowbench::bench
