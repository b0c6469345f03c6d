#include "results/fronts.h"

#include <gtest/gtest.h>

namespace shadowbench::results {
namespace {

Cell cell(double ns, std::size_t bytes, double error) {
    Cell timed;
    timed.bytes = bytes;
    timed.lookup = LookupErrors{{error, error, error, error}, 0.0};
    timed.times = CellTimes{};
    timed.times->random_order.ns.median = ns;
    return timed;
}

TEST(MarkFronts, marks_cells_that_no_other_cell_beats) {
    std::vector<Cell> cells{cell(5, 100, 0.3), cell(10, 400, 0.1), cell(20, 300, 0.2), cell(30, 50, 0.05)};
    mark_fronts(cells);
    EXPECT_TRUE(cells[0].times->on_front);
    EXPECT_TRUE(cells[1].times->on_front);
    EXPECT_FALSE(cells[2].times->on_front) << "slower and less accurate than the second";
    EXPECT_TRUE(cells[3].times->on_front);
    EXPECT_FALSE(cells[1].on_bytes_front) << "the last is smaller and more accurate";
    EXPECT_TRUE(cells[3].on_bytes_front);
}

TEST(MarkFronts, does_not_count_failed_cells) {
    std::vector<Cell> cells{cell(5, 100, 0.3), cell(1, 1, 0.0)};
    cells[1].status = CellStatus::failed;
    cells[1].times.reset();
    mark_fronts(cells);
    EXPECT_TRUE(cells[0].times->on_front);
    EXPECT_TRUE(cells[0].on_bytes_front);
    EXPECT_FALSE(cells[1].on_bytes_front);
}

}  // namespace
}  // namespace shadowbench::results
