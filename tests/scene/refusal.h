// What a reader says of a damaged file.
#pragma once

#include <gmock/gmock.h>

#include <string>

#include "base/error.h"
#include "scene/support.h"

namespace shadowbench::scene::test {

// The message of the bad_input that this throws, whose place is a byte of the file of this name.
template <class Action>
std::string message_at_byte(const std::string& file, const Action& action) {
    const base::Error error = error_of(action);
    EXPECT_EQ(error.code(), base::ErrorCode::bad_input);
    EXPECT_THAT(error.where(), ::testing::HasSubstr(file + ": byte "));
    return error.message();
}

}  // namespace shadowbench::scene::test
