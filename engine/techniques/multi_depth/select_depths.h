// Which n depths of the base map a cell keeps: Pagot, Comba, Oliveira 2004, section 4.3.
#pragma once

#include <span>
#include <vector>

#include "techniques/store/cells.h"

namespace shadowbench::techniques {

// Always the cell's own depth in the base map, and of the q samples around it
enum class Selection {
    maximum,  // the n - 1 deepest
    minimum,  // the n - 1 nearest
    both,     // of the n - 1 as many of the nearest as of the deepest; of an odd number one more of the deepest
    sorted,   // sorted, in n groups of equal size: the middle of each, but for the group of the cell's own depth
};

// Offsets of the q cells (the first is the cell itself) nearest to a cell: ring after ring of the square around it, in
// a ring by distance. q = 9, 25, 49: the squares of 3, 5, 7 cells.
struct Offset {
    int x, y;
};
std::vector<Offset> search_region(int q);

// `chosen` (n of them, ascending) for the cell whose own depth is samples[0]; `samples` are the q of its search region
// and are sorted. Where no ray was stopped the depth is no_depth, and counts as the deepest. With fewer samples than
// depths to choose, samples are chosen more than once.
void select_depths(Selection selection, std::span<float> samples, std::span<float> chosen);

// The depths of all cells, n each, row after row. Search regions are cut at the border of the map by repeating its
// outermost cells: where the map ends is no shadow's border.
std::vector<float> select_all(Selection selection, int q, int n, const CellGrid& grid, std::span<const float> base);

}  // namespace shadowbench::techniques
