// Which pixels of which levels a lookup's footprint covers, and how much each weighs; see LookupRule.
#pragma once

#include <algorithm>
#include <cmath>

#include "techniques/cells.h"
#include "techniques/deep/deep_lookup.h"

namespace shadowbench::techniques {

// A lookup reads level `fine`, and with a share above 0 the next coarser one too.
struct LevelChoice {
    int fine = 0;
    float coarser = 0.0f;
};

inline LevelChoice choose_levels(const LookupRule& rule, float width, std::size_t levels) {
    const float narrowest = rule.tent ? 1.0f : 1.5f;
    if (rule.mip == Mip::none || !(width > narrowest)) return {};
    const float l = std::min(std::log2(width / narrowest), static_cast<float>(levels - 1));
    const int fine = static_cast<int>(l);
    return {fine, rule.mip == Mip::blend ? l - static_cast<float>(fine) : 0.0f};
}

inline CellGrid grid_of(const DeepLevel& level) {
    return {level.width, level.height, 1.0f, 1.0f};
}

// Along one side of a level: pixels [begin, end) and their weights.
class Side {
public:
    // Around `centre`, `width` wide, in the level's pixels, of which the map fills the first `filled`.
    Side(float centre, float width, float filled, bool tent)
        : centre_(centre), width_(width), filled_(filled), tent_(tent) {
        // A tent reaches the pixels whose centres lie in it, a box those that it overlaps.
        const float reach = tent ? width : 0.5f * width, inwards = tent ? 0.5f : 0.0f;
        const float last = std::ceil(filled);
        begin = static_cast<int>(std::floor(std::max(centre - reach, 0.0f) + inwards));
        end = static_cast<int>(std::min(std::ceil(centre + reach - inwards), last));
    }
    float weight(int pixel) const {
        const float x = static_cast<float>(pixel);
        if (tent_) return std::min(filled_ - x, 1.0f) * std::max(1.0f - std::abs(x + 0.5f - centre_) / width_, 0.0f);
        const float low = std::max(x, centre_ - 0.5f * width_);
        return std::max(std::min({x + 1.0f, centre_ + 0.5f * width_, filled_}) - low, 0.0f);
    }
    int begin, end;

private:
    float centre_, width_, filled_;
    bool tent_;
};

// Calls visit(pixel, weight) for pixels of the map itself.
template <class Visit>
void for_each_map_pixel(const DeepLevel& map, const LookupRule& rule, const Query& q, const Visit& visit) {
    const float width = rule.tent ? std::max(1.0f, q.width) : q.width;
    const CellRange r = footprint(grid_of(map), {q.x, q.y, q.z, rule.tent ? 2.0f * width : width});
    const auto weigh = [&](int pixel, float centre) {
        return rule.tent ? std::max(1.0f - std::abs(static_cast<float>(pixel) + 0.5f - centre) / width, 0.0f) : 1.0f;
    };
    for (int y = r.y0; y < r.y1; ++y)
        for (int x = r.x0; x < r.x1; ++x) visit(map.pixel(x, y), weigh(x, q.x) * weigh(y, q.y));
}

// Calls visit(pixel of the level, weight) for each pixel of level `number`. The query lies in the map.
template <class Visit>
void for_each_pixel(std::span<const DeepLevel> levels, int number, const LookupRule& rule, const Query& q,
                    const Visit& visit) {
    if (number == 0) return for_each_map_pixel(levels[0], rule, q, visit);
    const DeepLevel& level = levels[static_cast<std::size_t>(number)];
    const float scale = 1.0f / static_cast<float>(1u << number);
    const float width = rule.tent ? std::max(q.width * scale, 1.0f) : q.width * scale;
    const Side across(q.x * scale, width, static_cast<float>(levels[0].width) * scale, rule.tent);
    const Side down(q.y * scale, width, static_cast<float>(levels[0].height) * scale, rule.tent);
    for (int y = down.begin; y < down.end; ++y) {
        const float wy = down.weight(y);
        for (int x = across.begin; x < across.end; ++x) visit(level.pixel(x, y), wy * across.weight(x));
    }
}

}  // namespace shadowbench::techniques
