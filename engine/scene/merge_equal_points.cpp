#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "scene/load.h"

namespace shadowbench::scene {

// Works in place: the write position never passes the read position.
void merge_equal_points(Hair& hair) {
    if (hair.strand_begin.empty()) return;
    std::size_t kept = 0, strands = 0;
    std::uint32_t begin = hair.strand_begin.front();
    for (std::size_t s = 0; s + 1 < hair.strand_begin.size(); ++s) {
        const std::uint32_t end = hair.strand_begin[s + 1];
        const std::size_t first = kept;
        for (std::size_t i = begin; i < end; ++i) {
            if (kept > first && hair.points[i] == hair.points[kept - 1]) {
                hair.radii[kept - 1] = std::max(hair.radii[kept - 1], hair.radii[i]);
                continue;
            }
            hair.points[kept] = hair.points[i];
            hair.radii[kept++] = hair.radii[i];
        }
        begin = end;
        if (kept - first < 2) {
            kept = first;
            continue;
        }
        hair.strand_begin[strands++] = static_cast<std::uint32_t>(first);
    }
    hair.strand_begin[strands] = static_cast<std::uint32_t>(kept);
    hair.strand_begin.resize(strands + 1);
    hair.points.resize(kept);
    hair.radii.resize(kept);
}

}  // namespace shadowbench::scene
