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

TEST(BytesText, counts_in_powers_of_1024) {
    EXPECT_EQ(bytes_text(1023), "1023 B");
    EXPECT_EQ(bytes_text(1536), "1.5 KiB");
    EXPECT_EQ(bytes_text(1020 * 1024), "1020 KiB");
    EXPECT_EQ(bytes_text(std::size_t{3} << 30), "3 GiB");
}

}  // namespace
}  // namespace shadowbench::base
