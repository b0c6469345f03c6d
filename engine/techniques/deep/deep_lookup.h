// Lookups in a deep shadow map: Lokovic and Veach 2000, sections 3.4 and 5.3.
#pragma once

#include <span>
#include <vector>

#include "techniques/deep/deep_level.h"
#include "techniques/deep/segment_search.h"
#include "techniques/technique.h"

namespace shadowbench::techniques {

enum class Mip {
    none,     // the map alone
    nearest,  // one level, the one whose pixels suit the footprint best
    blend,    // the two levels around that, weighed by how near each is
};

// How a lookup weighs pixels. With q's footprint of `width` pixels of the level in question, centred at (x, y), pixel
// (i, j) weighs f(i + 1/2 - x) f(j + 1/2 - y):
//   box: 1 within width / 2, at least the nearest pixel;
//   tent: 1 - |d| / width, twice as wide; bilinear interpolation at a width of 1, which is the least.
// A coarser level's pixel that the map's edge cuts weighs as much less.
//
// With mip levels a box reads levels whose pixels the footprint is about two wide of, a tent about one: with l =
// log2(width / 2) or log2(width), `nearest` reads level round(l), `blend` the levels floor(l) and floor(l) + 1 with
// weights 1 - frac(l) and frac(l). So a lookup reads 4 x 4 pixels of a level at most, however wide it is.
struct LookupRule {
    bool tent = false;
    Mip mip = Mip::none;
    Search search = Search::binary;
};

// See Map::lookup and Map::touched; levels[0] is the map, each further one half as wide.
void lookup(std::span<const DeepLevel> levels, const LookupRule& rule, std::span<const Query> queries,
            std::span<float> visibility);
void touched(std::span<const DeepLevel> levels, const LookupRule& rule, const Query& query,
             std::vector<const void*>& lines);

}  // namespace shadowbench::techniques
