#include "techniques/avsm/lanes.h"

#include <cmath>
#include <cstring>

#include "base/simd_path.h"
#include "techniques/avsm/stream.h"

#pragma GCC diagnostic ignored "-Wpsabi"  // no vector is passed: all functions that have one are inlined

namespace shadowbench::techniques {
namespace {

template <int width>
struct Vectors {
    typedef float Floats __attribute__((vector_size(4 * width)));
    typedef std::int32_t Ints __attribute__((vector_size(4 * width)));  // as a mask: -1 or 0
};

// Vectors are passed by reference: how else they are passed depends on the instructions.
template <class Vector>
SHADOWBENCH_SIMD_LOOP inline void load(const void* from, Vector& to) {
    std::memcpy(&to, from, sizeof(Vector));
}
template <class Vector>
SHADOWBENCH_SIMD_LOOP inline void store(const Vector& from, void* to) {
    std::memcpy(to, &from, sizeof(Vector));
}
template <class Mask>
SHADOWBENCH_SIMD_LOOP inline bool any(const Mask& mask) {
    std::uint64_t words[sizeof(Mask) / sizeof(std::uint64_t)], all = 0;
    store(mask, words);
    for (const std::uint64_t word : words) all |= word;
    return all != 0;
}

// Nodes inside a medium follow its own curve. Of one lane: `stride` floats lie between two of its nodes.
void scale_inside(const float* depth, float* value, int nodes, int stride, float front, float back, float through) {
    const float log_through = std::log(through > 0.0f ? through : std::numeric_limits<float>::min());
    for (int i = 0; i < nodes; ++i, depth += stride, value += stride)
        if (front < *depth && *depth < back)
            *value *= std::max(std::exp(log_through * ((*depth - front) / (back - front))), through);
}

// The streams of `width` lanes, which all do the same, without branches; and two places more for the nodes of a
// segment. Each step is one of TransmittanceStream::insert_between(), which holds at any depth.
template <int width, int nodes>
class Block {
public:
    using Floats = typename Vectors<width>::Floats;
    using Ints = typename Vectors<width>::Ints;

    SHADOWBENCH_SIMD_LOOP Block(const StreamLanes<nodes>& streams, std::size_t first) {
        far_plane_ = Floats{} + streams.far_plane;
        for (int i = 0; i < nodes; ++i) {
            load(&streams.depth[i][first], depth_[i]);
            load(&streams.value[i][first], value_[i]);
            load(&streams.slot[i][first], slot_[i]);
        }
        load(&streams.size[first], size_);
        load(&streams.first_free[first], first_free_);
        load(&streams.second_free[first], second_free_);
    }
    SHADOWBENCH_SIMD_LOOP void save(StreamLanes<nodes>& streams, std::size_t first) const {
        for (int i = 0; i < nodes; ++i) {
            store(depth_[i], &streams.depth[i][first]);
            store(value_[i], &streams.value[i][first]);
            store(slot_[i], &streams.slot[i][first]);
        }
        store(size_, &streams.size[first]);
        store(first_free_, &streams.first_free[first]);
        store(second_free_, &streams.second_free[first]);
    }

