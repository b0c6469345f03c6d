#include "base/hash_text.h"

#include <gtest/gtest.h>

namespace shadowbench::base {
namespace {

TEST(HashText, is_fnv1a) {
    EXPECT_EQ(hash_text(""), "cbf29ce484222325");
    EXPECT_EQ(hash_text("a"), "af63dc4c8601ec8c");
}

}  // namespace
}  // namespace shadowbench::base
