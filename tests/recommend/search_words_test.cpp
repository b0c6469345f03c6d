// The search over the words of techniques.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "recommend/usual_law.h"

namespace shadowbench::recommend::test {
namespace {

// Ten filters of one technique: the slowest takes 1.45 times the lookup time of the fastest, a trial is off by a seventh,
// and there is time to confirm only once.
TEST(Search, LookupsThatTrialsHardlyTellApartAreTimedAgain) {
    std::vector<Law> laws;
    for (int i = 0; i < 10; ++i) {
        Law law = usual("technique");
        law.family.name = "technique filter=" + std::to_string(i);
        law.family.axes = {axis("resolution", 5, 2), axis("samples", 1, 2), axis("nodes", 2, 1)};
        law.cost = [i](const Step& step, Cost of) {
            return of == Cost::lookup ? 10.0 * (1.0 + 0.05 * (i * 7 % 10)) : product_law(1000.0, {0.69, 0.05, 0.3}, step);
        };
        laws.push_back(law);
    }
    Goal goal = goal_of(0.5);
    goal.asked = {true, false, false};
    goal.budget = 40.0;
    int missed = 0;
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
        SyntheticLab lab(laws, {0.15, 0.0, 0.0}, seed);
        Hooks hooks;
        hooks.seconds = [&lab] { return lab.seconds() + 10.0 * static_cast<double>(lab.confirmed()); };
        const Exploration found = explore(lab, goal, hooks);
        missed += found_cost(lab, found, Cost::lookup) > 1.05 * cheapest(lab, goal, Cost::lookup);
    }
    EXPECT_LE(missed, 5);
}

// Eight kernels of one technique that store the same map: the budget ends before all are explored. Whatever setting is
// found, no other kernel looks it up in less time, and with fewer nodes it errs too much.
TEST(Search, TheBestSettingIsTriedWithAllWordsAndCoarserParametersOfItsTechnique) {
    std::vector<Law> laws;
    for (int i = 0; i < 8; ++i) {
        Law law = usual("technique");
        law.family.name = "technique kernel=" + std::to_string(i);
        const auto cost = law.cost;
        law.cost = [cost, i](const Step& step, Cost of) {
            return (of == Cost::lookup ? 1.0 - 0.04 * (i * 3 % 8) : 1.0) * cost(step, of);
        };
        laws.push_back(law);
    }
    for (const double budget : {12.0, 24.0, 48.0}) {
        SyntheticLab lab(laws, {}, 1);
        Goal goal = goal_of(0.1);
        goal.asked = {true, false, false};
        goal.budget = budget;
        Hooks hooks;
        hooks.seconds = [&lab] { return lab.seconds(); };
        const Exploration found = explore(lab, goal, hooks);
        ASSERT_TRUE(std::isfinite(found_cost(lab, found, Cost::lookup))) << budget;
        for (const Answered& answered : found.confirmed) {
            if (lab.upper_error(answered.point) > goal.error) continue;
            if (lab.cost(answered.point, Cost::lookup) > found_cost(lab, found, Cost::lookup)) continue;
            for (std::size_t f = 0; f < laws.size(); ++f)
                EXPECT_GE(lab.cost({f, answered.point.step}, Cost::lookup), lab.cost(answered.point, Cost::lookup))
                    << "budget " << budget << ", kernel " << f;
            Point coarser = answered.point;
            if (--coarser.step[2] >= 0) {
                EXPECT_GT(lab.upper_error(coarser), goal.error) << "budget " << budget;
            }
        }
    }
}

TEST(Search, EveryWordOfATechniqueIsTried) {
    // Three filters of one technique: the one in the middle of the list is the best.
    std::vector<Law> laws{usual("deep"), usual("deep"), usual("deep"), usual("other", 0.6)};
    laws[0].error = error_law({{0.6, 0.35}, {0.3, 0.35}, {0.3, 0.4}}, 0.0);
    laws[1].error = error_law({{0.15, 0.35}, {0.3, 0.35}, {0.3, 0.4}}, 0.0);
    laws[2].error = error_law({{0.5, 0.35}, {0.3, 0.35}, {0.3, 0.4}}, 0.0);
    SyntheticLab lab(laws, {}, 1);
    expect_best(lab, goal_of(0.1));
}

// Three layouts of one map: the second has the fewest bytes, the third is looked up fastest. What one of them shows of the
// error holds for all, so that the others do not climb.
TEST(Search, LayoutsOfOneMapShareTheirErrors) {
    std::vector<Law> laws;
    const double lookup[] = {1.0, 1.3, 0.7}, bytes[] = {1.0, 0.4, 1.5};
    for (std::size_t i = 0; i < 3; ++i) {
        Law law = usual("technique");
        law.family.name = "technique storage=" + std::to_string(i);
        const auto cost = law.cost;
        law.cost = [cost, factor = std::array{lookup[i], bytes[i], 1.0}](const Step& step, Cost of) {
            return factor[static_cast<std::size_t>(of)] * cost(step, of);
        };
        laws.push_back(law);
    }
    for (const double error : {0.3, 0.1, 0.06}) {
        SyntheticLab apart(laws, {}, 1);
        expect_best(apart, goal_of(error));
        std::vector<Law> alike = laws;
        for (std::size_t i = 1; i < 3; ++i) alike[i].family.answers_as = 0;
        SyntheticLab together(alike, {}, 1);
        expect_best(together, goal_of(error));
        EXPECT_LT(together.trials(), apart.trials()) << error;
    }
}

// All axes rise together in a climb: where it ends, each own axis is also tried with its cheapest step, which may suffice.
TEST(Search, EachOfSeveralOwnAxesIsProbedWhereAClimbEnds) {
    Law law = usual("technique");
    law.family.axes.push_back(axis("kernel", 8, 2));
    law.error = error_law({{0.3, 0.35}, {0.3, 0.35}, {0.3, 0.4}, {0.01, 0.4}}, 0.0);
    law.cost = [](const Step& step, Cost) { return product_law(10.0, {0.1, 0.1, 0.1, 0.3}, step); };
    SyntheticLab lab({law}, {}, 1);
    const Exploration found = explore(lab, goal_of(0.1), {});
    const auto reached = std::find_if(found.measured.begin(), found.measured.end(),
                                      [](const Measured& one) { return one.trial.error <= 0.1; });
    ASSERT_NE(reached, found.measured.end());
    for (const std::size_t own : {2u, 3u}) {
        Point probed = reached->point;
        probed.step[own] = 0;
        const auto at = std::find_if(found.measured.begin(), found.measured.end(),
                                     [&](const Measured& one) { return one.point == probed; });
        ASSERT_NE(at, found.measured.end()) << own;
        EXPECT_LE(at - reached, 2) << "right after the climb";
    }
}

}  // namespace
}  // namespace shadowbench::recommend::test
