// The transmittance functions of a tile's rays, made once for several maps.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "curves/composite.h"

namespace shadowbench::curves {

class RayFunctions {
public:
    // Composites the rays of a tile of one channel, except those of pixels that hold only surfaces: a sweep over
    // surfaces needs no such functions.
    explicit RayFunctions(const rays::LightRays& tile);

    // What composite() makes of the ray. Empty if it was not made, or has no nodes.
    std::span<const Node> of(std::size_t ray) const {
        return std::span(nodes_).subspan(begin_[ray], begin_[ray + 1] - begin_[ray]);
    }

    // The scratch memory that compositing these rays took: what a map would have held that made them itself.
    std::size_t scratch_nodes() const { return ray_.capacity(); }
    std::size_t media_bytes() const { return open_.bytes(); }
    std::size_t scratch_bytes() const { return scratch_nodes() * sizeof(Node) + media_bytes(); }

private:
    std::vector<std::size_t> begin_;
    std::vector<Node> nodes_;
    std::vector<Node> ray_;
    OpenMedia open_;
};

}  // namespace shadowbench::curves
