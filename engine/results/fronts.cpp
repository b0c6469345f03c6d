#include "results/fronts.h"

#include <vector>

#include "results/differences.h"

namespace shadowbench::results {
namespace {

using metrics::OnFront;

std::vector<OnFront> marks_of(const Differences& choices, const metrics::Difference& cost) {
    return metrics::front_of_intervals(choices.size(), cost,
                                       [&](std::size_t a, std::size_t b) { return choices.errors(a, b); });
}

}  // namespace

void mark_fronts(LightResult& light) {
    for (Cell& cell : light.cells) {
        cell.on_bytes_front = OnFront::no;
        if (cell.times) cell.times->on_front = OnFront::no;
    }
    const std::vector<std::size_t> all = comparable(light, false), timed = comparable(light, true);
    const Differences sized(light, all), clocked(light, timed);
    const std::vector<OnFront> by_bytes =
        marks_of(sized, [&](std::size_t a, std::size_t b) { return sized.bytes(a, b); });
    std::vector<OnFront> by_time(timed.size(), OnFront::perhaps);
    if (times_count(light))
        by_time = marks_of(clocked, [&](std::size_t a, std::size_t b) { return clocked.times(a, b); });
    for (std::size_t i = 0; i < all.size(); ++i) light.cells[all[i]].on_bytes_front = by_bytes[i];
    for (std::size_t i = 0; i < timed.size(); ++i) light.cells[timed[i]].times->on_front = by_time[i];
}

}  // namespace shadowbench::results
