#include "service/cli/quantity.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"

namespace shadowbench::service {
namespace {

TEST(Quantity, HasAUnit) {
    EXPECT_EQ(read_quantity("4MiB", byte_units, ""), 4.0 * 1024 * 1024);
    EXPECT_EQ(read_quantity("1.5 KiB", byte_units, ""), 1536.0);
    EXPECT_EQ(read_quantity("50ns", nanosecond_units, ""), 50.0);
    EXPECT_EQ(read_quantity("2us", nanosecond_units, ""), 2000.0);
    EXPECT_EQ(read_quantity("1s", millisecond_units, ""), 1000.0);
    EXPECT_EQ(read_quantity("5min", second_units, ""), 300.0);
}

TEST(Quantity, RefusesOtherTexts) {
    for (const char* text :
         {"", "4", "MiB", "4 mib", "-4MiB", "0MiB", "nanMiB", "infMiB", "4MiB ", "4  MiB", "1e308GiB"})
        EXPECT_THROW(read_quantity(text, byte_units, "--at-most"), base::Error) << text;
    try {
        read_quantity("4MB", byte_units, "--at-most bytes");
    } catch (const base::Error& error) {
        EXPECT_EQ(error.code(), base::ErrorCode::usage);
        EXPECT_EQ(error.where(), "--at-most bytes");
        EXPECT_THAT(error.message(), ::testing::HasSubstr("B, KiB, MiB, GiB"));
    }
}

}  // namespace
}  // namespace shadowbench::service
