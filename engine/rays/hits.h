// The crossings of a tile's rays in the order in which they were found, and their sorting into light rays.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "rays/light_rays.h"

namespace shadowbench::rays {

// More would take gigabytes for one tile in every thread.
constexpr std::size_t max_tile_hits = std::size_t{1} << 28;

// Throws Error{bad_input} above that number. Called once for each primitive, or each ray of a volume.
void refuse_hits();
template <class Sink>
void check_hits(const Sink& sink) {
    if (sink.hits.size() > max_tile_hits) [[unlikely]]
        refuse_hits();
}

// Opaque or translucent surfaces of one channel. Most scenes have only these and pay only for these.
struct SurfaceHits {
    struct Hit {
        std::uint32_t ray;
        float z, transmittance;
    };
    std::vector<Hit> hits;

    void surface(std::uint32_t ray, double z, const float* transmittance) {
        hits.push_back({ray, static_cast<float>(z), transmittance[0]});
    }
};

// All other hits: media, and three channels.
struct SegmentHits {
    struct Hit {
        std::uint32_t ray;
        float z_front, z_back;
        float transmittance[3];
    };
    std::vector<Hit> hits;

    void surface(std::uint32_t ray, double z, const float* transmittance) {
        medium(ray, static_cast<float>(z), static_cast<float>(z), transmittance);
    }
    void medium(std::uint32_t ray, float front, float back, const float* t) {
        hits.push_back({ray, front, back, {t[0], t[1], t[2]}});
    }
};

// Fills begin, z_front, z_back, transmittance and, if asked for, submission of `tile` for `rays` rays. The other fields
// of `tile` must be set. Hits that are equal in everything keep their order.
void sort_hits(const SurfaceHits& hits, std::size_t rays, bool submission, LightRays& tile);
void sort_hits(const SegmentHits& hits, std::size_t rays, bool submission, LightRays& tile);

}  // namespace shadowbench::rays
