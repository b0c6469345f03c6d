// What tests of AVSM's streams share.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "base/random.h"
#include "techniques/avsm/streams.h"
#include "techniques/hand_rays.h"

namespace shadowbench::techniques::testing {

using Nodes = std::vector<std::pair<float, float>>;

// Those in use: the last one is the first at the far plane.
inline Nodes nodes_of(const Streams& streams, std::size_t lane, int capacity) {
    Nodes result;
    for (int i = 0; i < capacity; ++i) {
        result.emplace_back(streams.depth[i][lane], streams.value[i][lane]);
        if (streams.depth[i][lane] == streams.depth[capacity - 1][lane]) break;
    }
    return result;
}

inline void shuffle(std::vector<Segment>& segments, base::Random& random) {
    for (std::size_t k = segments.size(); k > 1; --k) std::swap(segments[k - 1], segments[random.below(k)]);
}

}  // namespace shadowbench::techniques::testing
