#include "claims/turns.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "base/random.h"
#include "claims/intervals.h"

namespace shadowbench::claims {
namespace {

// A machine that slows down by a tenth in each round, as both things find it.
TEST(Turns, WhatSlowsARoundIsNotInTheRatios) {
    double pace = 1.0;
    const std::function<double()> things[] = {[&] { return 3.0 * pace; }, [&] { return 2.0 * pace; },
                                              [&] {
                                                  pace *= 1.1;
                                                  return pace;
                                              }};
    // The third thing is the first of every other round, so the pace changes between rounds only there.
    const Compared compared[] = {{0, 1}};
    const Turns turns = take_turns(things, compared, {15, 39, 1e9});
    const Value ratio = turns.ratio(0, 1), slowed = turns.time(0);
    EXPECT_NEAR(ratio.low, 1.5, 1e-9);
    EXPECT_NEAR(ratio.high, 1.5, 1e-9);
    EXPECT_GT(slowed.high, 1.2 * slowed.low);
    EXPECT_EQ(turns.times[0].size(), 15u) << "the ratio is narrow at the first look";
}

TEST(Turns, GoOnUntilEveryRatioIsNarrow) {
    base::Random random(1);
    const std::function<double()> things[] = {[&] { return random.uniform(1.0, 9.0); }, [] { return 1.0; },
                                              [] { return 2.0; }};
    const Compared wide[] = {{1, 2}, {0, 1}}, narrow[] = {{1, 2}};
    EXPECT_EQ(take_turns(things, wide, {15, 39, 1e9}).times[0].size(), 39u);
    EXPECT_EQ(take_turns(things, narrow, {15, 39, 1e9}).times[0].size(), 15u) << "no claim judges the first thing";
    EXPECT_EQ(take_turns(things, {}, {7, 39, 1e9}).times[2].size(), 7u);
}

// is_narrow() of a run takes 0.005 as narrow whatever the value is; a ratio may be as small as that.
TEST(Turns, ASmallRatioIsNotNarrowByItsSize) {
    base::Random random(1);
    const std::function<double()> things[] = {[&] { return random.uniform(0.001, 0.009); }, [] { return 1.0; }};
    const Compared compared[] = {{0, 1}};
    EXPECT_EQ(take_turns(things, compared, {15, 39, 1e9}).times[0].size(), 39u);
}

TEST(Turns, EveryOtherRoundGoesBackwards) {
    std::string order;
    const std::function<double()> things[] = {[&] {
                                                  order += 'a';
                                                  return 1.0;
                                              },
                                              [&] {
                                                  order += 'b';
                                                  return 1.0;
                                              },
                                              [&] {
                                                  order += 'c';
                                                  return 1.0;
                                              }};
    take_turns(things, {}, {3, 3, 1e9});
    EXPECT_EQ(order, "abccbaabc");
}

TEST(Turns, ARatioIsTheMedianOfThoseOfTheRounds) {
    const double one[] = {1, 20, 9, 4, 5}, other[] = {1, 10, 3, 1, 1};  // ratios 1, 2, 3, 4, 5
    const Value ratio = ratio_of(one, other);
    EXPECT_EQ(ratio.value, 3.0);
    EXPECT_EQ(ratio.low, 1.0) << "five values: their whole range";
    EXPECT_EQ(ratio.high, 5.0);
}

// A time that falls after it rose: its ends alone would say that it does not change.
TEST(Turns, ATimeGrowsByTheLargestRatioToAnEarlierOne) {
    const Turns turns{{{2, 2, 2, 2, 2}, {5, 6, 7, 6, 6}, {2, 2, 2, 2, 2}}};
    const std::size_t all[] = {0, 1, 2};
    EXPECT_EQ(turns.ratio(2, 0).value, 1.0);
    EXPECT_EQ(turns.growth(all).value, 3.0);
    EXPECT_EQ(turns.growth(all).low, 2.5) << "five values: their whole range";
    EXPECT_EQ(turns.growth(all).high, 3.5);
}

TEST(Turns, ATimeThatFallsDoesNotGrow) {
    const Turns turns{{{8, 8, 8, 8, 8}, {4, 4, 4, 4, 4}, {6, 6, 6, 6, 6}, {3, 3, 3, 3, 3}}};
    const std::size_t all[] = {0, 1, 2, 3}, falling[] = {0, 1, 3}, backwards[] = {3, 2};
    EXPECT_EQ(turns.growth(all).value, 1.5) << "from the second to the third";
    EXPECT_EQ(turns.growth(falling).value, 0.75);
    EXPECT_EQ(turns.growth(backwards).value, 2.0);
}

}  // namespace
}  // namespace shadowbench::claims
