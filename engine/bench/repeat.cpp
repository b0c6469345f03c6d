#include "bench/repeat.h"

#include <algorithm>
#include <vector>

#include "bench/clock.h"

namespace shadowbench::bench {
namespace {

constexpr std::size_t first_look = 7, looks_apart = 4;

bool is_look(std::size_t done) {
    return done >= first_look && (done - first_look) % looks_apart == 0;
}

}  // namespace

bool goes_on(const RepeatRule& rule, std::size_t done, double seconds_with_next,
             const std::function<bool()>& all_narrow) {
    if (done < rule.least) return true;
    if (done >= rule.most || seconds_with_next >= rule.seconds) return false;
    return !(is_look(done) && all_narrow());
}

void repeat(const RepeatRule& rule, std::span<const RoundPart> parts) {
    std::vector<bool> ended(parts.size());
    double beyond = 0.0, last = 0.0;  // seconds
    const auto all_ended = [&] {
        for (std::size_t p = 0; p < parts.size(); ++p) ended[p] = ended[p] || parts[p].all_narrow();
        return std::all_of(ended.begin(), ended.end(), [](bool end) { return end; });
    };
    for (std::size_t done = 0; goes_on(rule, done, beyond + last, all_ended); ++done) {
        const Stopwatch stopwatch;
        for (std::size_t p = 0; p < parts.size(); ++p)
            if (!ended[p]) parts[p].pass(done);
        last = stopwatch.seconds();
        if (done >= rule.least) beyond += last;
    }
}

void repeat(const RepeatRule& rule, const std::function<void(std::size_t round)>& round,
            const std::function<bool()>& all_narrow) {
    const RoundPart part{round, all_narrow};
    repeat(rule, {&part, 1});
}

}  // namespace shadowbench::bench
