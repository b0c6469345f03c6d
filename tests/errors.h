// Expects errors in tests.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "base/error.h"

namespace shadowbench::test {

// Runs `action`, which has to throw Error with this code and place; returns its message.
template <class Action>
std::string error_of(const Action& action, base::ErrorCode code, const std::string& where) {
    try {
        action();
    } catch (const base::Error& error) {
        EXPECT_EQ(error.code(), code) << error.what();
        EXPECT_EQ(error.where(), where) << error.what();
        return error.message();
    }
    ADD_FAILURE() << "no error at " << where;
    return {};
}

}  // namespace shadowbench::test
