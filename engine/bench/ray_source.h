// The light rays of a map for any number of passes: kept in memory if they fit a budget, otherwise captured again.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <span>
#include <vector>

#include "rays/capture.h"
#include "rays/light_rays.h"

namespace shadowbench::bench {

class RaySource {
public:
    using Batch = std::span<const rays::LightRays>;
    using Watch = std::function<void(std::size_t tiles_done)>;

    // Captures every tile once, in parallel, and counts rays, segments and bytes. Keeps a reference to `capture`.
    RaySource(const rays::Capture& capture, const rays::MapLayout& layout, std::size_t keep_budget, const Watch& watch);
    // For a single pass: keeps no tiles, and counts them when for_each_batch captures them.
    RaySource(const rays::Capture& capture, const rays::MapLayout& layout);

    // Calls body with the tiles of the map, each once, in order: all at once if they are kept, otherwise a few at a
    // time. Tiles are captured in parallel, before a call of body and never during it. Each tile has `apron` more
    // pixels on every side (at most the layout's). Such tiles are kept from the first call on if they too fit the
    // budget. Not thread-safe.
    void for_each_batch(int apron, const std::function<void(Batch)>& body) const;

    bool kept(int apron = 0) const { return tiles_.contains(apron); }
    std::size_t kept_bytes() const;
    // From now on every pass captures the tiles again.
    void drop_kept();
    std::uint64_t rays() const { return rays_; }
    std::uint64_t segments() const { return segments_; }
    std::uint64_t bytes() const { return bytes_; }     // of all tiles
    bool translucent() const { return translucent_; }  // some crossing transmits light, or belongs to a medium
    double seconds() const { return seconds_; }        // of the capture, on all threads

private:
    using Visit = std::function<void(std::vector<rays::LightRays>& batch)>;
    void capture_all(int apron, const Visit& visit) const;
    void capture_and_keep(int apron, const Visit& visit) const;
    void count(Batch batch) const;

    const rays::Capture& capture_;
    rays::MapLayout layout_;
    mutable std::map<int, std::vector<rays::LightRays>> tiles_;  // kept tiles, by apron
    mutable std::set<int> too_large_;                            // aprons whose tiles do not fit
    mutable std::size_t budget_;                                 // bytes that may still be kept
    mutable bool translucent_ = false;
    mutable std::uint64_t rays_ = 0, segments_ = 0, bytes_ = 0;
    double seconds_ = 0.0;
    const bool single_pass_;
};

}  // namespace shadowbench::bench
