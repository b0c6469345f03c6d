#include "techniques/avsm/streams.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "techniques/store/simd_path.h"

#pragma GCC diagnostic ignored "-Wpsabi"  // no vector is passed: all functions that have one are inlined

namespace shadowbench::techniques {
namespace {

// What is done to some lanes at once, without branches. Vectors are passed by reference: how else they are passed
// depends on the instructions.
template <int width>
struct Vectors {
    typedef float Floats __attribute__((vector_size(4 * width)));
    typedef std::int32_t Mask __attribute__((vector_size(4 * width)));  // -1 or 0 in each lane
};

template <class Vector>
SHADOWBENCH_SIMD_LOOP inline void load(const float* from, Vector& to) {
    std::memcpy(&to, from, sizeof(Vector));
}
template <class Vector>
SHADOWBENCH_SIMD_LOOP inline void store(const Vector& from, float* to) {
    std::memcpy(to, &from, sizeof(Vector));
}
template <class Mask>
SHADOWBENCH_SIMD_LOOP inline bool any(const Mask& mask) {
    std::uint64_t words[sizeof(Mask) / sizeof(std::uint64_t)], all = 0;
    std::memcpy(words, &mask, sizeof(Mask));
    for (const std::uint64_t word : words) all |= word;
    return all != 0;
}
template <class Floats>
SHADOWBENCH_SIMD_LOOP inline void set_min(Floats& a, const Floats& b) {
#if defined(__SSE2__)
    if constexpr (sizeof(Floats) == 16)
        a = __builtin_ia32_minps(a, b);
    else
        a = __builtin_ia32_minps256(a, b);
#else
    a = a < b ? a : b;
#endif
}
template <class Floats>
SHADOWBENCH_SIMD_LOOP inline void set_max(Floats& a, const Floats& b) {
#if defined(__SSE2__)
    if constexpr (sizeof(Floats) == 16)
        a = __builtin_ia32_maxps(a, b);
    else
        a = __builtin_ia32_maxps256(a, b);
#else
    a = a > b ? a : b;
#endif
}
// Leaves the lesser in `low` and the greater in `high`.
template <class Floats>
SHADOWBENCH_SIMD_LOOP inline void order(Floats& low, Floats& high) {
    const Floats first = low;
    set_min(low, high);
    set_max(high, first);
}

// Of an area: not its sign, nor its last bits. Areas that differ by less than 1 part in 500,000 count as equal, since
// those of steps of one height differ by rounding only.
constexpr std::int32_t compared_bits = 0x7ffffff0;

// Section 3.2.1: twice the area of the triangle of a node and its neighbours.
template <class Floats>
SHADOWBENCH_SIMD_LOOP inline void area_of(const Floats* depth, const Floats* value, Floats& out) {
    out = (depth[1] - depth[-1]) * (value[1] - value[0]) - (depth[1] - depth[0]) * (value[1] - value[-1]);
}

// The streams of `width` lanes, of `nodes` nodes, and two places more.
template <int width, int nodes>
struct Block {
    using Floats = typename Vectors<width>::Floats;
    using Mask = typename Vectors<width>::Mask;

    Floats depth[nodes + 2], value[nodes + 2];

    // The values at z; the first node that is not before z counts, if it is at z. Before the first node: 1.
    SHADOWBENCH_SIMD_LOOP void value_at(const Floats& z, int count, Sampling sampling, Floats& right_z,
                                        Floats& out) const {
        Floats left_z = depth[0], left_value = value[0], right_value = value[0];
        right_z = depth[0];
        for (int i = 0; i + 1 < count; ++i) {
            left_z = depth[i] < z ? depth[i] : left_z;
            left_value = depth[i] < z ? value[i] : left_value;
            right_z = depth[i] < z ? depth[i + 1] : right_z;
            right_value = depth[i] < z ? value[i + 1] : right_value;
        }
        const Floats share = (z - left_z) / (right_z - left_z);
        if (sampling == Sampling::linear) {
            // Stays between the two values in every digit: otherwise the new node would rise above one or fall below
            // the other.
            out = left_value + share * (right_value - left_value);
            out = out < right_value ? right_value : out;
            out = out > left_value ? left_value : out;
        } else {
            alignas(64) float left[width], right[width], at[width];
            store(left_value, left);
            store(right_value, right);
            store(share, at);
            for (int i = 0; i < width; ++i) at[i] = decay(left[i], right[i], at[i]);
            load(at, out);
        }
        out = right_z == z ? right_value : out;
        out = depth[0] < z ? out : Floats{} + 1.0f;
    }

