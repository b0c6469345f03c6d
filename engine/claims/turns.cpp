#include "claims/turns.h"

#include <algorithm>

#include "claims/intervals.h"

namespace shadowbench::claims {

Value Turns::time(std::size_t thing) const {
    return median_of(times[thing]);
}

Value Turns::ratio(std::size_t one, std::size_t other) const {
    return ratio_of(times[one], times[other]);
}

Value Turns::growth(std::span<const std::size_t> of) const {
    Value most = ratio(of[1], of[0]);
    for (std::size_t later = 2; later < of.size(); ++later)
        for (std::size_t before = 0; before < later; ++before) most = largest(most, ratio(of[later], of[before]));
    return most;
}

Turns take_turns(std::span<const std::function<double()>> things, std::span<const Compared> compared,
                 const bench::RepeatRule& rule) {
    Turns turns;
    turns.times.resize(things.size());
    const auto all_narrow = [&] {
        return std::all_of(compared.begin(), compared.end(), [&](const Compared& pair) {
            const Value ratio = turns.ratio(pair.one, pair.other);
            return 0.5 * (ratio.high - ratio.low) <= ratio_goal * ratio.value;
        });
    };
    bench::repeat(
        rule,
        [&](std::size_t round) {
            for (std::size_t k = 0; k < things.size(); ++k) {
                const std::size_t thing = round % 2 == 0 ? k : things.size() - 1 - k;
                turns.times[thing].push_back(things[thing]());
            }
        },
        all_narrow);
    return turns;
}

}  // namespace shadowbench::claims
