#include "claims/rules.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iterator>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "base/random.h"

namespace shadowbench::claims {
namespace {

Verdict verdict(const Judged& judged) {
    return judged.verdict;
}

TEST(Rules, AreNamedOnce) {
    std::set<std::string> ids;
    for (const Rule& rule : all_rules()) {
        EXPECT_TRUE(ids.insert(rule.id).second) << rule.id;
        EXPECT_GT(std::string(rule.reason).size(), 10u) << rule.id;
    }
    for (const Judged& judged :
         {judge_ratio(2, exactly(2)), judge_added(exactly(2), exactly(2)), judge_gain(2, exactly(2)),
          judge_size(2, 3, exactly(2)),
          judge_exponent(1, exactly(1)), judge_at_most_exponent(1, exactly(1)), judge_constant(exactly(1)),
          judge_growth(exactly(3)), judge_negligible(exactly(0)), judge_less(exactly(1), exactly(2)),
          judge_much_less(exactly(1), exactly(2)),
          judge_significant(exactly(1), exactly(2)), judge_alike(exactly(1), exactly(1)), judge_likeness(exactly(0)),
          judge_fit(exactly(0)), judge_unnoticed(exactly(0)), judge_visible(exactly(1)), judge_offset(exactly(0)),
          judge_count(1, 0, 1), by_construction(true), not_comparable()})
        EXPECT_TRUE(ids.count(judged.rule)) << judged.rule;
}

TEST(Rules, ARatioHasTwoSides) {
    EXPECT_EQ(verdict(judge_ratio(15, exactly(14))), Verdict::holds);
    EXPECT_EQ(verdict(judge_ratio(15, exactly(6))), Verdict::in_shape);
    EXPECT_EQ(verdict(judge_ratio(15, exactly(4))), Verdict::fails);
    EXPECT_EQ(verdict(judge_ratio(15, exactly(40))), Verdict::in_shape);
    EXPECT_EQ(verdict(judge_ratio(15, exactly(60))), Verdict::fails);
    EXPECT_EQ(verdict(judge_ratio(2.5, exactly(0.9))), Verdict::fails) << "the other side of 1";
    EXPECT_EQ(verdict(judge_ratio(0.25, exactly(0.6))), Verdict::in_shape);
    EXPECT_EQ(verdict(judge_ratio(0.5, exactly(1.1))), Verdict::fails) << "the other side of 1";
    EXPECT_EQ(verdict(judge_ratio(1.1, exactly(0.95))), Verdict::holds) << "near, though on the other side of 1";
}

TEST(Rules, APercentageThatIsAddedHasNoSide) {
    const Value range{45, 40, 50};
    EXPECT_EQ(verdict(judge_added(range, exactly(27))), Verdict::holds) << "40 / 1.5";
    EXPECT_EQ(verdict(judge_added(range, exactly(26))), Verdict::in_shape);
    EXPECT_EQ(verdict(judge_added(range, exactly(74))), Verdict::holds) << "50 * 1.5";
    EXPECT_EQ(verdict(judge_added(range, exactly(140))), Verdict::in_shape) << "more than 100 % is nothing special";
    EXPECT_EQ(verdict(judge_added(range, exactly(13))), Verdict::fails);
    EXPECT_EQ(verdict(judge_added(range, {30, 25, 35})), Verdict::undecided);
    EXPECT_EQ(verdict(judge_added(exactly(37), exactly(30))), Verdict::holds);
}

TEST(Rules, AGainMayBeLarger) {
    EXPECT_EQ(verdict(judge_gain(15, exactly(60))), Verdict::holds);
    EXPECT_EQ(verdict(judge_gain(15, exactly(5.5))), Verdict::in_shape);
    EXPECT_EQ(verdict(judge_gain(10, exactly(1.56))), Verdict::fails) << "one to two orders of magnitude";
    EXPECT_EQ(verdict(judge_gain(2, exactly(0.9))), Verdict::fails);
}

TEST(Rules, AnIntervalThatCrossesALimitDecidesNothing) {
    EXPECT_EQ(verdict(judge_ratio(2, {2, 1.4, 2.9})), Verdict::holds);
    EXPECT_EQ(verdict(judge_ratio(2, {2, 1.2, 2.5})), Verdict::undecided);
    EXPECT_EQ(verdict(judge_ratio(2, {1.2, 1.1, 1.3})), Verdict::in_shape);
    EXPECT_EQ(verdict(judge_ratio(2, {1.0, 0.9, 1.2})), Verdict::undecided);
    EXPECT_EQ(verdict(judge_ratio(2, {0.8, 0.7, 0.9})), Verdict::fails);
    EXPECT_EQ(verdict(judge_gain(15, {14, 9, 18})), Verdict::undecided) << "it came out both ways on one engine";
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(verdict(judge_ratio(2, {nan, nan, nan})), Verdict::undecided);
    EXPECT_EQ(verdict(judge_constant({1.0, 0.9, 1.3})), Verdict::undecided);
    EXPECT_EQ(verdict(judge_constant({1.0, 0.9, 1.2})), Verdict::holds);
}

TEST(Rules, ASizeIsNearerToThePapersThanToThatWithoutItsIdea) {
    EXPECT_EQ(verdict(judge_size(2, 3, exactly(2.1))), Verdict::holds);
    EXPECT_EQ(verdict(judge_size(2, 3, exactly(2.4))), Verdict::in_shape);
    EXPECT_EQ(verdict(judge_size(2, 3, exactly(2.5))), Verdict::fails);
    EXPECT_EQ(verdict(judge_size(2, 3, exactly(1.5))), Verdict::in_shape);
    EXPECT_EQ(verdict(judge_size(2, 3, exactly(1.2))), Verdict::fails);
    EXPECT_EQ(verdict(judge_size(1.55, 4.0 / 3.0, exactly(1.31))), Verdict::fails);
    EXPECT_EQ(verdict(judge_size(1.55, 4.0 / 3.0, exactly(1.45))), Verdict::holds);
}

TEST(Rules, ABoundOfGrowthHasOneSide) {
    EXPECT_EQ(verdict(judge_at_most_exponent(0.25, exactly(0.29))), Verdict::holds);
    EXPECT_EQ(verdict(judge_at_most_exponent(0.25, exactly(-0.5))), Verdict::holds) << "less than the bound";
    EXPECT_EQ(verdict(judge_at_most_exponent(0.25, exactly(0.45))), Verdict::in_shape);
    EXPECT_EQ(verdict(judge_at_most_exponent(0.25, exactly(0.55))), Verdict::fails);
    EXPECT_EQ(verdict(judge_at_most_exponent(0.25, {0.28, 0.2, 0.36})), Verdict::undecided);
    EXPECT_EQ(judge_at_most_exponent(0.25, exactly(0.2)).limits, "holds up to 0.3, in shape up to 0.5");
}

// 0.4 of 4.0, printed with one decimal, may be anything from 0.0875 to 0.1125.
TEST(Rules, ASizeMayBeAnythingThatRoundsToThePrintedOne) {
    const Value printed{0.1, 0.0875, 0.1125};
    EXPECT_EQ(verdict(judge_size(printed, 1, exactly(0.113))), Verdict::holds);
    EXPECT_EQ(verdict(judge_size(0.1, 1, exactly(0.113))), Verdict::in_shape) << "as if more digits were printed";
    EXPECT_EQ(verdict(judge_size(printed, 1, exactly(0.123))), Verdict::holds);
    EXPECT_EQ(verdict(judge_size(printed, 1, exactly(0.125))), Verdict::in_shape);
    EXPECT_EQ(verdict(judge_size(printed, 1, exactly(0.08))), Verdict::holds);
    EXPECT_EQ(verdict(judge_size(printed, 1, exactly(0.079))), Verdict::in_shape);
    EXPECT_EQ(verdict(judge_size(printed, 1, exactly(0.064))), Verdict::fails) << "1.35 times less than 0.0875";
    EXPECT_EQ(verdict(judge_size(printed, 1, exactly(0.34))), Verdict::fails) << "nearer to 1 than to 0.1125";
    EXPECT_EQ(judge_size(exactly(0.5), 1, exactly(0.5)).limits, judge_size(0.5, 1, exactly(0.5)).limits);
}

TEST(Rules, DirectionsNeedIntervalsThatDoNotMeet) {
    EXPECT_EQ(verdict(judge_less({1, 0.9, 1.1}, {2, 1.5, 2.5})), Verdict::holds);
    EXPECT_EQ(verdict(judge_less({1, 0.9, 1.6}, {2, 1.5, 2.5})), Verdict::undecided);
    EXPECT_EQ(verdict(judge_less({2, 1.5, 2.5}, {1, 0.9, 1.1})), Verdict::fails);
    EXPECT_EQ(verdict(judge_less(exactly(1), exactly(1))), Verdict::fails);
    EXPECT_EQ(verdict(judge_much_less(exactly(1), exactly(3.4))), Verdict::holds);
    EXPECT_EQ(verdict(judge_much_less(exactly(1), exactly(3.2))), Verdict::in_shape);
    EXPECT_EQ(verdict(judge_much_less(exactly(2), exactly(1.9))), Verdict::fails);
}

TEST(Rules, WhatIsSignificantIsMoreThanSlight) {
    EXPECT_EQ(verdict(judge_significant(exactly(0.69), exactly(1))), Verdict::holds) << "an image of Reeves et al.";
    EXPECT_EQ(verdict(judge_significant(exactly(1), exactly(1.2))), Verdict::in_shape);
    EXPECT_EQ(verdict(judge_significant({0.8, 0.7, 0.9}, exactly(1))), Verdict::undecided);
    EXPECT_EQ(verdict(judge_significant(exactly(1), exactly(0.9))), Verdict::fails);
    for (const double factor : {1.1, 1.2, 1.3, 1.8})
        EXPECT_NE(verdict(judge_significant(exactly(1), exactly(factor))) == Verdict::holds,
                  verdict(judge_constant(exactly(factor))) == Verdict::holds)
            << factor;
}

TEST(Rules, AlikeHasTwoSides) {
    EXPECT_EQ(verdict(judge_alike(exactly(1), exactly(1.05))), Verdict::holds);
    EXPECT_EQ(verdict(judge_alike(exactly(1), exactly(1.2))), Verdict::in_shape);
    EXPECT_EQ(verdict(judge_alike(exactly(1.2), exactly(1))), Verdict::in_shape);
    EXPECT_EQ(verdict(judge_alike(exactly(1), exactly(2))), Verdict::fails);
    EXPECT_EQ(verdict(judge_unnoticed({-0.001, -0.003, 0.002})), Verdict::holds);
    EXPECT_EQ(verdict(judge_unnoticed(exactly(-0.01))), Verdict::fails);
    EXPECT_EQ(verdict(judge_visible(exactly(-0.01))), Verdict::holds);
    EXPECT_EQ(verdict(judge_visible({0.004, 0.003, 0.005})), Verdict::undecided);
    EXPECT_EQ(verdict(judge_visible(exactly(0.003))), Verdict::fails);
    EXPECT_EQ(verdict(judge_offset({0.8, 0.7, 0.9})), Verdict::holds);
    EXPECT_EQ(verdict(judge_offset({0.9, 0.7, 1.1})), Verdict::undecided);
    EXPECT_EQ(verdict(judge_offset({-4.0, -5.0, -3.0})), Verdict::fails) << "to either side";
}

TEST(Rules, ALikenessIsMuchLessDifferent) {
    EXPECT_EQ(verdict(judge_likeness({0.2, 0.15, 0.25})), Verdict::holds);
    EXPECT_EQ(verdict(judge_likeness({0.6, 0.5, 0.7})), Verdict::in_shape);
    EXPECT_EQ(verdict(judge_likeness({1.3, 1.1, 1.5})), Verdict::fails);
    EXPECT_EQ(verdict(judge_likeness({0.3, 0.25, 0.35})), Verdict::undecided);
    EXPECT_EQ(verdict(judge_likeness({0.9, 0.7, 1.1})), Verdict::undecided);
}

// A first look has other intervals than the full report. Where they hold those of the report, this test and the last of
// rules_joined_test.cpp leave it one way to differ: to say undecided.
TEST(Rules, AWiderIntervalSaysTheSameOrNothing) {
    using Judge = Judged (*)(const Value&);
    const Judge rules[] = {[](const Value& v) { return judge_ratio(0.5, v); },
                           [](const Value& v) { return judge_ratio(2.0, v); },
                           [](const Value& v) {
                               return judge_added({0.45, 0.4, 0.5}, v);
                           },
                           [](const Value& v) { return judge_gain(2.0, v); },
                           [](const Value& v) { return judge_size(2.0, 3.0, v); },
                           [](const Value& v) {
                               return judge_size({0.1, 0.0875, 0.1125}, 1.0, v);
                           },
                           [](const Value& v) { return judge_exponent(0.25, v); },
                           [](const Value& v) { return judge_at_most_exponent(0.25, v); },
                           [](const Value& v) { return judge_constant(v); },
                           [](const Value& v) { return judge_growth(v); },
                           [](const Value& v) { return judge_negligible(v); },
                           [](const Value& v) {
                               return judge_less(v, {1.0, 0.9, 1.1});
                           },
                           [](const Value& v) {
                               return judge_less({1.0, 0.9, 1.1}, v);
                           },
                           [](const Value& v) {
                               return judge_much_less(v, {1.0, 0.9, 1.1});
                           },
                           [](const Value& v) {
                               return judge_alike(v, {1.0, 0.9, 1.1});
                           },
                           [](const Value& v) {
                               return judge_significant(v, {1.0, 0.9, 1.1});
                           },
                           [](const Value& v) { return judge_likeness(v); },
                           [](const Value& v) { return judge_visible(v); },
                           [](const Value& v) { return judge_fit(v); },
                           [](const Value& v) { return judge_unnoticed(v); },
                           [](const Value& v) { return judge_unnoticed(v - exactly(0.01)); },
                           [](const Value& v) { return judge_offset(v); }};
    base::Random random(1);
    std::size_t decided = 0;
    for (int i = 0; i < 3000; ++i) {
        const double low = std::pow(10.0, random.uniform(-4.0, 1.0)),
                     high = low * std::pow(10.0, random.uniform(0.0, 1.0));
        const double narrow_low = random.uniform(low, high), narrow_high = random.uniform(narrow_low, high);
        const double middle = 0.5 * (narrow_low + narrow_high);
        for (std::size_t r = 0; r < std::size(rules); ++r) {
            const Judged wide = rules[r]({middle, low, high});
            if (verdict(wide) == Verdict::undecided) continue;
            ++decided;
            EXPECT_EQ(verdict(rules[r]({middle, narrow_low, narrow_high})), verdict(wide))
                << "rule " << r << ", [" << narrow_low << ", " << narrow_high << "] in [" << low << ", " << high << "]";
        }
    }
    EXPECT_GT(decided, 10000u);
}

}  // namespace
}  // namespace shadowbench::claims
