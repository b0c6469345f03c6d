// Places the samples of percentage closer filtering in the depth map: the region of a lookup, its partition, and the
// four ways of figure 3 to place samples. Reeves, Salesin, Cook 1987, figures 3 and 4.
#pragma once

#include <cstdint>

#include "base/random.h"
#include "techniques/store/cells.h"

namespace shadowbench::techniques {

enum class Placement {
    uniform,    // (a) anywhere in the bounding box of the region
    gaussian,   // (b) in the bounding box, a Gaussian cut at two standard deviations, where the box ends
    jittered,   // (c) one anywhere in each part of the bounding box
    shape,      // (d) one anywhere in each part of the region's own shape, a parallelogram
    published,  // (c) as figure 4 prints it: one in the upper half of each part of the bounding box
    subset,     // cells of the bounding box, drawn at random without replacement: cell_subset.h
};

// The parameters of figure 4.
struct PcfSettings {
    float num_samples, res_factor, min_size, min_samples, bias0, bias1;
};

// The number of samples along each side of a region with these half-sizes (in cells).
struct Partition {
    int ns, nt;
};
Partition partition(const PcfSettings& settings, float sres, float tres);

// Positions (left + s ax + t bx, bottom + s ay + t by) relative to the position of a lookup, in cells; s in [0, ns], t
// in [0, nt], with one part of the region between whole numbers. ay and bx are 0 except for a shape.
struct Region {
    float left = 0, bottom = 0;
    float ax = 0, ay = 0, bx = 0, by = 0;
    int ns = 1, nt = 1;
};

// The region of a square of `width` map pixels; technique.h defines widths. Its half-sizes are those of the square in
// cells times res_factor, and at least min_size.
Region square_region(const PcfSettings& settings, const CellGrid& grid, float width);

// The region of a known footprint: its bounding box, treated likewise, or the parallelogram stretched along the axes of
// the map until it fills that box. Returns false if it has no extent, or one that is not finite: then the square
// applies.
bool footprint_region(const PcfSettings& settings, const CellGrid& grid, const Footprint& footprint, bool shape,
                      Region& out);

// The samples of a lookup at (x, y) lie inside these bounds, roundings included: each operation that places one is
// monotone, and these bounds use the same operations at the ends.
struct Extent {
    float x0, x1, y0, y1;
};
Extent extent(const Region& region, float x, float y);

// The inverse distribution function of the Gaussian in [0, 1], cut at its ends two standard deviations from the middle.
struct GaussianTable {
    static constexpr int steps = 1024;
    float quantile[steps + 1];

    float at(float u) const {  // u in [0, 1)
        const float place = u * static_cast<float>(steps);
        const int i = static_cast<int>(place);
        const float value = quantile[i] + (place - static_cast<float>(i)) * (quantile[i + 1] - quantile[i]);
        return std::min(value, 1.0f);
    }
};
const GaussianTable& gaussian_table();

// The next 64 random bits of a key that is itself random: wyrand (Wang Yi, wyhash final version 4), one multiplication
// per sample, where base::mix takes two.
inline std::uint64_t sample_bits(std::uint64_t& key) {
    __extension__ using Wide = unsigned __int128;
    key += 0xa0761d6478bd642full;
    const Wide product = static_cast<Wide>(key) * (key ^ 0xe7037ed1a0b428dbull);
    return static_cast<std::uint64_t>(product >> 64) ^ static_cast<std::uint64_t>(product);
}

// Calls visit(x, y, u) for the samples of a lookup at (x, y), all in cells; u is uniform in [0, 1), for the bias.
// Random numbers depend only on the key and the number of the sample.
template <Placement placement, class Visit>
void for_each_sample(const Region& r, float x, float y, std::uint64_t key, const Visit& visit) {
    const auto unit = [](std::uint64_t bits) {
        return static_cast<float>(static_cast<std::int32_t>(bits & 0x1fffff)) * 0x1p-21f;
    };
    const GaussianTable* table = placement == Placement::gaussian ? &gaussian_table() : nullptr;
    const float x0 = x + r.left, y0 = y + r.bottom;
    const float ns = static_cast<float>(r.ns), nt = static_cast<float>(r.nt);
    // Whole numbers as float: counting them up costs less than converting them.
    for (float j = 0.0f; j < nt; j += 1.0f)
        for (float i = 0.0f; i < ns; i += 1.0f) {
            const std::uint64_t bits = sample_bits(key);
            float s = unit(bits), t = unit(bits >> 21);
            if constexpr (placement == Placement::uniform) {
                s *= ns;
                t *= nt;
            } else if constexpr (placement == Placement::gaussian) {
                s = ns * table->at(s);
                t = nt * table->at(t);
            } else if constexpr (placement == Placement::published) {
                s = i + 0.5f + 0.5f * s;
                t = j + 0.5f + 0.5f * t;
            } else {
                s += i;
                t += j;
            }
            if constexpr (placement == Placement::shape)
                visit(x0 + s * r.ax + t * r.bx, y0 + s * r.ay + t * r.by, unit(bits >> 42));
            else
                visit(x0 + s * r.ax, y0 + t * r.by, unit(bits >> 42));
        }
}

}  // namespace shadowbench::techniques
