#include "base/markdown.h"

#include <gtest/gtest.h>

namespace shadowbench::base {
namespace {

TEST(MarkdownTable, keeps_bars_inside_of_their_field) {
    EXPECT_EQ(markdown_table({"a", "|b|"}, {{"1", "x|y||"}, {"", "2"}}),
              "| a | \\|b\\| |\n| --- | --- |\n| 1 | x\\|y\\|\\| |\n|  | 2 |\n\n");
}

}  // namespace
}  // namespace shadowbench::base
