#include <gtest/gtest.h>

#include "curves/compress_parts.h"

namespace shadowbench::curves::compression {
namespace {

// GCC 12 compiles this to an empty function if to_float is a plain conversion.
[[gnu::noinline]] void round_neighbours(double* values) {
    const float first = to_float<3>(values[0]), second = to_float<3>(values[1]);
    values[0] = first;
    values[1] = second;
}

TEST(ToFloat, neighbouring_channels_are_rounded) {
    volatile double first = 0.1, second = 0.3;  // not known to the compiler
    double values[2] = {first, second};
    round_neighbours(values);
    EXPECT_EQ(values[0], static_cast<double>(0.1f));
    EXPECT_EQ(values[1], static_cast<double>(0.3f));
}

TEST(ToFloat, one_channel_is_rounded) {
    double value = 0.1;
    value = to_float<1>(value);
    EXPECT_EQ(value, static_cast<double>(0.1f));
}

}  // namespace
}  // namespace shadowbench::curves::compression