    SHADOWBENCH_SIMD_LOOP void insert(const Floats& front, const Floats& back, const Floats& given) {
        const Floats one = Floats{} + 1.0f;
        Around at_front, at_back;
        Floats before, after;
        look_around(front, at_front);
        interpolate(front, at_front, before);
        const Ints has_front = at_front.right_z == front;
        before = has_front ? at_front.right_value : before;
        after = before;
        const Ints medium = front < back;
        Ints has_back{}, inside{};
        if (any(medium)) {
            look_around(back, at_back);
            interpolate(back, at_back, after);
            after = medium ? after : before;
            has_back = medium & (at_back.right_z == back);
            inside = medium & (front < at_back.left_z) & (depth_[0] < back);
        }

        Ints changes = (given < one) & (before > Floats{});  // else no light is left
        const Ints dark = changes & has_front & medium & (value_[nodes - 1] <= Floats{});
        if (any(dark)) skip_behind_opaque(dark, front, changes);
        const Floats through = changes ? given : one;
        after *= through;

        // Of the nodes of a surface's depth the first one holds the value before it, and the others are behind it.
        Ints former{};
        for (int i = 0; i < nodes; ++i) {
            const Ints behind = depth_[i] > back, not_before = depth_[i] >= back;
            const Ints scaled = behind | (not_before & medium) | former;
            has_back |= former & ~behind;
            former = not_before;
            value_[i] = scaled ? value_[i] * through : value_[i];
        }
        inside &= changes;
        if (any(inside)) {
            alignas(64) float fronts[width], backs[width], throughs[width];
            alignas(64) std::int32_t is_inside[width];
            store(front, fronts);
            store(back, backs);
            store(through, throughs);
            store(inside, is_inside);
            for (int l = 0; l < width; ++l)
                if (is_inside[l])
                    scale_inside(reinterpret_cast<const float*>(depth_) + l, reinterpret_cast<float*>(value_) + l,
                                 nodes, width, fronts[l], backs[l], throughs[l]);
        }

        const Ints adds_front = changes & ~has_front, adds_back = changes & ~has_back;
        const Ints grows = size_ < nodes;
        const Ints first = grows ? size_ : first_free_, second = grows ? size_ + 1 : second_free_;
        const Ints behind_all = adds_front & (at_front.right_z == far_plane_);
        const Floats nowhere = Floats{} + infinity;
        Node front_node{adds_front ? front : nowhere, adds_front ? before : value_[nodes - 1],
                        behind_all | ~adds_back ? first : second};
        Node back_node{adds_back ? back : nowhere, adds_back ? after : value_[nodes - 1], behind_all ? second : first};
        const Floats front_z = front_node.depth, back_z = back_node.depth;
        depth_[nodes] = nowhere;
        value_[nodes] = value_[nodes - 1];
        slot_[nodes] = Ints{};
        if (any(adds_front))
            for (int i = 0; i <= nodes; ++i) displace(i, depth_[i] < front_z, front_node);
        for (int i = 0; i <= nodes; ++i) displace(i, depth_[i] <= back_z, back_node);
        depth_[nodes + 1] = back_node.depth;
        value_[nodes + 1] = back_node.value;
        slot_[nodes + 1] = back_node.slot;
        size_ -= adds_front + adds_back;
        size_ = size_ < nodes ? size_ : Ints{} + nodes;
        remove_least<nodes + 2>(second_free_);
        remove_least<nodes + 1>(first_free_);
    }

private:
    static constexpr float infinity = std::numeric_limits<float>::infinity();
    static constexpr std::int32_t slot_mask = TransmittanceStream<nodes>::slot_mask;
    static constexpr std::int32_t area_mask = std::numeric_limits<std::int32_t>::max() & ~slot_mask;

    struct Node {
        Floats depth, value;
        Ints slot;
    };
    // The last node before a depth and the first one that is not.
    struct Around {
        Floats left_z, left_value, right_z, right_value;
    };

