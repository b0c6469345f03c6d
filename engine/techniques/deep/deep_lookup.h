// Lookups in a deep shadow map: Lokovic and Veach 2000, sections 3.4 and 5.3.
#pragma once

#include <span>
#include <vector>

#include "techniques/deep/deep_level.h"
#include "techniques/deep/segment_search.h"
#include "techniques/technique.h"

namespace shadowbench::techniques {

enum class Mip {
    none,     // only the map
    nearest,  // one level
    blend,    // that level and the next coarser one, weighted by how near each is
};

enum class Kernel {
    box,     // the part of each pixel that the footprint covers
    tent,    // 1 - |d| / width, twice as wide; bilinear interpolation at a width of 1, the least
    pixels,  // 1 within width / 2; at least the nearest pixel
};

// How a lookup weights pixels around (x, y) over a footprint of `width`, all in pixels of the level in question. A box
// is the footprint of the reference, cut to the map, over functions that each stand for a pixel. The others are the
// paper's filter (section 3.4): pixel (i, j) has the weight f(i + 1/2 - x) f(j + 1/2 - y), "over all pixels within the
// filter radius"; a pixel of a coarser level that the map's edge cuts has proportionally less.
//
// With mip levels, let l = log2(width / 1.5), for a tent log2(width), width in map pixels. `nearest` reads level
// floor(l), where a box is 1.5 to 3 pixels wide, a tent's half 1 to 2; `blend` reads that level and the next with
// weights 1 - frac(l) and frac(l). So a lookup reads at most 4 x 4 pixels of one level and 3 x 3 of another, whatever
// its width.
struct LookupRule {
    Kernel kernel = Kernel::box;
    Mip mip = Mip::none;
    Search search = Search::binary;
    // The most probes over a known footprint (probes.h): then its answer is the mean of theirs, each weighted as a
    // lookup of its own, those outside the map left out. 0: footprints do not count, and the query's width does.
    int probes = 0;
};

// See Map::lookup_shaped and Map::touched_shaped; levels[0] is the map, each further one half as wide. There may be no
// footprints.
void lookup(std::span<const DeepLevel> levels, const LookupRule& rule, std::span<const Query> queries,
            std::span<const Footprint> footprints, std::span<float> visibility);
void touched(std::span<const DeepLevel> levels, const LookupRule& rule, const Query& query, const Footprint& footprint,
             std::vector<const void*>& lines);

}  // namespace shadowbench::techniques
