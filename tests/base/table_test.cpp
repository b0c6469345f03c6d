#include "base/table.h"

#include <gtest/gtest.h>

namespace shadowbench::base {
namespace {

TEST(Table, aligns_its_columns) {
    Table table({"name", "n", "note"});
    table.add({"a", "10", "x"});
    table.add({"longer", "7", ""});
    EXPECT_EQ(table.text(" "), " name     n  note\n a       10  x\n longer   7\n");
}

TEST(NumberText, gives_different_numbers_different_texts) {
    EXPECT_EQ(number_text(0.02), "0.02");
    EXPECT_EQ(number_text(1e-5), "1e-05");
    EXPECT_EQ(number_text(8.0), "8");
    EXPECT_EQ(number_text(0.0200001), "0.0200001");
    EXPECT_EQ(number_text(1048577.0), "1048577");
}

TEST(BytesText, counts_in_powers_of_1024) {
    EXPECT_EQ(bytes_text(1023), "1023 B");
    EXPECT_EQ(bytes_text(1536), "1.5 KiB");
    EXPECT_EQ(bytes_text(1020 * 1024), "1020 KiB");
    EXPECT_EQ(bytes_text(std::size_t{3} << 30), "3 GiB");
}

}  // namespace
}  // namespace shadowbench::base