    SHADOWBENCH_SIMD_LOOP void look_around(const Floats& z, Around& at) const {
        at = {depth_[0], value_[0], depth_[0], value_[0]};
        for (int i = 0; i + 1 < nodes; ++i) {
            const Ints before = depth_[i] < z;
            at.left_z = before ? depth_[i] : at.left_z;
            at.left_value = before ? value_[i] : at.left_value;
            at.right_z = before ? depth_[i + 1] : at.right_z;
            at.right_value = before ? value_[i + 1] : at.right_value;
        }
    }
    // As TransmittanceStream::value_between().
    SHADOWBENCH_SIMD_LOOP void interpolate(const Floats& z, const Around& at, Floats& out) const {
        const Floats share = (z - at.left_z) / (at.right_z - at.left_z);
        out = at.left_value + share * (at.right_value - at.left_value);
        out = out < at.right_value ? at.right_value : out;
        out = at.left_value < out ? at.left_value : out;
        out = depth_[0] < z ? out : Floats{} + 1.0f;
    }
    // Right behind the last node, if that is opaque, nothing changes.
    SHADOWBENCH_SIMD_LOOP void skip_behind_opaque(const Ints& dark, const Floats& front, Ints& changes) const {
        Floats last_z = depth_[0], last_value = value_[0];
        for (int i = 1; i < nodes; ++i) {
            const Ints before_far = depth_[i] < far_plane_;
            last_z = before_far ? depth_[i] : last_z;
            last_value = before_far ? value_[i] : last_value;
        }
        changes &= ~(dark & (last_z == front) & (last_value <= Floats{}));
    }
    // Puts the node that is carried into a place, and carries the one that was there on, unless it stays.
    SHADOWBENCH_SIMD_LOOP void displace(int i, const Ints& stays, Node& carried) {
        const Node there{depth_[i], value_[i], slot_[i]};
        depth_[i] = stays ? there.depth : carried.depth;
        value_[i] = stays ? there.value : carried.value;
        slot_[i] = stays ? there.slot : carried.slot;
        carried.depth = stays ? carried.depth : there.depth;
        carried.value = stays ? carried.value : there.value;
        carried.slot = stays ? carried.slot : there.slot;
    }
    // Of `count` nodes, where there are so many: as TransmittanceStream::remove_least().
    template <int count>
    SHADOWBENCH_SIMD_LOOP void remove_least(Ints& free) {
        const Ints full = depth_[count - 1] < Floats{} + infinity;
        if (!any(full)) return;
        Ints rank[count - 1], least = Ints{} + std::numeric_limits<std::int32_t>::max();
        for (int i = 1; i + 1 < count; ++i) {
            const Floats area = (depth_[i + 1] - depth_[i - 1]) * (value_[i + 1] - value_[i]) -
                                (depth_[i + 1] - depth_[i]) * (value_[i + 1] - value_[i - 1]);
            rank[i] = (reinterpret_cast<Ints>(area) & area_mask) | slot_[i];
            least = rank[i] < least ? rank[i] : least;
        }
        free = full ? least & slot_mask : free;
        least |= ~full;  // no node's
        Ints gone{};
        for (int i = 1; i + 1 < count; ++i) {
            gone |= rank[i] == least;
            depth_[i] = gone ? depth_[i + 1] : depth_[i];
            value_[i] = gone ? value_[i + 1] : value_[i];
            slot_[i] = gone ? slot_[i + 1] : slot_[i];
        }
    }

    Floats far_plane_;
    Floats depth_[nodes + 2], value_[nodes + 2];
    Ints slot_[nodes + 2], size_, first_free_, second_free_;
};

template <int width, int nodes>
SHADOWBENCH_SIMD_LOOP inline void insert_rows(StreamLanes<nodes>& streams, const SegmentRows& rows) {
    for (std::size_t first = 0; first < stream_lanes; first += width) {
        Block<width, nodes> block(streams, first);
        for (std::size_t row = 0; row < rows.count; ++row) {
            typename Block<width, nodes>::Floats front, back, through;
            load(&rows.front[row][first], front);
            load(&rows.back[row][first], back);
            load(&rows.through[row][first], through);
            block.insert(front, back, through);
        }
        block.save(streams, first);
    }
}

}  // namespace

template <int nodes>
void StreamLanes<nodes>::insert(const SegmentRows& rows) {
#if defined(__x86_64__)
    // Also where there are wider ones: the compiler turns their masks into slow code.
    if (base::simd_path() != base::SimdPath::baseline)
        return base::run_avx2([&]() SHADOWBENCH_SIMD_LOOP { insert_rows<8>(*this, rows); });
#endif
    insert_rows<4>(*this, rows);
}

template struct StreamLanes<4>;
template struct StreamLanes<8>;
template struct StreamLanes<16>;

}  // namespace shadowbench::techniques
