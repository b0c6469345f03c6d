#include "claims/sixteen_bits.h"

#include <gtest/gtest.h>

namespace shadowbench::claims {
namespace {

TEST(SixteenBits, KeepTheEndsAndErrByHalfAStep) {
    constexpr float low = 80.0f, high = 130.0f;
    EXPECT_EQ(in_sixteen_bits(low, low, high), low);
    EXPECT_EQ(in_sixteen_bits(high, low, high), high);
    EXPECT_EQ(in_sixteen_bits(high + 1.0f, low, high), high);
    const double half = 0.5 * (high - low) / 65535.0;
    double largest = 0.0;
    for (float z = low; z < high; z += 0.0137f)
        largest = std::max(largest, std::abs(static_cast<double>(in_sixteen_bits(z, low, high)) - z));
    EXPECT_LE(largest, half + 1e-5) << "and the rounding of floats";
    EXPECT_GT(largest, 0.9 * half);
}

}  // namespace
}  // namespace shadowbench::claims
