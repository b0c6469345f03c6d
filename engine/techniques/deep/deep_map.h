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
    bool levels_of_samples = false;  // coarser levels are made of the functions before they are compressed
    std::vector<DeepLevel> levels;   // the map, then its mip levels if the rule asks for them
    std::size_t peak_bytes = 0;

    // Throws Error{bad_input} if the layout's apron is narrower than the filter's.
    void begin(const rays::MapLayout& map_layout);
    // `functions`: of the tile's rays, if they are made already, for a tile of one channel and a filter of one pixel; or
    // null.
    void add(const rays::LightRays& tile, const curves::RayFunctions* functions = nullptr);
    void finish();
    // Replaces those three calls: makes a map one pixel high from given functions.
    void make(std::span<const curves::Curve> functions);

    // See Map::weights; call it while the rays still exist.
    void weights(int x, int y, const rays::LightRays& tile, std::vector<curves::WeightedRay>& out) const;

    // See Map::fewest_nodes; of the map's own functions, without mip levels.
    FewestNodes fewest_nodes(int x, int y, const rays::LightRays& tile) const;

    std::size_t bytes() const;
    NodeStats stats() const;  // of the map's own functions, without mip levels

private:
    double linearisation() const;     // of the layout's rays
    Compression after_lines() const;  // with what linearisation() leaves of the tolerance
    void begin_tiles(std::size_t count);
    void place(std::size_t tile, int x0, int y0, int width, int channels);
    void append(std::size_t tile, PixelScratch& scratch, int functions, const Compression& how);
    void put_together(std::size_t scratch_bytes, int width, int height, int channels);

    rays::MapLayout layout_;
    std::vector<PixelRun> runs_;              // one for each tile
    std::vector<PixelRun> lossless_;          // the same uncompressed, if coarser levels are made of them
    std::vector<std::size_t> scratch_bytes_;  // for each tile
};

// The share of a tolerance for drawing a medium's exponentials as lines. Compression has the rest, so that both
// together stay within the tolerance.
double linearisation_of(double tolerance);

}  // namespace shadowbench::techniques
