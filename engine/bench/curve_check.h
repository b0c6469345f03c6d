// Stored functions beside the uncompressed functions of the same light rays: the curve error, and whether a technique
// keeps what it promises of its functions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/maps.h"
#include "bench/ray_source.h"
#include "results/result.h"
#include "techniques/technique.h"

namespace shadowbench::bench {

// One technique to check.
struct CheckedMap {
    const Maps* maps = nullptr;
    techniques::Promises promises;
    double error_bound = 0.0;  // infinity: none
    bool bound_holds = true;   // whether the bound is promised for these rays at all
    int apron = 0;             // of the tiles that it is built from
};

struct CurveVerdict {
    std::optional<results::CurveErrors> errors;  // nothing when the technique stores no function
    std::string broken;                          // the first promise that is broken; empty: none
};

// Checks all maps in one pass over the light rays, tiles in parallel. Of maps with more than `max_cells` cells an even
// share is checked.
//
// In media a reference curve joins exponentials by lines, and errs itself: by a sixteenth of the smallest bound that is
// judged beside it, within [1e-6, 1e-4]; beyond its bound each map is allowed that and 1e-6 for rounding. Bounds of at
// most 16e-6 have a finer reference, within [2^-24, 1e-6], which an even share of about 16,384 rays' cells is held to,
// and which alone gives their errors; their other cells are held to the coarser one. Surfaces are exact.
std::vector<CurveVerdict> check_curves(const RaySource& source, const rays::MapLayout& layout,
                                       std::span<const CheckedMap> maps, std::size_t max_cells,
                                       const RaySource::Watch& watch);

}  // namespace shadowbench::bench
