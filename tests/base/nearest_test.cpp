#include "base/nearest.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace shadowbench::base {
namespace {

const std::vector<std::string> names{"run", "render", "recommend", "deep", "avsm", "rays"};

TEST(Nearest, finds_the_word_that_was_meant) {
    EXPECT_EQ(nearest("rum", names), "run") << "another letter";
    EXPECT_EQ(nearest("deeep", names), "deep") << "one too many";
    EXPECT_EQ(nearest("rcommend", names), "recommend") << "one too few";
    EXPECT_EQ(nearest("rnu", names), "run") << "two swapped count as one slip";
    EXPECT_EQ(nearest("avms", names), "avsm");
    EXPECT_EQ(nearest("recomandd", names), "recommend") << "a third of the letters";
}

TEST(Nearest, takes_no_other_word_for_a_slip) {
    EXPECT_EQ(nearest("foo", names), "");
    EXPECT_EQ(nearest("ruby", names), "") << "two letters of four";
    EXPECT_EQ(nearest("", names), "");
    EXPECT_EQ(nearest(std::string(10000, 'r'), names), "") << "nor for a text that takes long to compare";
    EXPECT_EQ(nearest("run", {}), "");
}

TEST(Nearest, ends_a_message) {
    EXPECT_EQ(perhaps("rnder", names), ", perhaps \"render\"");
    EXPECT_EQ(perhaps("foo", names), "");
}

}  // namespace
}  // namespace shadowbench::base
