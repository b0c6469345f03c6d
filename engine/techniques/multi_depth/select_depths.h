// Selects the n depths of the base map that a cell keeps: Pagot, Comba, Oliveira 2004, section 4.3.
#pragma once

#include <span>
#include <vector>

#include "techniques/store/cells.h"

namespace shadowbench::techniques {

// A cell always keeps its own depth in the base map, and these of the q samples around it:
enum class Selection {
    maximum,  // the n - 1 deepest
    minimum,  // the n - 1 nearest
    both,     // half of n - 1 nearest and half deepest; of an odd number one more of the deepest
    sorted,   // sorted, in n groups of equal size: the middle of each, but the cell's own depth in its group
};

// Offsets of the q cells (the first is the cell itself) nearest to a cell: ring after ring of the square around it,
// within a ring by distance. q = 9, 25, 49: the squares of 3, 5, 7 cells.
struct Offset {
    int x, y;
};
std::vector<Offset> search_region(int q);

// Writes `chosen` (n depths, ascending) for the cell whose own depth is samples[0]; `samples` are the q depths of its
// search region and are sorted. If no ray was stopped the depth is no_depth, which counts as the deepest. If there are
// fewer samples than depths to choose, samples are chosen more than once.
void select_depths(Selection selection, std::span<float> samples, std::span<float> chosen);

// The depths of all cells, n each, row after row. Search regions repeat the outermost cells at the border of the map,
// since the map's end is not the border of a shadow.
std::vector<float> select_all(Selection selection, int q, int n, const CellGrid& grid, std::span<const float> base);

}  // namespace shadowbench::techniques
