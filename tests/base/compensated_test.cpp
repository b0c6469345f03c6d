#include "base/compensated.h"

#include <gtest/gtest.h>

#include "base/random.h"

namespace shadowbench::base {
namespace {

// In a plain sum the small terms are gone as soon as the large one is there.
TEST(CompensatedSum, WhatIsAddedAndTakenAwayLeavesNothing) {
    CompensatedSum sum(1.0);
    sum.add(1e20);
    sum.add(3.0);
    sum.add(-1e20);
    EXPECT_EQ(sum.value(), 4.0);
}

TEST(CompensatedSum, AMillionTermsKeepTheirLastDigits) {
    CompensatedSum sum;
    for (int i = 0; i < 1'000'000; ++i) sum.add(0.1);
    EXPECT_DOUBLE_EQ(sum.value(), 100000.0);
}

TEST(CompensatedSum, RandomTermsTakenAwayInAnotherOrderLeaveNextToNothing) {
    CompensatedSum sum;
    for (int round = 0; round < 2; ++round) {
        Random random(5);
        for (int i = 0; i < 100'000; ++i) {
            const double term = random.uniform(-1e6, 1e6);
            sum.add(round == 0 ? term : -term);
        }
    }
    EXPECT_NEAR(sum.value(), 0.0, 1e-12);
}

TEST(CompensatedSum, StartsAtWhatItIsGiven) {
    EXPECT_EQ(CompensatedSum().value(), 0.0);
    EXPECT_EQ(CompensatedSum(2.5).value(), 2.5);
}

}  // namespace
}  // namespace shadowbench::base
