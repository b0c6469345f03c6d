#include "base/json_pointer.h"

#include <gtest/gtest.h>

namespace shadowbench::base {
namespace {

// The pointers of RFC 6901, section 5, that one key of the whole document has.
TEST(JsonPointer, EscapesAKeyAsTheRfcDoes) {
    EXPECT_EQ(append_token("", "foo"), "/foo");
    EXPECT_EQ(append_token("", ""), "/");
    EXPECT_EQ(append_token("", "a/b"), "/a~1b");
    EXPECT_EQ(append_token("", "m~n"), "/m~0n");
    EXPECT_EQ(append_token("", "c%d"), "/c%d");
    EXPECT_EQ(append_token("", " "), "/ ");
}

TEST(JsonPointer, EscapesOnlyTheNewKey) {
    EXPECT_EQ(append_token("/techniques/0", "~1"), "/techniques/0/~01") << "\"~\" first, so that \"/\" is not meant";
    EXPECT_EQ(append_token(append_token("", "a/b"), "c/d"), "/a~1b/c~1d");
}

}  // namespace
}  // namespace shadowbench::base
