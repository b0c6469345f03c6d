#include "claims/claim.h"

#include <gtest/gtest.h>

#include <limits>

namespace shadowbench::claims {
namespace {

TEST(Claim, RatiosTakeTheWidestIntervalTheirPartsAllow) {
    const Value ratio = Value{10, 8, 12} / Value{2, 1, 4};
    EXPECT_DOUBLE_EQ(ratio.value, 5.0);
    EXPECT_DOUBLE_EQ(ratio.low, 2.0);
    EXPECT_DOUBLE_EQ(ratio.high, 12.0);
    const Value difference = Value{10, 8, 12} - Value{2, 1, 4};
    EXPECT_DOUBLE_EQ(difference.low, 4.0);
    EXPECT_DOUBLE_EQ(difference.high, 11.0);
}

TEST(Claim, ARatioOnTheOtherSideOfOneDoesNotHold) {
    for (const auto judge : {judge_ratio, judge_gain}) {
        EXPECT_EQ(judge(15.0, exactly(14.0), 1.5), Verdict::holds);
        EXPECT_EQ(judge(15.0, exactly(3.0), 1.5), Verdict::in_shape);
        EXPECT_EQ(judge(15.0, exactly(0.9), 1.5), Verdict::fails);
        EXPECT_EQ(judge(0.25, exactly(0.8), 1.5), Verdict::in_shape);
        EXPECT_EQ(judge(0.25, exactly(1.5), 1.5), Verdict::fails);
        EXPECT_EQ(judge(1.1, exactly(0.95), 1.5), Verdict::holds)
            << "near the paper's ratio, though on the other side of 1";
        EXPECT_EQ(judge(2.0, exactly(std::numeric_limits<double>::quiet_NaN()), 1.5), Verdict::fails);
    }
}

TEST(Claim, OnlyAGainMayBeLargerThanClaimed) {
    EXPECT_EQ(judge_gain(15.0, exactly(60.0)), Verdict::holds);
    EXPECT_EQ(judge_ratio(15.0, exactly(60.0)), Verdict::in_shape);
    EXPECT_EQ(judge_gain(0.25, exactly(0.01)), Verdict::holds);
    EXPECT_EQ(judge_ratio(0.25, exactly(0.01)), Verdict::in_shape);
}

TEST(Claim, TheWorstEndOfAnIntervalDecides) {
    EXPECT_EQ(judge_ratio(2.0, {2.0, 1.1, 2.5}), Verdict::in_shape);
    EXPECT_EQ(judge_ratio(2.0, {2.0, 0.9, 2.5}), Verdict::fails);
    EXPECT_EQ(judge_value(1.0, {1.0, 0.9, 1.3}, 0.1, 0.5), Verdict::in_shape);
    EXPECT_EQ(judge_at_most({1.0, 0.9, 1.3}, 1.2, 2.0), Verdict::in_shape);
    EXPECT_EQ(judge_at_most({1.0, 0.9, 1.1}, 1.2, 2.0), Verdict::holds);
}

TEST(Claim, AValueIsJudgedByItsDistance) {
    EXPECT_EQ(judge_value(0.25, exactly(0.29), 0.05, 0.2), Verdict::holds);
    EXPECT_EQ(judge_value(0.25, exactly(0.4), 0.05, 0.2), Verdict::in_shape);
    EXPECT_EQ(judge_value(0.25, exactly(0.5), 0.05, 0.2), Verdict::fails);
}

TEST(Claim, ValuesThatDoNotVaryHaveNoInterval) {
    EXPECT_EQ(to_text(exactly(1.5)), "1.5");
    EXPECT_EQ(to_text({14.2, 13.9, 14.6}), "14.2 [13.9, 14.6]");
}

}  // namespace
}  // namespace shadowbench::claims
