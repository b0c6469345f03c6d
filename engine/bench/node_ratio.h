// Compares the nodes of stored functions with the fewest that do: see results::FewestNodes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "bench/maps.h"
#include "curves/curve.h"
#include "rays/light_rays.h"
#include "results/result.h"

namespace shadowbench::bench {

// Cells of a part of a map, one number a cell.
struct NodesBesideFewest {
    std::vector<double> stored, fewest;
    std::uint64_t left_out = 0;  // cells whose fewest nodes are not known
};

// Appends an even share of the cells of a tile, so that about 512 to 1,024 of the whole map are compared, or all of a
// smaller map; nothing for a technique whose fewest nodes are not defined. `tile` has the apron that the maps ask for.
void compare_nodes(const Maps& maps, const rays::LightRays& tile, const rays::MapLayout& layout,
                   NodesBesideFewest& out);

// The same for given functions, beside those that were stored for them within this tolerance.
void compare_nodes(std::span<const curves::Curve> functions, std::span<const curves::Curve> stored, double tolerance,
                   NodesBesideFewest& out);

// Of all parts of a map of so many cells. Absent if nothing was compared, or no node is needed.
std::optional<results::FewestNodes> over_fewest(std::span<const NodesBesideFewest> parts, std::uint64_t cells);

}  // namespace shadowbench::bench
