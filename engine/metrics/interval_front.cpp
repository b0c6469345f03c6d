#include "metrics/interval_front.h"

#include <algorithm>

namespace shadowbench::metrics {
namespace {

bool equal(const Interval& difference) {
    return difference.low == 0.0 && difference.high == 0.0;
}

Interval reversed(const Interval& difference) {
    return {-difference.high, -difference.low};
}

// Marks `b` by what `a` may do to it, given their differences a - b.
void judge(const Interval& cost, const Interval& error, OnFront& b) {
    const bool worse = cost.low > 0.0 || error.low > 0.0;
    if (worse || (equal(cost) && equal(error))) return;
    const bool not_worse = cost.high <= 0.0 && error.high <= 0.0;
    const bool better = cost.high < 0.0 || error.high < 0.0;
    b = std::min(b, not_worse && better ? OnFront::no : OnFront::perhaps);
}

}  // namespace

const char* to_string(OnFront on) {
    return on == OnFront::no ? "no" : on == OnFront::perhaps ? "perhaps" : "certainly";
}

std::vector<OnFront> front_of_intervals(std::size_t choices, const Difference& cost, const Difference& error) {
    std::vector<OnFront> marks(choices, OnFront::certainly);
    for (std::size_t a = 0; a < choices; ++a)
        for (std::size_t b = a + 1; b < choices; ++b) {
            const Interval costs = cost(a, b), errors = error(a, b);
            judge(costs, errors, marks[b]);
            judge(reversed(costs), reversed(errors), marks[a]);
        }
    return marks;
}

double tail_of_front(std::size_t choices, double confidence) {
    const double intervals = std::max(1.0, static_cast<double>(choices) * (static_cast<double>(choices) - 1.0));
    return 0.5 * (1.0 - confidence) / intervals;
}

}  // namespace shadowbench::metrics
