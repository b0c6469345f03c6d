#include "claims/value.h"

#include <gtest/gtest.h>

namespace shadowbench::claims {
namespace {

TEST(Value, RatiosTakeTheWidestIntervalTheirPartsAllow) {
    const Value ratio = Value{10, 8, 12} / Value{2, 1, 4};
    EXPECT_DOUBLE_EQ(ratio.value, 5.0);
    EXPECT_DOUBLE_EQ(ratio.low, 2.0);
    EXPECT_DOUBLE_EQ(ratio.high, 12.0);
    const Value difference = Value{10, 8, 12} - Value{2, 1, 4};
    EXPECT_DOUBLE_EQ(difference.low, 4.0);
    EXPECT_DOUBLE_EQ(difference.high, 11.0);
}

TEST(Value, AnAbsoluteValueMayReachZero) {
    EXPECT_DOUBLE_EQ(absolute({-1, -3, 2}).low, 0.0);
    EXPECT_DOUBLE_EQ(absolute({-1, -3, 2}).high, 3.0);
    EXPECT_DOUBLE_EQ(absolute({-2, -3, -1}).low, 1.0);
    EXPECT_DOUBLE_EQ(absolute({-2, -3, -1}).high, 3.0);
}

TEST(Value, ValuesThatDoNotVaryHaveNoInterval) {
    EXPECT_EQ(to_text(exactly(1.5)), "1.5");
    EXPECT_EQ(to_text({14.2, 13.9, 14.6}), "14.2 [13.9, 14.6]");
}

TEST(Value, AnErrorHasTheIntervalOverSeeds) {
    results::Cell cell;
    cell.lookup.emplace().norms.rms = 0.03;
    EXPECT_EQ(error_of(cell).low, 0.03);
    cell.lookup->interval = results::RmsInterval{0.028, 0.031, true};
    EXPECT_EQ(error_of(cell).value, 0.03);
    EXPECT_EQ(error_of(cell).low, 0.028);
    EXPECT_EQ(error_of(cell).high, 0.031);
}

}  // namespace
}  // namespace shadowbench::claims
