// The streaming compression of one texel (Salvi et al. 2010, section 3.2): inserts a segment, then drops the nodes that
// change the area under the curve least until no more than the texel's number are left.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "techniques/avsm/sampling.h"

namespace shadowbench::techniques {

// A transmittance curve of at most `capacity` nodes, 2 to max_capacity, sampled between them as lookups will. The last
// node is always at the far plane. Depths do not decrease; values do not increase and stay in [0, 1]; the value before
// the first node is that node's. Each segment rounds the values behind it by up to 2^-24 of themselves, as the
// published floats do.
//
// Segments may come in any order. While no node has been dropped, the order changes the curve only by rounding, if
// everything between two nodes is what the sampling assumes: always for surfaces, and for overlapping media with
// exponential sampling. With linear sampling, a node that a later segment puts inside a medium lies on its chord.
//
// Nodes stay in their slots, linked in order of depth, so that removing one moves nothing: a segment behind all others,
// as in sorted input, costs the same few steps however many nodes there are.
template <int max_capacity, Sampling sampling = Sampling::linear>
class TransmittanceStream {
public:
    static constexpr int slots = (max_capacity + 2 + 3) / 4 * 4;
    static constexpr int slot_mask = std::bit_ceil(static_cast<unsigned>(slots)) - 1;  // of the bits that name a slot

    TransmittanceStream(int capacity, float far_plane) : capacity_(capacity) { clear(far_plane); }

    void clear(float far_plane) {
        size_ = 1;
        depth_[far_slot] = far_plane;
        value_[far_slot] = 1.0f;
        previous_[far_slot] = next_[far_slot] = far_slot;  // a ring: the first node follows the last
        rank_.fill(never);
        free_ = all_free();
        free_count_ = slots - 1;
    }

    // Inserts a segment with constant extinction from front to back (front == back: a surface) that transmits
    // `through`. All of it must lie before the far plane.
    void insert(float front, float back, float through) {
        if (through >= 1.0f) return;
        const int last = previous_[far_slot];
        const bool joins = size_ > 1 && front == depth_[last] && back > front;  // right behind the segment before
        if (size_ == 1 || front > depth_[last] || joins) {
            const float before = value_before_far(front);
            if (before <= 0.0f) return;  // no light is left
            const float after = value_before_far(back) * through;
            value_[far_slot] *= through;
            if (!joins) link_before(far_slot, front, before);
            const int end = link_before(far_slot, back, after);
            // Areas change where a node's neighbours do: at `last`, and at the new nodes.
            if (!joins) update(last);
            update(previous_[end]);
            update(end);
        } else {
            insert_between(front, back, through);
        }
        while (size_ > capacity_) remove_least();
    }

    // Appends a node behind all others; the far plane follows it. For curves that are given node by node.
    void append(float depth, float value) {
        value_[far_slot] = value;
        const int end = link_before(far_slot, depth, value);
        update(previous_[end]);
        update(end);
        while (size_ > capacity_) remove_least();
    }

    int size() const { return size_; }

    // Calls visit(depth, value) from the first node to the far plane's.
    template <class Visit>
    void for_each(const Visit& visit) const {
        for (int node = next_[far_slot];; node = next_[node]) {
            visit(depth_[node], value_[node]);
            if (node == far_slot) return;
        }
    }

private:
    static constexpr int far_slot = 0;
    static constexpr std::int32_t never = std::numeric_limits<std::int32_t>::max();

    static constexpr std::array<std::uint8_t, slots> all_free() {
        std::array<std::uint8_t, slots> result{};
        for (int i = 0; i < slots - 1; ++i) result[i] = static_cast<std::uint8_t>(slots - 1 - i);
        return result;
    }

