#include "bench/repeat.h"

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

void repeat(const RepeatRule& rule, const std::function<void(std::size_t round)>& round,
            const std::function<bool()>& all_narrow) {
    double beyond = 0.0, last = 0.0;  // seconds
    for (std::size_t done = 0; goes_on(rule, done, beyond + last, all_narrow); ++done) {
        const Stopwatch stopwatch;
        round(done);
        last = stopwatch.seconds();
        if (done >= rule.least) beyond += last;
    }
}

}  // namespace shadowbench::bench
