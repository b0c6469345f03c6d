#include "bench/disturbance.h"

#include <gtest/gtest.h>

namespace shadowbench::bench {
namespace {

TEST(Disturbance, ReadsTheStealOfAllProcessors) {
    EXPECT_EQ(read_steal("cpu  3852140 1509904 452927 365907 12540 0 5929 66193 0 0"), 66193u);
    EXPECT_EQ(read_steal("cpu 1 2 3 4 5 6 7 8"), 8u);
    EXPECT_FALSE(read_steal("cpu 1 2 3 4 5 6 7")) << "as before Linux 2.6.11";
    EXPECT_FALSE(read_steal("cpu0 1 2 3 4 5 6 7 8")) << "one processor of several";
    EXPECT_FALSE(read_steal("cpu 1 2 3 4 5 6 7 x"));
    EXPECT_FALSE(read_steal("cpu "));
    EXPECT_FALSE(read_steal(""));
}

TEST(Disturbance, CountsPassesAndTheirInterruptions) {
    results::TimedPasses passes;
    count_pass(0, passes);
    count_pass(3, passes);
    count_pass(1, passes);
    EXPECT_EQ(passes.passes, 3u);
    EXPECT_EQ(passes.interrupted, 2u);
    EXPECT_EQ(passes.switches, 4u);
}

}  // namespace
}  // namespace shadowbench::bench