    // At any depth: nodes inside the segment follow the medium's own curve, and nodes behind it are scaled.
    void insert_between(float front, float back, float through) {
        int at = far_slot;  // first node not before the segment
        while (previous_[at] != far_slot && depth_[previous_[at]] >= front) at = previous_[at];
        const float before = value_at(at, front);
        if (before <= 0.0f) return;
        int end = at;  // first node behind it
        while (end != far_slot && depth_[end] <= back) end = next_[end];
        const float after = value_at(end, back) * through;

        // Nodes at the segment's ends serve as its ends: the first one at `front` holds the value before the segment,
        // and the last one at `back`, if it is another node, the value behind it.
        const bool has_front = depth_[at] == front;
        const bool has_back = end != at && depth_[previous_[end]] == back && !(front == back && previous_[end] == at);
        const float log_through = std::log(through > 0.0f ? through : std::numeric_limits<float>::min());
        for (int node = at; node != end; node = next_[node]) {
            if (front == back)
                value_[node] *= node == at ? 1.0f : through;
            else if (depth_[node] == back)
                value_[node] *= through;
            else
                value_[node] *= std::max(std::exp(log_through * ((depth_[node] - front) / (back - front))), through);
        }
        for (int node = end;; node = next_[node]) {
            value_[node] *= through;
            if (node == far_slot) break;
        }
        if (!has_back) link_before(end, back, after);
        if (!has_front) link_before(at == end && !has_back ? previous_[end] : at, front, before);
        for (int node = next_[far_slot]; node != far_slot; node = next_[node]) update(node);
    }

    // The value at z, between the last node before the far plane and the far plane.
    float value_before_far(float z) const {
        const int last = previous_[far_slot];
        if (last == far_slot) return 1.0f;
        return value_between(last, far_slot, z);
    }

    // The value at z, where `node` is the first that is not before z.
    float value_at(int node, float z) const {
        if (node == next_[far_slot]) return 1.0f;
        if (depth_[node] == z) return value_[node];
        return value_between(previous_[node], node, z);
    }

    // Stays between the two values in every digit: otherwise the new node would rise above one or fall below the other.
    float value_between(int before, int behind, float z) const {
        const float u = (z - depth_[before]) / (depth_[behind] - depth_[before]);
        if constexpr (sampling == Sampling::exponential) return decay(value_[before], value_[behind], u);
        return std::clamp(value_[before] + u * (value_[behind] - value_[before]), value_[behind], value_[before]);
    }

    [[gnu::always_inline]] int link_before(int node, float depth, float value) {
        const int slot = free_[--free_count_];
        depth_[slot] = depth;
        value_[slot] = value;
        const int before = previous_[node];
        previous_[slot] = static_cast<std::uint8_t>(before);
        next_[slot] = static_cast<std::uint8_t>(node);
        next_[before] = previous_[node] = static_cast<std::uint8_t>(slot);
        ++size_;
        return slot;
    }

    // Section 3.2.1: twice the area of the triangle of a node and its neighbours. The first and the last node stay.
    // The slot is kept in the lowest bits, so that one search for the least finds both: areas that differ by less than
    // 1 part in 65,000 (64 nodes) to 500,000 (8) count as equal.
    [[gnu::always_inline]] void update(int node) {
        const int before = previous_[node], behind = next_[node];
        if (before == far_slot || node == far_slot) {
            rank_[node] = never;
            return;
        }
        const float area = std::abs((depth_[behind] - depth_[before]) * (value_[behind] - value_[node]) -
                                    (depth_[behind] - depth_[node]) * (value_[behind] - value_[before]));
        rank_[node] = (std::bit_cast<std::int32_t>(area) & ~slot_mask) | node;
    }

    [[gnu::always_inline]] void remove_least() {
        std::int32_t least = never;
        for (int i = 0; i < slots; ++i) least = rank_[i] < least ? rank_[i] : least;
        const int node = least & slot_mask;
        const int before = previous_[node], behind = next_[node];
        next_[before] = static_cast<std::uint8_t>(behind);
        previous_[behind] = static_cast<std::uint8_t>(before);
        rank_[node] = never;
        free_[free_count_++] = static_cast<std::uint8_t>(node);
        --size_;
        update(before);
        update(behind);
    }

    int capacity_;
    int size_;
    std::array<float, slots> depth_, value_;
    std::array<std::int32_t, slots> rank_;  // area and slot; `never` for the first, the last and free slots
    std::array<std::uint8_t, slots> previous_, next_;
    std::array<std::uint8_t, slots> free_;  // a stack of free slots
    int free_count_;
};

}  // namespace shadowbench::techniques
