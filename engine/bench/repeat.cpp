#include "bench/repeat.h"

#include <optional>

#include "bench/clock.h"

namespace shadowbench::bench {
namespace {

constexpr std::size_t first_look = 7, looks_apart = 4;

bool is_look(std::size_t done) {
    return done >= first_look && (done - first_look) % looks_apart == 0;
}

}  // namespace

bool goes_on(const RepeatRule& rule, std::size_t done, double seconds_beyond, const std::function<bool()>& all_narrow) {
    if (done < rule.least) return true;
    if (done >= rule.most || seconds_beyond >= rule.seconds) return false;
    return !(is_look(done) && all_narrow());
}

void repeat(const RepeatRule& rule, const std::function<void(std::size_t round)>& round,
            const std::function<bool()>& all_narrow) {
    std::optional<Stopwatch> beyond;
    std::size_t done = 0;
    for (;; ++done) {
        if (done == rule.least) beyond.emplace();
        if (!goes_on(rule, done, beyond ? beyond->seconds() : 0.0, all_narrow)) return;
        round(done);
    }
}

}  // namespace shadowbench::bench
