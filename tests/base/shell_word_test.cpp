#include "base/shell_word.h"

#include <gtest/gtest.h>

namespace shadowbench::base {
namespace {

TEST(ShellWord, QuotesOnlyWhatAShellWouldTakeApart) {
    EXPECT_EQ(shell_word("rays.seed=2"), "rays.seed=2");
    EXPECT_EQ(shell_word(""), "''");
    EXPECT_EQ(shell_word("two words"), "'two words'");
    EXPECT_EQ(shell_word("receivers={\"share\":1}"), "'receivers={\"share\":1}'");
    EXPECT_EQ(shell_word("it's"), "'it'\\''s'");
}

}  // namespace
}  // namespace shadowbench::base