    // Nodes inside a medium follow its own curve.
    SHADOWBENCH_SIMD_LOOP void scale_inside(const Floats& front, const Floats& back, const Floats& through, int count) {
        alignas(64) float log_through[width], whole[width], factor[width];
        alignas(64) std::int32_t inside[width];
        store(through, whole);
        for (int l = 0; l < width; ++l)
            log_through[l] = std::log(std::max(whole[l], std::numeric_limits<float>::min()));
        Floats logarithm;
        load(log_through, logarithm);
        for (int i = 0; i + 1 < count; ++i) {
            const Mask in = (front < depth[i]) & (depth[i] < back);
            if (!any(in)) continue;
            store(Floats(logarithm * ((depth[i] - front) / (back - front))), factor);
            std::memcpy(inside, &in, sizeof(in));
            for (int l = 0; l < width; ++l) factor[l] = inside[l] ? std::max(std::exp(factor[l]), whole[l]) : 1.0f;
            Floats factors;
            load(factor, factors);
            value[i] *= factors;
        }
    }

    // Leaves two nodes more than `count`.
    SHADOWBENCH_SIMD_LOOP void insert(const Floats& front, const Floats& back, const Floats& given, int count,
                                      Sampling sampling) {
        const Floats one = Floats{} + 1.0f;
        Floats front_z, back_z, before, after;
        value_at(front, count, sampling, front_z, before);
        const Mask medium = front < back;
        const bool media = any(medium);
        if (media)
            value_at(back, count, sampling, back_z, after);
        else
            after = before;
        Floats lit = one;  // what passes the nodes up to `front`, also at it
        for (int i = 0; i + 1 < count; ++i) lit = depth[i] <= front ? value[i] : lit;
        const Mask changes = (given < one) & (before > 0.0f) & (lit > 0.0f);
        const Floats through = changes ? given : one;
        after *= through;

        // Nodes at the segment's ends serve as its ends: the first one at `front` holds the value before the segment,
        // and the last one at `back`, if it is another node, the value behind it.
        Mask has_back{}, same = medium, inside{};
        for (int i = 0; i < count; ++i) {
            const Mask ends = (depth[i] == back) & same;
            has_back |= ends;
            inside |= (front < depth[i]) & (depth[i] < back);
            same = medium | (depth[i] == back);
            value[i] = ((depth[i] > back) | ends) ? value[i] * through : value[i];
        }
        if (media && any(inside & changes)) scale_inside(front, back, through, count);

        // Both coordinates are sorted, so each new node finds its place in each of them by itself.
        const Floats far_z = depth[count - 1], far_value = value[count - 1];
        Floats z1 = changes & (front_z != front) ? front : far_z,
               value1 = changes & (front_z != front) ? before : far_value;
        Floats z2 = changes & ~has_back ? back : far_z, value2 = changes & ~has_back ? after : far_value;
        for (int i = 0; i < count; ++i) {
            order(depth[i], z1);
            order(depth[i], z2);
            order(value1, value[i]);
            order(value2, value[i]);
        }
        order(z1, z2);
        order(value2, value1);
        depth[count] = z1;
        depth[count + 1] = z2;
        value[count] = value1;
        value[count + 1] = value2;
    }

    // Whether the last place is not in use in any lane: the one before it is at the far plane too.
    SHADOWBENCH_SIMD_LOOP bool spare(int count) const { return !any(depth[count - 2] < depth[count - 1]); }

