#include "bench/quick_timing.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel.h"
#include "base/random.h"
#include "bench/clock.h"
#include "bench/lookup_timing.h"
#include "bench/queries.h"

namespace shadowbench::bench {
namespace {

constexpr int passes = 3;
constexpr double longest_pass = 0.005;   // seconds
constexpr double shortest_pass = 0.001;  // seconds

results::Sample time(const Maps& maps, const Asked& asked, double seconds_a_lookup, std::vector<float>& answers) {
    const double once = seconds_a_lookup * static_cast<double>(asked.queries.size());
    const int rounds = static_cast<int>(std::clamp(std::ceil(shortest_pass / once), 1.0, 1000.0));
    std::vector<double> ns;
    seconds_of_pass(maps, asked, rounds, answers);
    for (int p = 0; p < passes; ++p)
        ns.push_back(1e9 * seconds_of_pass(maps, asked, rounds, answers) / rounds /
                     static_cast<double>(asked.queries.size()));
    return results::summarise(std::move(ns));
}

QuerySet shuffled(const QuerySet& set, std::size_t orders, std::uint64_t seed) {
    base::Random random(base::hash(seed));
    std::vector<std::size_t> indices(set.queries.size()), all;
    for (std::size_t i = 0; i < indices.size(); ++i) indices[i] = i;
    for (std::size_t o = 0; o < orders; ++o) {
        for (std::size_t i = indices.size(); i > 1; --i) std::swap(indices[i - 1], indices[random.below(i)]);
        all.insert(all.end(), indices.begin(), indices.end());
    }
    return pick(set.asked(), all);
}

}  // namespace

QuickTimes quick_lookup_times(const Maps& maps, const Asked& asked, std::size_t most, std::uint64_t seed) {
    const base::ThreadLimit one_thread(1);
    QuickTimes times;
    const double seconds = seconds_a_lookup(maps, asked, longest_pass);
    const std::size_t fit = static_cast<std::size_t>(std::min(longest_pass / seconds, 1e12));
    times.lookups = std::min(std::clamp(fit, run_length, std::max(most, run_length)), asked.queries.size());
    QuerySet image = pick(asked, choose_runs(asked.queries.size(), times.lookups));
    const QuerySet random = shuffled(image, random_orders(times.lookups, 2.0 * seconds), seed);
    times.random_ns = time(maps, random.asked(), seconds, times.answers);
    times.image_ns = time(maps, image.asked(), seconds, times.answers);
    times.asked = std::move(image.queries);
    return times;
}

}  // namespace shadowbench::bench
