// Compares stored functions with the uncompressed functions of the same light rays: the curve error, and whether a
// technique keeps the promises on its functions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/maps.h"
#include "bench/node_ratio.h"
#include "bench/ray_source.h"
#include "results/result.h"
#include "techniques/technique.h"

namespace shadowbench::bench {

// One technique to check.
struct CheckedMap {
    const Maps* maps = nullptr;
    techniques::Promises promises;
    double error_bound = 0.0;  // infinity: none
    bool bound_holds = true;   // whether the bound is promised for these rays
    int apron = 0;             // apron of the tiles that it is built from
    bool nodes = false;        // whether its nodes are compared with the fewest, which takes time of its own
};

struct CurveVerdict {
    std::optional<results::CurveErrors> errors;  // absent if the technique stores no function
    std::string broken;                          // describes the first broken promise; empty: none
    std::vector<NodesBesideFewest> nodes = {};   // of each tile; nothing unless asked for
};

// Checks all maps in one pass over the light rays, tiles in parallel. Of a map with more than `max_cells` cells, an
// even share is checked.
//
// In media, a reference curve approximates exponentials by lines and has an error itself: a sixteenth of the smallest
// bound that is judged with it, within [1e-6, 1e-4]. Beyond its bound, each map is allowed that error and 1e-6 for
// rounding. Bounds of at most 16e-6 have a finer reference, with errors within [2^-24, 1e-6]. It is used for an even
// share of the cells, those of about 16,384 rays, and only these cells count for the errors; the other cells are held
// to the coarser reference. Surfaces are exact.
std::vector<CurveVerdict> check_curves(const RaySource& source, const rays::MapLayout& layout,
                                       std::span<const CheckedMap> maps, std::size_t max_cells,
                                       const RaySource::Watch& watch);

}  // namespace shadowbench::bench
