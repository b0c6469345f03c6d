#include "results/fronts.h"

#include <limits>
#include <vector>

#include "metrics/pareto.h"

namespace shadowbench::results {

void mark_fronts(std::span<Cell> cells) {
    constexpr double none = std::numeric_limits<double>::infinity();
    std::vector<metrics::CostAndError> time, bytes;
    for (const Cell& cell : cells) {
        const bool counts = cell.status == CellStatus::ok && cell.lookup;
        const double error = counts ? cell.lookup->norms.rms : none;
        time.push_back({counts && cell.times ? cell.times->random_order.ns.median : none, error});
        bytes.push_back({static_cast<double>(cell.bytes), error});
    }
    const std::vector<bool> on_time = metrics::pareto_front(time), on_bytes = metrics::pareto_front(bytes);
    for (std::size_t i = 0; i < cells.size(); ++i) {
        cells[i].on_bytes_front = on_bytes[i];
        if (cells[i].times) cells[i].times->on_front = on_time[i];
    }
}

}  // namespace shadowbench::results
