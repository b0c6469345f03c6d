#include "base/error.h"

#include <gtest/gtest.h>

namespace shadowbench::base {
namespace {

TEST(Error, WhatIsThePlaceAndTheMessage) {
    const Error error(ErrorCode::bad_input, "/lights/0", "no such kind");
    EXPECT_STREQ(error.what(), "/lights/0: no such kind");
    EXPECT_EQ(error.code(), ErrorCode::bad_input);
    EXPECT_EQ(error.where(), "/lights/0");
    EXPECT_EQ(error.message(), "no such kind");
}

TEST(Error, WithoutAPlaceIsOnlyTheMessage) {
    EXPECT_STREQ(Error(ErrorCode::usage, "", "no command").what(), "no command");
}

// A message that quotes a file must not forge a second line of a log.
TEST(Error, WhatIsOneLine) {
    EXPECT_STREQ(Error(ErrorCode::io, "a\rb", "c\nd").what(), "a b: c d");
}

// A message that quotes a file must not move a terminal's cursor, nor make the JSON that holds it unwritable.
TEST(Error, IsPrintableUtf8) {
    const Error error(ErrorCode::bad_input, "h\u00e4r.ply:3", "\"\x1b[2J\xc2\x9b\x7f\xff\xe4\" is not a number");
    EXPECT_EQ(error.where(), "h\u00e4r.ply:3");
    EXPECT_EQ(error.message(), "\" [2J????\" is not a number");
}

TEST(Error, CodesAreTheExitCodesOfTheProcess) {
    EXPECT_EQ(static_cast<int>(ErrorCode::usage), 64);
    EXPECT_EQ(static_cast<int>(ErrorCode::bad_input), 65);
    EXPECT_EQ(static_cast<int>(ErrorCode::no_such_file), 66);
    EXPECT_EQ(static_cast<int>(ErrorCode::internal), 70);
    EXPECT_EQ(static_cast<int>(ErrorCode::io), 74);
}

}  // namespace
}  // namespace shadowbench::base
