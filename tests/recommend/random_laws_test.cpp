// Hundreds of random laws: how often the search misses the best setting, by how much, and how little it measures.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <limits>

#include "recommend/search.h"
#include "recommend/synthetic.h"

namespace shadowbench::recommend::test {
namespace {

struct Tally {
    std::array<int, costs> missed{};
    std::array<double, costs> worst{};  // how much more than the best, as a share
    double lattice = 0.0, sweep = 0.0;  // seconds of the search over those of the whole lattices, and of the sweeps
};

// What the confirmed settings cost that are good enough; infinite if there are none.
double found_cost(const SyntheticLab& lab, const Exploration& found, Cost cost) {
    double least = std::numeric_limits<double>::infinity();
    for (const Answered& answered : found.confirmed)
        if (answered.confirmed.failed.empty() && answered.confirmed.error.high <= found.goal.error)
            least = std::min(least, lab.cost(answered.point, cost));
    return least;
}

Tally tally(std::uint64_t first, std::uint64_t count, Noise noise) {
    // Bytes must be the least exactly. Times within 5 %.
    constexpr std::array<double, costs> allowed{0.05, 1e-12, 0.05};
    Tally result;
    double searched = 0.0, lattices = 0.0, sweeps = 0.0;
    for (std::uint64_t seed = first; seed < first + count; ++seed) {
        const RandomCase random = random_case(seed);
        SyntheticLab lab(random.laws, noise, seed);
        Goal goal;
        goal.error = random.error * (1.0 + noise.interval);
        const Exploration found = explore(lab, goal, {});
        EXPECT_EQ(found.end, End::complete);
        for (std::size_t k = 0; k < costs; ++k) {
            const Cost cost = static_cast<Cost>(k);
            const double excess = found_cost(lab, found, cost) / cheapest(lab, goal, cost) - 1.0;
            result.worst[k] = std::max(result.worst[k], excess);
            if (excess <= allowed[k]) continue;
            ++result.missed[k];
            std::printf("seed %d, cost %d: %.3g %% above the least\n", static_cast<int>(seed), static_cast<int>(k),
                        100.0 * excess);
        }
        searched += lab.seconds();
        lattices += lattice_effort(random.laws);
        sweeps += sweep_effort(random.laws, 100);
    }
    result.lattice = searched / lattices;
    result.sweep = searched / sweeps;
    std::printf("worst: lookup %.3g %%, bytes %.3g %%, build %.3g %%; effort: %.3g %% of lattice, %.3g %% of sweep\n",
                100.0 * result.worst[0], 100.0 * result.worst[1], 100.0 * result.worst[2], 100.0 * result.lattice,
                100.0 * result.sweep);
    return result;
}

TEST(RandomLaws, WithoutNoiseTheBestSettingsAreFoundWithFewMeasurements) {
    const Tally all = tally(1, 200, {});
    for (const int missed : all.missed) EXPECT_EQ(missed, 0);
    EXPECT_LE(all.lattice, 0.1);
    // The sweep answers with 100 settings measured as briefly as here. All three costs are asked for.
    EXPECT_LE(all.sweep, 0.2);
}

TEST(RandomLaws, WithNoiseTheSearchMissesRarely) {
    const Tally all = tally(1001, 100, {0.07, 0.02, 0.02});
    for (const int missed : all.missed) EXPECT_LE(missed, 2);
    EXPECT_LE(all.lattice, 0.1);
}

}  // namespace
}  // namespace shadowbench::recommend::test