    // The first and the last node stay. Of equal areas the first one goes; before all, a place that is not in use.
    SHADOWBENCH_SIMD_LOOP void remove_least(int count) {
        if (spare(count)) return;
        Floats area[nodes + 2], least = Floats{} + std::numeric_limits<float>::infinity();
        for (int i = 1; i + 1 < count; ++i) {
            area_of(depth + i, value + i, area[i]);
            area[i] = reinterpret_cast<Floats>(reinterpret_cast<Mask>(area[i]) & compared_bits);
            area[i] = depth[i] < depth[count - 1] ? area[i] : Floats{} - 1.0f;
            set_min(least, area[i]);
        }
        Mask gone{};
        for (int i = 1; i + 1 < count; ++i) {
            gone |= area[i] == least;
            depth[i] = gone ? depth[i + 1] : depth[i];
            value[i] = gone ? value[i + 1] : value[i];
        }
    }
};

// Of `fixed` nodes; if that is most_nodes, of as many as given, and no more work than those in use need.
template <int width, int fixed>
SHADOWBENCH_SIMD_LOOP inline void insert_all(Streams& streams, const SegmentRows& segments, int given,
                                             Sampling sampling) {
    constexpr bool any_number = fixed == most_nodes;
    const int nodes = any_number ? given : fixed;
    for (std::size_t first = 0; first < lanes; first += width) {
        Block<width, fixed> block;
        for (int i = 0; i < nodes; ++i) {
            load(&streams.depth[i][first], block.depth[i]);
            load(&streams.value[i][first], block.value[i]);
        }
        int count = nodes;
        const auto drop_spare = [&]() SHADOWBENCH_SIMD_LOOP {
            while (any_number && count > 1 && block.spare(count)) --count;
        };
        drop_spare();
        for (std::size_t row = 0; row < segments.count; ++row) {
            typename Vectors<width>::Floats front, back, through;
            load(&segments.front[row][first], front);
            load(&segments.back[row][first], back);
            load(&segments.through[row][first], through);
            block.insert(front, back, through, count, sampling);
            if constexpr (any_number) {
                for (count += 2; count > nodes; --count) block.remove_least(count);
                drop_spare();
            } else {
                block.remove_least(nodes + 2);
                block.remove_least(nodes + 1);
            }
        }
        for (int i = 0; i < nodes; ++i) {
            store(block.depth[std::min(i, count - 1)], &streams.depth[i][first]);
            store(block.value[std::min(i, count - 1)], &streams.value[i][first]);
        }
    }
}

template <int fixed>
void insert(Streams& streams, const SegmentRows& segments, int nodes, Sampling sampling) {
#if defined(__x86_64__)
    if (simd_path() != SimdPath::baseline)
        return base::run_avx2([&]()
                                  SHADOWBENCH_SIMD_LOOP { insert_all<8, fixed>(streams, segments, nodes, sampling); });
#endif
    insert_all<4, fixed>(streams, segments, nodes, sampling);
}

}  // namespace

void Streams::append(std::size_t lane, int nodes, float its_depth, float its_value) {
    std::array<float, most_nodes + 1> depths, values;
    int last = 0;
    while (last + 1 < nodes && depth[last][lane] < depth[nodes - 1][lane]) ++last;
    for (int i = 0; i <= nodes; ++i) {
        depths[i] = i < last ? depth[i][lane] : i == last ? its_depth : depth[nodes - 1][lane];
        values[i] = i < last ? value[i][lane] : its_value;
    }
    int least = nodes - 1;
    float least_area = std::numeric_limits<float>::infinity();
    for (int i = 1; i < nodes; ++i) {
        float area;
        area_of(&depths[i], &values[i], area);
        area =
            depths[i] < depths[nodes] ? std::bit_cast<float>(std::bit_cast<std::int32_t>(area) & compared_bits) : -1.0f;
        if (area < least_area) {
            least = i;
            least_area = area;
        }
    }
    for (int i = 0; i < nodes; ++i) {
        depth[i][lane] = depths[i < least ? i : i + 1];
        value[i][lane] = values[i < least ? i : i + 1];
    }
}

Insert inserter(int nodes) {
    return nodes == 4 ? insert<4> : nodes == 8 ? insert<8> : nodes == 16 ? insert<16> : insert<most_nodes>;
}

}  // namespace shadowbench::techniques
