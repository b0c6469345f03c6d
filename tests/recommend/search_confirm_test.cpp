// What the search confirms, and in which time.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "recommend/usual_law.h"

namespace shadowbench::recommend::test {
namespace {

// Confirmed errors exceed those of trials by a twentieth, so that the best setting often errs too much, and the budget
// ends after one round of confirming. A setting of the same light rays that errs less costs little beside it.
TEST(Search, ASaferSettingOfTheSameLightRaysIsConfirmedBesideTheBest) {
    class Slow : public SyntheticLab {
    public:
        using SyntheticLab::SyntheticLab;
        double confirm_effort(const Point&, std::span<const Point> others) const override {
            return others.empty() ? 10.0 : 0.5;
        }
        std::vector<Confirmed> confirm(std::span<const Point> points, const Confirming& how) override {
            for (std::size_t i = 0; i < points.size(); ++i) confirming += confirm_effort(points[i], points.first(i));
            return SyntheticLab::confirm(points, how);
        }
        double confirming = 0.0;  // seconds
    };
    Law law = usual("technique");
    law.family.axes = {axis("resolution", 1, 2), axis("samples", 1, 2), axis("nodes", 60, 2)};
    law.error = error_law({{0.0, 0.0}, {0.0, 0.0}, {0.3, 0.03}}, 0.0);
    law.cost = [](const Step& step, Cost) { return product_law(10.0, {0.0, 0.0, 0.03}, step); };
    for (int i = 0; i < 20; ++i) {
        Slow lab({law}, {0.02, 0.0, 0.05}, 1);
        Goal goal = goal_of(0.1 + 0.005 * i);
        goal.asked = {true, true, false};
        goal.budget = 14.0;
        Hooks hooks;
        hooks.seconds = [&lab] { return lab.seconds() + lab.confirming; };
        EXPECT_TRUE(std::isfinite(found_cost(lab, explore(lab, goal, hooks), Cost::lookup))) << goal.error;
    }
}

// Confirming shadow rays is slow, but without them there would be no answer.
TEST(Search, WhereNoMapReachesTheErrorOneWithoutAMapIsConfirmedHoweverDear) {
    Law floor = usual("floor"), traced = usual("traced");
    floor.error = error_law({{0.3, 0.35}, {0.3, 0.35}, {0.3, 0.4}}, 0.2);
    traced.family.mapless = true;
    for (const double budget : {2.0, 10.0}) {
        SyntheticLab lab({floor, traced}, {}, 1);
        Goal goal = goal_of(0.15);
        goal.asked = {true, true, false};
        goal.budget = budget;
        Hooks hooks;
        hooks.seconds = [&lab] { return lab.seconds(); };
        EXPECT_TRUE(std::isfinite(found_cost(lab, explore(lab, goal, hooks), Cost::lookup))) << budget;
    }
}

TEST(Search, AFailureThatOnlyConfirmingShowsIsNotTheAnswer) {
    class Late : public SyntheticLab {
    public:
        using SyntheticLab::SyntheticLab;
        std::vector<Confirmed> confirm(std::span<const Point> points, const Confirming& how) override {
            std::vector<Confirmed> answers = SyntheticLab::confirm(points, how);
            for (std::size_t i = 0; i < points.size(); ++i)
                if (points[i].family == 0 && points[i].step[2] >= 4)
                    answers[i].failed = "broke its promise with seed 3";
            return answers;
        }
    };
    Late lab({usual("late", 0.25), usual("sound", 0.4)}, {}, 1);
    const Exploration found = explore(lab, goal_of(0.1), {});
    EXPECT_TRUE(std::isfinite(found_cost(lab, found, Cost::bytes)));
}

TEST(Search, AShortBudgetIsKeptAndStillGivesAnAnswer) {
    SyntheticLab whole({usual("a"), usual("b", 0.5)}, {}, 1);
    explore(whole, goal_of(0.1), {});
    SyntheticLab lab({usual("a"), usual("b", 0.5)}, {}, 1);
    Goal goal = goal_of(0.1);
    goal.budget = 0.5 * whole.seconds();
    Hooks hooks;
    hooks.seconds = [&lab] { return lab.seconds(); };
    const Exploration found = explore(lab, goal, hooks);
    EXPECT_EQ(found.end, End::budget);
    EXPECT_LT(lab.seconds(), goal.budget + 1.0);  // the trial under way is finished
    EXPECT_TRUE(std::isfinite(found_cost(lab, found, Cost::bytes)));
}

// "slow" reaches the error only where a map takes 10 s, and five times that to confirm.
TEST(Search, ARunnerUpThatWouldTakeMostOfTheTimeIsLeftIfTimeIsLimited) {
    Law slow = usual("slow");
    slow.error = error_law({{1.2, 0.35}, {0.3, 0.35}, {0.3, 0.4}}, 0.0);
    const std::vector<Law> laws{usual("a"), slow};
    const auto confirms_slow = [](const Exploration& found) {
        return std::any_of(found.confirmed.begin(), found.confirmed.end(),
                           [](const Answered& answered) { return answered.point.family == 1; });
    };
    SyntheticLab unlimited(laws, {}, 1);
    EXPECT_TRUE(confirms_slow(explore(unlimited, goal_of(0.1), {})));
    SyntheticLab lab(laws, {}, 1);
    Goal goal = goal_of(0.1);
    goal.budget = 60.0;
    Hooks hooks;
    hooks.seconds = [&lab] { return lab.seconds(); };
    const Exploration found = explore(lab, goal, hooks);
    EXPECT_FALSE(confirms_slow(found));
    EXPECT_EQ(found.end, End::budget) << "the answer says that something was left";
    EXPECT_LE(found_cost(lab, found, Cost::bytes), cheapest(lab, goal, Cost::bytes) * (1.0 + 1e-12));
}

// "The budget ended" with most of it left says nothing; here no step of "huge" fits, whatever is left.
TEST(Search, SaysHowLongTheStepTakesThatTheRestOfTheBudgetIsTooShortFor) {
    class Huge : public SyntheticLab {
    public:
        using SyntheticLab::SyntheticLab;
        double effort(const Point& point) const override {
            return SyntheticLab::effort(point) + (point.family == 1 ? 100.0 : 0.0);
        }
    };
    Huge lab({usual("a"), usual("huge")}, {}, 1);
    Goal goal = goal_of(0.1);
    goal.budget = 60.0;
    Hooks hooks;
    hooks.seconds = [&lab] { return 3.0 + lab.seconds(); };
    const Exploration found = explore(lab, goal, hooks);
    EXPECT_EQ(found.end, End::budget);
    EXPECT_EQ(found.before, 3.0);
    ASSERT_TRUE(found.next);
    EXPECT_GE(found.next->seconds, 100.0);
    EXPECT_GT(found.next->left, 0.0);
    EXPECT_NEAR(found.next->left, 60.0 - 3.0 - lab.seconds(), 1e-9);
}

// A first step of "late" takes more than a tenth of the time that exploring has, so that it waits; once the best are
// confirmed there is time for it.
TEST(Search, WhatSeemedTooLongIsMeasuredInTheTimeThatConfirmingLeft) {
    class Late : public SyntheticLab {
    public:
        using SyntheticLab::SyntheticLab;
        double effort(const Point& point) const override {
            return SyntheticLab::effort(point) + (point.family == 1 ? 20.0 : 0.0);
        }
        std::vector<Confirmed> confirm(std::span<const Point> points, const Confirming& how) override {
            if (measured_late == 0) early = true;
            return SyntheticLab::confirm(points, how);
        }
        Trial measure(const Point& point) override {
            measured_late += point.family == 1;
            return SyntheticLab::measure(point);
        }
        int measured_late = 0;
        bool early = false;  // whether something was confirmed before
    };
    Law late = usual("late");
    late.error = error_law({{0.3, 0.35}, {0.3, 0.35}, {0.3, 0.4}}, 0.0);
    Late lab({usual("a"), late}, {}, 1);
    Goal goal = goal_of(0.1);
    goal.budget = 60.0;
    Hooks hooks;
    hooks.seconds = [&lab] { return lab.seconds() + (lab.early ? 0.0 : 25.0); };
    explore(lab, goal, hooks);
    EXPECT_TRUE(lab.early);
    EXPECT_GE(lab.measured_late, 1);
}

// Others within noise of the best would take too long to confirm: confirming the best again tells nothing new.
TEST(Search, WithoutNewSettingsNothingIsConfirmedAgain) {
    class Slow : public SyntheticLab {
    public:
        using SyntheticLab::SyntheticLab;
        double confirm_effort(const Point&, std::span<const Point>) const override { return 20.0; }
        std::vector<Confirmed> confirm(std::span<const Point> points, const Confirming& how) override {
            ++rounds;
            return SyntheticLab::confirm(points, how);
        }
        int rounds = 0;
    };
    Law law = usual("technique");
    law.cost = [](const Step& step, Cost) { return product_law(10.0, {0.01, 0.01, 0.01}, step); };
    Slow lab({law}, {}, 1);
    Goal goal = goal_of(0.1);
    goal.asked = {true, false, false};
    goal.budget = 60.0;
    Hooks hooks;
    hooks.seconds = [&lab] { return lab.seconds() + lab.rounds; };
    const Exploration found = explore(lab, goal, hooks);
    EXPECT_TRUE(std::isfinite(found_cost(lab, found, Cost::lookup)));
    EXPECT_EQ(lab.rounds, 1);
}

// Confirmed errors exceed those of trials by a tenth, which the first round shows by one setting: the next that is
// confirmed errs little enough.
TEST(Search, InALimitedTimeOneConfirmedErrorTellsHowMuchTrialsAreOff) {
    Law law = usual("technique");
    law.family.axes = {axis("resolution", 1, 2), axis("samples", 1, 2), axis("nodes", 60, 2)};
    law.error = error_law({{0.0, 0.0}, {0.0, 0.0}, {0.3, 0.03}}, 0.0);
    law.cost = [](const Step& step, Cost) { return product_law(10.0, {0.0, 0.0, 0.03}, step); };
    class Slow : public SyntheticLab {
    public:
        using SyntheticLab::SyntheticLab;
        double confirm_effort(const Point&, std::span<const Point>) const override { return 12.0; }
    };
    for (int i = 0; i < 20; ++i) {
        Slow lab({law}, {0.0, 0.0, 0.1}, 1);
        Goal goal = goal_of(0.1 + 0.005 * i);
        goal.asked = {true, false, false};
        goal.budget = 40.0;
        Hooks hooks;
        hooks.seconds = [&lab] { return lab.seconds() + 12.0 * static_cast<double>(lab.confirmed()); };
        EXPECT_TRUE(std::isfinite(found_cost(lab, explore(lab, goal, hooks), Cost::lookup))) << goal.error;
    }
}

}  // namespace
}  // namespace shadowbench::recommend::test
