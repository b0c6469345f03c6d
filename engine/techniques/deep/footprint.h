// Finds the pixels of the levels that a lookup's footprint covers, and their weights; see LookupRule.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "techniques/deep/deep_lookup.h"
#include "techniques/store/cells.h"

namespace shadowbench::techniques {

// A lookup reads level `fine` and, if the share is above 0, the next coarser one too.
struct LevelChoice {
    int fine = 0;
    float coarser = 0.0f;
};

// The widest footprint, in pixels of the map, for which a lookup reads only the map.
inline float narrowest_mip(const LookupRule& rule) {
    return rule.kernel == Kernel::tent ? 1.0f : 1.5f;
}

// The widest footprint, in pixels of the map, that may read at most 2 x 2 of its pixels and no other level.
inline float widest_few(const LookupRule& rule) {
    // A footprint of a pixel's width includes the nearest pixel, whose centre is within half of that, and no other; a
    // tent has at least that width.
    if (rule.kernel != Kernel::box) return 1.0f;
    return rule.mip == Mip::none ? 2.0f : narrowest_mip(rule);
}

inline LevelChoice choose_levels(const LookupRule& rule, float width, std::size_t levels) {
    const float narrowest = narrowest_mip(rule);
    if (rule.mip == Mip::none || !(width > narrowest)) return {};
    const float l = std::min(std::log2(width / narrowest), static_cast<float>(levels - 1));
    const int fine = static_cast<int>(l);
    return {fine, rule.mip == Mip::blend ? l - static_cast<float>(fine) : 0.0f};
}

// Along one side of a level: pixels [begin, end) and the weights that a kernel gives their centres.
class Side {
public:
    // A footprint `width` wide around `centre`, in the level's pixels, of which the map fills the first `filled`.
    Side(Kernel kernel, float centre, float width, float filled)
        : centre_(centre), width_(width), filled_(filled), tent_(kernel == Kernel::tent) {
        const float reach = tent_ ? width : 0.5f * width, last = std::ceil(filled);
        // Cut to the map while they are floats, which hold any width.
        if (tent_) {
            begin = static_cast<int>(std::max(centre - reach, 0.0f) + 0.5f);
            end = static_cast<int>(std::min(std::ceil(centre + reach - 0.5f), last));
            return;
        }
        begin = static_cast<int>(std::max(centre - reach + 0.5f, 0.0f));
        end = static_cast<int>(std::min(centre + reach + 0.5f, last));
        if (begin < end) return;
        begin = static_cast<int>(centre);
        end = begin + 1;
    }
    double weight(int pixel) const {
        const float x = static_cast<float>(pixel), inside = std::min(filled_ - x, 1.0f);
        return tent_ ? inside * std::max(1.0f - std::abs(x + 0.5f - centre_) / width_, 0.0f) : inside;
    }
    int begin, end;

private:
    float centre_, width_, filled_;
    bool tent_;
};

// Calls visit(x, y, weight) for each pixel of level `number` of a map of this size. The query must lie in the map.
template <class Visit>
void for_each_pixel(int map_width, int map_height, int number, Kernel kernel, const Query& q, const Visit& visit) {
    const float scale = 1.0f / static_cast<float>(1u << number);
    const float x = q.x * scale, y = q.y * scale, width = width_of(q) * scale;
    const float filled_x = static_cast<float>(map_width) * scale, filled_y = static_cast<float>(map_height) * scale;
    if (kernel == Kernel::box) return for_each_of(stretch(x, width, filled_x), stretch(y, width, filled_y), visit);
    const float wide = kernel == Kernel::tent ? std::max(1.0f, width) : width;
    for_each_of(Side(kernel, x, wide, filled_x), Side(kernel, y, wide, filled_y), visit);
}

// The weighted mean of values in each channel.
template <int channels>
struct WeightedMean {
    std::array<double, channels> sum{};  // of up to a million pixels: float sums would lose digits
    double weights = 0.0;

    void add(const std::array<float, channels>& values, double weight) {
        for (int c = 0; c < channels; ++c) sum[c] += weight * values[c];
        weights += weight;
    }
    std::array<float, channels> value() const {
        std::array<float, channels> mean;
        for (int c = 0; c < channels; ++c) mean[c] = std::min(static_cast<float>(sum[c] / weights), 1.0f);
        return mean;
    }
};

}  // namespace shadowbench::techniques
