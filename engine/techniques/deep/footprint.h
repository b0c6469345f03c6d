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
    const float narrowest = rule.tent ? 1.0f : 2.0f;
    if (rule.mip == Mip::none || !(width > narrowest)) return {};
    const float l = std::min(std::log2(width / narrowest), static_cast<float>(levels - 1));
    if (rule.mip == Mip::nearest) return {static_cast<int>(std::lround(l)), 0.0f};
    const int fine = static_cast<int>(l);
    return {fine, l - static_cast<float>(fine)};
}

inline CellGrid grid_of(const DeepLevel& level) {
    return {level.width, level.height, 1.0f, 1.0f};
}

// Calls visit(pixel of the level, weight) for each pixel of level `number`.
template <class Visit>
void for_each_pixel(std::span<const DeepLevel> levels, int number, const LookupRule& rule, const Query& q,
                    const Visit& visit) {
    const DeepLevel& level = levels[static_cast<std::size_t>(number)];
    const float scale = 1.0f / static_cast<float>(1u << number);
    const float width = rule.tent ? std::max(q.width * scale, 1.0f) : q.width * scale;
    const Query at{q.x * scale, q.y * scale, q.z, rule.tent ? 2.0f * width : width};
    const CellRange r = footprint(grid_of(level), at);
    // The map's size in this level's pixels, which its last ones may stand out of.
    const float map_width = static_cast<float>(levels[0].width) * scale;
    const float map_height = static_cast<float>(levels[0].height) * scale;
    const auto weigh = [&](int cell, float centre, float end) {
        const float inside = std::min(end - static_cast<float>(cell), 1.0f);
        return rule.tent ? inside * std::max(1.0f - std::abs(static_cast<float>(cell) + 0.5f - centre) / width, 0.0f)
                         : inside;
    };
    for (int y = r.y0; y < r.y1; ++y) {
        const float wy = weigh(y, at.y, map_height);
        for (int x = r.x0; x < r.x1; ++x) visit(level.pixel(x, y), wy * weigh(x, at.x, map_width));
    }
}

}  // namespace shadowbench::techniques
