#include "base/markdown.h"

#include <gtest/gtest.h>

namespace shadowbench::base {
namespace {

TEST(MarkdownTable, keeps_bars_inside_of_their_field) {
    EXPECT_EQ(markdown_table({"a", "|b|"}, {{"1", "x|y||"}, {"", "2"}}),
              "| a | \\|b\\| |\n| --- | --- |\n| 1 | x\\|y\\|\\| |\n|  | 2 |\n\n");
}

TEST(MarkdownEscaped, keeps_names_from_becoming_markup) {
    EXPECT_EQ(markdown_escaped("a_b|c\n[d]"), "a\\_b\\|c \\[d\\]");
}

}  // namespace
}  // namespace shadowbench::base
