#include "base/utf8.h"

#include <gtest/gtest.h>

#include "base/error.h"

namespace shadowbench::base {
namespace {

TEST(Utf8, KnowsTheFirstAndLastCharacterOfEveryLength) {
    for (const std::string_view text :
         {"", "a", "\x7f", "\xc2\x80", "\xdf\xbf", "\xe0\xa0\x80", "\xed\x9f\xbf", "\xee\x80\x80", "\xef\xbf\xbf",
          "\xf0\x90\x80\x80", "\xf4\x8f\xbf\xbf", "a\xc3\xa4\xe2\x82\xac\xf0\x9f\x98\x80z"})
        EXPECT_TRUE(is_utf8(text)) << testing::PrintToString(text);
}

TEST(Utf8, RefusesWhatIsNoCharacter) {
    for (const std::string_view text :
         {"\x80", "\xbf", "\xc0\x80", "\xc1\xbf", "\xc2", "\xc2z", "\xe0\x9f\xbf", "\xed\xa0\x80", "\xe2\x82",
          "\xf0\x8f\xbf\xbf", "\xf4\x90\x80\x80", "\xf5\x80\x80\x80", "\xf0\x9f\x98", "\xff", "ok\xfe"})
        EXPECT_FALSE(is_utf8(text)) << testing::PrintToString(text);
}

TEST(Utf8, TakesOneMarkOffTheFrontAlone) {
    const std::string mark = "\xef\xbb\xbf";
    EXPECT_EQ(without_mark(mark + "v" + mark, ""), "v" + mark);
    EXPECT_EQ(without_mark("v" + mark, ""), "v" + mark);
    EXPECT_EQ(without_mark(mark, ""), "");
    EXPECT_EQ(without_mark("\xef\xbb", ""), "\xef\xbb");
}

TEST(Utf8, RefusesMarksOfWiderCharacters) {
    for (const std::string& text : {std::string("\xff\xfe"), std::string("\xfe\xff\0v", 4),
                                    std::string("\xff\xfe\0\0", 4), std::string("\0\0\xfe\xff", 4)})
        EXPECT_THROW(without_mark(text, "place"), Error) << testing::PrintToString(text);
}

}  // namespace
}  // namespace shadowbench::base
