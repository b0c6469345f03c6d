// Fills texels with the segments of rays, many at once: each lane holds one texel until its ray is inserted, and then
// takes the next one. Besides the map, no memory grows with the scene.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "rays/light_rays.h"
#include "techniques/avsm/lanes.h"
#include "techniques/avsm/order.h"

namespace shadowbench::techniques {

template <int nodes>
class Filling {
public:
    Filling(const rays::LightRays& rays, Order order, float far_plane)
        : rays_(rays), order_(order), streams_(far_plane) {
        for (std::size_t l = 0; l < stream_lanes; ++l) free_[l] = static_cast<std::uint8_t>(l);
    }

    // The texel gets the segments of a ray, of which there is at least one; `key` is that of their random order. It is
    // written at the latest by finish().
    void add(float* texel, std::size_t ray, std::uint64_t key) {
        while (free_count_ == 0) advance();
        Lane& lane = lanes_[free_[--free_count_]];
        lane.texel = texel;
        lane.order.begin(rays_, ray, order_, key);
    }

    void finish() {
        while (free_count_ < stream_lanes) advance();
    }

private:
    struct Lane {
        float* texel = nullptr;  // null: the lane is free
        SegmentOrder order;
    };

    // Inserts as many segments a lane as the lane with the fewest has left.
    void advance() {
        std::uint32_t rows = SegmentRows::most;
        for (const Lane& lane : lanes_)
            if (lane.texel) rows = std::min(rows, lane.order.left());
        rows_.count = rows;
        for (std::size_t l = 0; l < stream_lanes; ++l) set_rows(l);
        streams_.insert(rows_);
        for (std::size_t l = 0; l < stream_lanes; ++l) {
            if (!lanes_[l].texel || lanes_[l].order.left() > 0) continue;
            streams_.store(l, lanes_[l].texel);
            streams_.clear(l);
            lanes_[l].texel = nullptr;
            free_[free_count_++] = static_cast<std::uint8_t>(l);
        }
    }

    void set_rows(std::size_t l) {
        if (!lanes_[l].texel) {
            for (std::size_t row = 0; row < rows_.count; ++row) rows_.set(row, l, 0.0f, 0.0f, 1.0f);
            return;
        }
        std::array<std::uint32_t, SegmentRows::most> segments;
        lanes_[l].order.next(std::span(segments).first(rows_.count));
        const float* fronts = rays_.z_front.data();
        const float* backs = rays_.z_back.empty() ? fronts : rays_.z_back.data();
        const float* throughs = rays_.transmittance.data();
        for (std::size_t row = 0; row < rows_.count; ++row) {
            const std::uint32_t s = segments[row];
            rows_.set(row, l, fronts[s], backs[s], throughs[s]);
        }
    }

    const rays::LightRays& rays_;
    Order order_;
    StreamLanes<nodes> streams_;
    SegmentRows rows_;
    std::array<Lane, stream_lanes> lanes_;
    std::array<std::uint8_t, stream_lanes> free_;
    std::size_t free_count_ = stream_lanes;
};

}  // namespace shadowbench::techniques
