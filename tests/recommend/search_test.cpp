// The search where laws are not smooth products of powers, and at the borders of what can be asked.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/random.h"
#include "recommend/usual_law.h"

namespace shadowbench::recommend::test {
namespace {

TEST(Search, AFloorOfTheErrorAndAxesThatDoNothingAreNoObstacle) {
    Law floor = usual("floor");
    floor.error = error_law({{0.3, 0.35}, {0.3, 0.35}, {0.3, 0.4}}, 0.045);
    Law idle = usual("idle");  // neither its samples nor its nodes change anything beyond the first steps
    idle.error = [](const Step& step) {
        return error_law({{0.3, 0.35}, {0.2, 0.35}, {0.2, 0.4}}, 0.0)({step[0], std::min(step[1], 3), std::min(step[2], 4)});
    };
    for (const double error : {0.3, 0.1, 0.08}) {
        SyntheticLab lab({floor, idle}, {}, 1);
        SCOPED_TRACE(error);
        expect_best(lab, goal_of(error));
    }
}

TEST(Search, CostsThatAreEqualOverSeveralSteps) {
    Law law = usual("blocks");
    const auto cost = law.cost;
    law.cost = [cost](const Step& step, Cost of) {
        return of == Cost::lookup ? 12.0 : cost({step[0] / 2 * 2, step[1], step[2] / 3 * 3}, of);
    };
    for (const double error : {0.3, 0.1, 0.06}) {
        SyntheticLab lab({law, usual("smooth", 0.5)}, {0.07, 0.0, 0.0}, 3);
        SCOPED_TRACE(error);
        expect_best(lab, goal_of(error));
    }
}

// Twelve families whose errors are mostly those of the same light rays. All but the first two cost more.
std::vector<Law> of_the_same_rays(bool faithful) {
    std::vector<Law> laws;
    for (int i = 0; i < 12; ++i) {
        Law law = usual("technique " + std::to_string(i), 0.1 + 0.01 * i, i < 2 ? 1000.0 : 1500.0 + 100.0 * i);
        law.error = error_law({{0.5, 0.35}, {0.3, 0.35}, {0.1 + 0.01 * i, 0.4}}, 0.0);
        law.family.faithful = faithful;
        laws.push_back(law);
    }
    return laws;
}

TEST(Search, LearnsFromOneFamilyWhatLightRaysLeaveToOthers) {
    for (const double error : {0.3, 0.12, 0.08}) {
        SCOPED_TRACE(error);
        SyntheticLab alone(of_the_same_rays(false), {0.02, 0.01, 0.01}, 5),
            together(of_the_same_rays(true), {0.02, 0.01, 0.01}, 5);
        explore(alone, goal_of(error), {});
        expect_best(together, goal_of(error));
        EXPECT_LT(static_cast<double>(together.trials()), 0.9 * static_cast<double>(alone.trials()));
    }
}

TEST(Search, AFamilyThatFiltersBetterThanOthersIsNotRuledOutByThem) {
    // The last one errs 1.5 times less than all others with the same light rays.
    std::vector<Law> laws = of_the_same_rays(true);
    Law better = usual("better", 0.1, 1000.0);
    better.error = [](const Step& step) { return error_law({{0.5, 0.35}, {0.3, 0.35}, {0.1, 0.4}}, 0.0)(step) / 1.5; };
    better.family.faithful = true;
    laws.push_back(better);
    for (const double error : {0.3, 0.12, 0.08}) {
        SCOPED_TRACE(error);
        SyntheticLab lab(laws, {}, 5);
        expect_best(lab, goal_of(error));
    }
}

TEST(Search, ATechniqueThatAlwaysFailsIsLeftAfterFewTrials) {
    Law broken = usual("broken", 0.01, 1.0);
    broken.failed = [](const Step&) { return std::string("visibility rises"); };
    SyntheticLab lab({broken, usual("sound")}, {}, 1);
    Exploration found;
    expect_best(lab, goal_of(0.1), &found);
    std::size_t tried = 0;
    for (const Measured& measured : found.measured) tried += measured.point.family == 0;
    EXPECT_GE(tried, 1u);
    EXPECT_LE(tried, 3u);
}

TEST(Search, SettingsThatFailBeyondSomeStepAreNotTheAnswer) {
    // It would be by far the cheapest if it did not fail there; and it is the best below.
    for (const std::size_t failing : {0u, 2u})
        for (const int from : {2, 5}) {
            Law partly = usual("partly", 0.2, 500.0);
            partly.failed = [failing, from](const Step& step) {
                return step[failing] >= from ? std::string("outside [0, 1]") : std::string();
            };
            SyntheticLab lab({partly, usual("sound")}, {}, 1);
            SCOPED_TRACE(testing::Message() << "axis " << failing << " from " << from);
            expect_best(lab, goal_of(0.12));
        }
}

TEST(Search, BumpsOfAFewPercentCostAFewPercentAtMost) {
    // Errors and bytes of neighbouring steps differ by up to 4 % from smooth laws, so that they are not monotone.
    const auto bump = [](const Step& step, std::uint64_t key) {
        std::uint64_t bits = key;
        for (const int s : step) bits = base::hash(bits, static_cast<std::uint64_t>(s));
        return 1.0 + 0.04 * (2.0 * base::to_unit(bits) - 1.0);
    };
    int missed = 0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        std::vector<Law> laws{usual("a", 0.3), usual("b", 0.4)};
        for (std::size_t i = 0; i < laws.size(); ++i) {
            const auto error = laws[i].error;
            const auto cost = laws[i].cost;
            laws[i].error = [=](const Step& step) { return error(step) * bump(step, 10 * seed + i); };
            laws[i].cost = [=](const Step& step, Cost of) { return cost(step, of) * bump(step, 10 * seed + i + 5); };
        }
        SyntheticLab lab(laws, {0.05, 0.01, 0.01}, seed);
        const Goal goal = goal_of(0.08 + 0.002 * static_cast<double>(seed));
        const Exploration found = explore(lab, goal, {});
        for (const Cost cost : {Cost::lookup, Cost::bytes, Cost::build}) {
            const double excess = found_cost(lab, found, cost) / cheapest(lab, goal, cost) - 1.0;
            if (excess > 0.05) ++missed;
        }
    }
    EXPECT_LE(missed, 1);  // of 60
}

TEST(Search, AnErrorThatNothingReachesIsFoundOutWithoutMeasuringEverything) {
    Law floor = usual("floor");
    floor.error = error_law({{0.3, 0.35}, {0.3, 0.35}, {0.3, 0.4}}, 0.2);
    SyntheticLab lab({usual("a"), floor}, {}, 1);
    const Exploration found = explore(lab, goal_of(0.01), {});
    EXPECT_EQ(found.end, End::complete);
    EXPECT_TRUE(found.confirmed.empty());
    EXPECT_LT(lab.trials(), 40u);
}

TEST(Search, AnErrorThatEverythingReachesIsAnsweredByTheCheapestSettings) {
    SyntheticLab lab({usual("a"), usual("b", 0.5)}, {}, 1);
    expect_best(lab, goal_of(5.0));
    EXPECT_LE(lab.trials(), 4u);
}

TEST(Search, LimitsOfOtherCostsHold) {
    SyntheticLab lab({usual("a"), usual("b", 0.5)}, {}, 1);
    Goal goal = goal_of(0.1);
    const double free_lookup = cheapest(lab, goal, Cost::lookup);
    goal.asked = {true, false, false};
    goal.at_most[static_cast<std::size_t>(Cost::bytes)] = 1.02 * cheapest(lab, goal, Cost::bytes);
    ASSERT_GT(cheapest(lab, goal, Cost::lookup), free_lookup);  // the limit matters
    expect_best(lab, goal);
}

TEST(Search, ALimitThatNothingKeepsGivesNoAnswer) {
    SyntheticLab lab({usual("a")}, {}, 1);
    Goal goal = goal_of(0.1);
    goal.at_most[static_cast<std::size_t>(Cost::bytes)] = 10.0;
    const Exploration found = explore(lab, goal, {});
    EXPECT_TRUE(found.confirmed.empty());
    EXPECT_EQ(found.end, End::complete);
}

TEST(Search, OneFamilyAndAxesOfOneStep) {
    Law traced = usual("traced");
    traced.family.axes = {axis("resolution", 1, 1), axis("samples", 1, 1), axis("rays", 8, 2)};
    SyntheticLab alone({traced}, {}, 1);
    expect_best(alone, goal_of(0.5));
    Law single = usual("single");
    for (Axis& a : single.family.axes) a = axis(a.name, 1, 1);
    SyntheticLab point({single, usual("usual")}, {}, 1);
    expect_best(point, goal_of(0.3));
}

TEST(Search, TheScoutSavesWorkAndDoesNotBoundFamiliesWithoutLightRays) {
    std::vector<Law> laws{usual("uncompressed", 1e-9, 1e5), usual("a", 0.3), usual("b", 0.25), usual("traced", 0.5)};
    laws[0].family.axes.pop_back();
    laws[0].error = error_law({{0.3, 0.35}, {0.3, 0.35}}, 0.0);
    laws[0].cost = [](const Step& step, Cost) { return product_law(1e4, {0.69, 0.69}, step); };
    laws[3].family.axes = {axis("resolution", 1, 1), axis("samples", 1, 1), axis("rays", 8, 1)};
    laws[3].error = error_law({{0.0, 0.0}, {0.0, 0.0}, {0.5, 0.5}}, 0.0);
    SyntheticLab blind(laws, {}, 1), led(laws, {}, 1, 0);
    expect_best(blind, goal_of(0.05));
    expect_best(led, goal_of(0.05));
    EXPECT_LE(led.trials(), blind.trials());
}

TEST(Search, CancellingEndsBeforeTheNextMeasurement) {
    SyntheticLab lab({usual("a"), usual("b", 0.5)}, {}, 1);
    Hooks hooks;
    hooks.cancelled = [&lab] { return lab.trials() == 5; };
    const Exploration found = explore(lab, goal_of(0.1), hooks);
    EXPECT_EQ(found.end, End::cancelled);
    EXPECT_EQ(found.measured.size(), 5u);
    EXPECT_TRUE(found.confirmed.empty());
}

TEST(Search, ProgressNamesEveryMeasurement) {
    SyntheticLab lab({usual("a")}, {}, 1);
    std::size_t reports = 0;
    Hooks hooks;
    hooks.progress = [&](const Progress& progress) {
        reports += progress.stage != Stage::confirming;
        EXPECT_GE(progress.open, 1u);
    };
    const Exploration found = explore(lab, goal_of(0.1), hooks);
    EXPECT_EQ(reports, found.measured.size());
}

TEST(Search, NoPointIsMeasuredTwiceAndTheSameSeedMeasuresTheSame) {
    const auto run = [] {
        SyntheticLab lab({usual("a"), usual("b", 0.5)}, {0.07, 0.02, 0.02}, 9);
        return explore(lab, goal_of(0.1), {});
    };
    const Exploration first = run(), second = run();
    ASSERT_EQ(first.measured.size(), second.measured.size());
    for (std::size_t i = 0; i < first.measured.size(); ++i) {
        EXPECT_EQ(first.measured[i].point, second.measured[i].point);
        for (std::size_t j = 0; j < i; ++j) EXPECT_FALSE(first.measured[i].point == first.measured[j].point);
    }
}

TEST(Search, AnErrorThatIsNotANumberCountsAsAFailure) {
    Law law = usual("nan", 0.01, 1.0);
    law.error = [](const Step&) { return std::nan(""); };
    SyntheticLab lab({law, usual("sound")}, {}, 1);
    const Exploration found = explore(lab, goal_of(0.1), {});
    for (const Answered& answered : found.confirmed) EXPECT_EQ(answered.point.family, 1u);
    EXPECT_FALSE(found.confirmed.empty());
}

TEST(Search, BytesOfTechniquesWithoutAMapAreNoQuestion) {
    Law traced = usual("traced");
    traced.family.mapless = true;
    SyntheticLab lab({traced}, {}, 1);
    Goal goal = goal_of(0.1);
    goal.asked = {false, true, true};
    EXPECT_THROW(explore(lab, goal, {}), base::Error);
    EXPECT_EQ(lab.trials(), 0u);
    goal.asked = {true, true, true};
    EXPECT_TRUE(std::isfinite(found_cost(lab, explore(lab, goal, {}), Cost::lookup)));
}

TEST(Search, GoalsWithoutMeaningAreRefused) {
    SyntheticLab lab({usual("a")}, {}, 1);
    Goal nothing = goal_of(0.1), hasty = goal_of(0.1);
    nothing.asked = {false, false, false};
    hasty.budget = 0.0;
    for (const Goal& goal : {goal_of(0.0), goal_of(-1.0), goal_of(std::nan("")), goal_of(infinity), nothing, hasty})
        EXPECT_THROW(explore(lab, goal, {}), base::Error);
    EXPECT_EQ(lab.trials(), 0u);
}

}  // namespace
}  // namespace shadowbench::recommend::test
