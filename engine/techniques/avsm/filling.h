// Fills texels with the segments of rays, many at once: each lane holds one texel until its ray is inserted, and then
// takes the next one. Besides the map, no memory grows with the scene.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "rays/light_rays.h"
#include "techniques/avsm/order.h"
#include "techniques/avsm/streams.h"

namespace shadowbench::techniques {

enum class Order { sorted, captured, shuffled };

class Filling {
public:
    Filling(const rays::LightRays& rays, int nodes, Sampling sampling, Order order, float far_plane)
        : rays_(rays),
          nodes_(nodes),
          sampling_(sampling),
          order_(order),
          far_plane_(far_plane),
          insert_(inserter(nodes)) {
        for (std::size_t l = 0; l < lanes; ++l) {
            free_[l] = static_cast<std::uint8_t>(l);
            streams_.clear(l, nodes, far_plane);
        }
    }

    // The texel gets the segments of a ray, of which there is at least one; `key` is that of their random order. It is
    // written at the latest by finish().
    void add(float* texel, std::size_t ray, std::uint64_t key) {
        while (free_count_ == 0) advance();
        const std::size_t l = free_[--free_count_];
        Lane& lane = lanes_[l];
        lane = {texel, rays_.begin[ray], 0, rays_.begin[ray + 1] - rays_.begin[ray]};
        if (order_ != Order::shuffled) return;
        shuffles_[l].begin(key, lane.count);
        prefetch(lane);
    }

    void finish() {
        while (free_count_ < lanes) advance();
    }

private:
    struct Lane {
        float* texel = nullptr;  // null: the lane is free
        std::uint32_t begin = 0, inserted = 0, count = 0;
    };

    // No machine foresees a random order. At most as much as stays in a cache.
    void prefetch(const Lane& lane) const {
        constexpr std::uint32_t most = 2048, floats_a_line = 16;
        const std::uint32_t end = lane.begin + std::min(lane.count, most);
        for (std::uint32_t s = lane.begin; s < end; s += floats_a_line)
            for (const std::vector<float>* of : {&rays_.z_front, &rays_.z_back, &rays_.transmittance})
                if (!of->empty()) __builtin_prefetch(&(*of)[s]);
    }

    // Inserts as many segments a lane as the lane with the fewest has left.
    void advance() {
        std::uint32_t rows = SegmentRows::most;
        for (const Lane& lane : lanes_)
            if (lane.texel) rows = std::min(rows, lane.count - lane.inserted);
        segments_.count = rows;
        for (std::size_t l = 0; l < lanes; ++l) set_rows(l);
        insert_(streams_, segments_, nodes_, sampling_);
        for (std::size_t l = 0; l < lanes; ++l)
            if (lanes_[l].texel && lanes_[l].inserted == lanes_[l].count) {
                streams_.store(l, nodes_, lanes_[l].texel);
                streams_.clear(l, nodes_, far_plane_);
                lanes_[l].texel = nullptr;
                free_[free_count_++] = static_cast<std::uint8_t>(l);
            }
    }

    void set_rows(std::size_t l) {
        Lane& lane = lanes_[l];
        const std::size_t rows = segments_.count;
        if (!lane.texel) {
            for (std::size_t row = 0; row < rows; ++row) segments_.set(row, l, 0.0f, 0.0f, 1.0f);
            return;
        }
        for (std::size_t row = 0; row < rows; ++row) {
            const std::uint32_t s = lane.begin + number(l);
            segments_.set(row, l, rays_.z_front[s], rays_.back(s), rays_.transmittance[s]);
            ++lane.inserted;
        }
    }
    // The next segment of a lane, counted from the first one of its ray.
    std::uint32_t number(std::size_t l) {
        const Lane& lane = lanes_[l];
        if (order_ == Order::sorted) return lane.inserted;
        if (order_ == Order::captured) return rays_.submission[lane.begin + lane.inserted] - lane.begin;
        const std::size_t place = lane.inserted % Shuffle::most_entries;
        if (place == 0)
            shuffles_[l].entries(lane.inserted,
                                 std::span(shuffled_[l])
                                     .first(std::min<std::size_t>(Shuffle::most_entries, lane.count - lane.inserted)));
        return shuffled_[l][place];
    }

    const rays::LightRays& rays_;
    int nodes_;
    Sampling sampling_;
    Order order_;
    float far_plane_;
    Insert insert_;
    Streams streams_;
    SegmentRows segments_;
    std::array<Lane, lanes> lanes_;
    std::array<Shuffle, lanes> shuffles_;
    std::array<std::array<std::uint32_t, Shuffle::most_entries>, lanes> shuffled_;  // the next ones of each
    std::array<std::uint8_t, lanes> free_;
    std::size_t free_count_ = lanes;
};

}  // namespace shadowbench::techniques
