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
#include "bench/result.h"
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
    std::optional<CurveErrors> errors;  // nothing when the technique stores no function
    std::string broken;                 // the first promise that is broken; empty: none
};

// How closely a reference curve joins exponentials by lines when these bounds are to be judged: a sixteenth of the
// smallest one, within [1e-6, 1e-4]. Media only; surfaces are exact.
double reference_linearisation(std::span<const CheckedMap> maps);

// Checks all maps in one pass over the light rays, tiles in parallel. Of maps with more than `max_cells` cells an even
// share is checked.
std::vector<CurveVerdict> check_curves(const RaySource& source, const rays::MapLayout& layout,
                                       std::span<const CheckedMap> maps, std::size_t max_cells,
                                       const RaySource::Watch& watch);

}  // namespace shadowbench::bench
