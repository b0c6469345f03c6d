// A usual technique as a law, and what a search over such must find.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "recommend/search.h"
#include "recommend/synthetic.h"

namespace shadowbench::recommend::test {

using Step = std::vector<int>;

constexpr double infinity = std::numeric_limits<double>::infinity();

// Resolution, samples and one own parameter. Bytes double with every resolution step.
inline Law usual(const std::string& technique, double own_scale = 0.3, double bytes = 1000.0) {
    Law law;
    law.family = {technique, technique, {axis("resolution", 9, 2), axis("samples", 6, 2), axis("nodes", 8, 2)}};
    law.error = error_law({{0.3, 0.35}, {0.3, 0.35}, {own_scale, 0.4}}, 0.0);
    law.cost = [bytes](const Step& step, Cost cost) {
        switch (cost) {
            case Cost::lookup: return product_law(10.0, {0.05, 0.1, 0.2}, step);
            case Cost::bytes: return product_law(bytes, {0.69, 0.05, 0.3}, step);
            case Cost::build: break;
        }
        return product_law(1.0, {0.69, 0.6, 0.1}, step);
    };
    return law;
}

inline Goal goal_of(double error) {
    Goal goal;
    goal.error = error;
    return goal;
}

inline double found_cost(const SyntheticLab& lab, const Exploration& found, Cost cost) {
    double least = infinity;
    for (const Answered& answered : found.confirmed) {
        bool good = answered.confirmed.failed.empty() && answered.confirmed.error.high <= found.goal.error;
        for (std::size_t k = 0; k < costs; ++k)
            good = good && answered.confirmed.interval[k].high <= found.goal.at_most[k];
        if (good) least = std::min(least, lab.cost(answered.point, cost));
    }
    return least;
}

// The search finds the least bytes exactly, and times within 5 %.
inline void expect_best(SyntheticLab& lab, const Goal& goal, Exploration* out = nullptr) {
    const Exploration found = explore(lab, goal, {});
    for (std::size_t k = 0; k < costs; ++k) {
        const Cost cost = static_cast<Cost>(k);
        if (!goal.asked[k]) continue;
        const double best = cheapest(lab, goal, cost);
        ASSERT_TRUE(std::isfinite(best));
        EXPECT_LE(found_cost(lab, found, cost), best * (cost == Cost::bytes ? 1.0 + 1e-12 : 1.05)) << "cost " << k;
    }
    EXPECT_EQ(found.end, End::complete);
    EXPECT_LT(lab.trials(), lab.points().size());
    if (out) *out = found;
}

}  // namespace shadowbench::recommend::test
