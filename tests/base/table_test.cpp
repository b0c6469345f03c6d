#include "base/table.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

namespace shadowbench::base {
namespace {

TEST(Table, aligns_its_columns) {
    Table table({"name", "n", "note"});
    table.add({"a", "10", "x"});
    table.add({"longer", "7", ""});
    EXPECT_EQ(table.text(" "), " name     n  note\n a       10  x\n longer   7\n");
}

TEST(Table, gives_colours_no_space) {
    Table table({"name", "n", "end"});
    table.add({"a", coloured("10", Colour::red), coloured("x", Colour::green)});
    table.add({"b", "7", ""});
    EXPECT_EQ(table.text(""), "name   n  end\na     \x1b[31m10\x1b[0m  \x1b[32mx\x1b[0m\nb      7\n");
    EXPECT_EQ(coloured("x", Colour::none), "x");
    EXPECT_EQ(coloured("", Colour::bold), "");
}

TEST(Wrapped, breaks_lines_at_spaces_and_indents_what_goes_on) {
    EXPECT_EQ(wrapped("a short line\n", 20), "a short line\n");
    EXPECT_EQ(wrapped("  twenty letters and more of them\nnext", 20), "  twenty letters and\n    more of them\nnext\n");
    EXPECT_EQ(wrapped("exactly twenty chars", 20), "exactly twenty chars\n");
    EXPECT_EQ(wrapped(" " + std::string(45, 'x') + " y", 20),
              " " + std::string(19, 'x') + "\n   " + std::string(17, 'x') + "\n   " + std::string(9, 'x') + " y\n")
        << "a word longer than a line";
    EXPECT_EQ(wrapped(std::string(19, 'x') + "\u00e9\u00e9", 20), std::string(19, 'x') + "\n  \u00e9\u00e9\n")
        << "no character is broken";
    EXPECT_EQ(wrapped(std::string(15, ' ') + "word another\n", 20),
              std::string(15, ' ') + "word\n" + std::string(10, ' ') + "another\n")
        << "a deep indentation leaves half of the line";
    EXPECT_EQ(wrapped("", 20), "");
    EXPECT_EQ(wrapped("0123456789 0123456789", 0), wrapped("0123456789 0123456789", 20));
}

TEST(NumberText, gives_different_numbers_different_texts) {
    EXPECT_EQ(number_text(0.02), "0.02");
    EXPECT_EQ(number_text(1e-5), "1e-05");
    EXPECT_EQ(number_text(8.0), "8");
    EXPECT_EQ(number_text(0.0200001), "0.0200001");
    EXPECT_EQ(number_text(1048577.0), "1048577");
}

// tests/web/browser/pure.mjs holds the page and the report to the same texts: they would say 0.13 where a table says
// 0.12.
TEST(Texts, of_a_number_are_those_of_the_page) {
    std::ifstream file(std::string(SHADOWBENCH_SOURCE_DIR) + "/tests/base/number_texts.txt");
    int compared = 0;
    for (std::string kind, value, text; file >> kind >> value && std::getline(file >> std::ws, text); ++compared)
        EXPECT_EQ(kind == "error" ? error_text(std::stod(value)) : bytes_text(std::stoull(value)), text) << value;
    EXPECT_GT(compared, 20);
}

}  // namespace
}  // namespace shadowbench::base
