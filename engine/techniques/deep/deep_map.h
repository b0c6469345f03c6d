// A deep shadow map: light rays in, levels of compressed visibility functions out. Lokovic and Veach 2000, sections 3
// and 5.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "techniques/deep/deep_lookup.h"
#include "techniques/deep/pixel_filter.h"
#include "techniques/deep/pixel_run.h"
#include "techniques/technique.h"

namespace shadowbench::techniques {

struct DeepMap {
    Compression compression;  // of the map's functions; see mip.h for those of coarser levels
    PixelFilter filter;
    LookupRule rule;
    std::vector<DeepLevel> levels;  // the map, then its mip levels if the rule asks for them
    std::size_t peak_bytes = 0;

    // Throws Error{bad_input} when the layout's apron is narrower than the filter's.
    void begin(const rays::MapLayout& map_layout);
    void add(const rays::LightRays& tile);
    void finish();
    // Instead of those three: given functions, one pixel high.
    void make(std::span<const curves::Curve> functions);

    // See Map::weights; while the rays are still there.
    void weights(int x, int y, const rays::LightRays& tile, std::vector<curves::WeightedRay>& out) const;

    std::size_t bytes() const;
    NodeStats stats() const;  // of the map's own functions, mip levels apart

private:
    void put_together(std::span<const PixelRun> runs, std::size_t scratch_bytes, int width, int height, int channels);
    void add_coarser_levels();

    rays::MapLayout layout_;
    std::vector<PixelRun> runs_;              // one a tile
    std::vector<std::size_t> scratch_bytes_;  // a tile
};

// The share of a tolerance that goes into drawing a medium's exponentials as lines; compression has the rest, so that
// both together stay inside it.
double linearisation_of(double tolerance);

}  // namespace shadowbench::techniques
