#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "scene/scenario.h"
#include "scene/support.h"

namespace shadowbench::scene {
namespace {

using test::error_of;
using testing::HasSubstr;

base::Error parse_error(const std::string& text) {
    return error_of([&] { parse_json(text, "file.json"); });
}

TEST(ParseJson, ReadsWhatIsValid) {
    const nlohmann::json document = parse_json(R"({"a": [1, 2.5, true, null, "x\"y"], "b": {"a": {}}})", "origin");
    EXPECT_EQ(document["a"][1], 2.5);
    EXPECT_EQ(document["a"][4], "x\"y");
    EXPECT_TRUE(document["b"]["a"].empty());
}

TEST(ParseJson, TellsLineColumnAndExcerptOfASyntaxError) {
    const base::Error error = parse_error("{\n  \"rays\": {\n    \"seed\": ,\n  }\n}");
    EXPECT_EQ(error.code(), base::ErrorCode::bad_input);
    EXPECT_EQ(error.where(), "file.json:3:13");
    EXPECT_THAT(error.message(), HasSubstr("\"seed\": ,"));
    EXPECT_THAT(error.message(), Not(HasSubstr("json.exception")));
}

TEST(ParseJson, RefusesDuplicateKeysOfOneObjectOnly) {
    const base::Error error = parse_error("{\"a\": {\"b\": 1,\n \"b\": 2}}");
    EXPECT_EQ(error.where(), "file.json:2:2");
    EXPECT_THAT(error.message(), HasSubstr("\"b\" occurs twice"));
    EXPECT_NO_THROW(parse_json(R"({"a": {"b": 1}, "b": {"a": 1}, "c": [{"b": 1}, {"b": 2}]})", "origin"));
}

// Requests hold such text as well as files do.
TEST(ParseJson, TakesAByteOrderMarkOfUtf8Alone) {
    const std::string mark = "\xef\xbb\xbf";
    EXPECT_EQ(parse_json(mark + "{\"a\": 1}", "origin")["a"], 1);
    EXPECT_EQ(parse_error(mark + "{\"a\": 1, \"a\": 2}").where(), "file.json:1:10");
    for (const std::string& text : {std::string("\xff\xfe{\0}\0", 6), std::string("\xfe\xff\0{\0}", 6)})
        EXPECT_THAT(parse_error(text).message(), HasSubstr("UTF-8"));
}

TEST(ParseJson, FindsADuplicateKeyWithAnEscapedQuote) {
    EXPECT_EQ(parse_error(R"({"x\"":1,"x\"":2})").where(), "file.json:1:10");
}

TEST(ParseJson, RefusesNumbersThatAreNone) {
    for (const char* text : {"{\"a\": NaN}", "{\"a\": Infinity}", "{\"a\": 1e999}", "{\"a\": -1e999}", "{\"a\": 01}"})
        EXPECT_THAT(parse_error(text).where(), HasSubstr("file.json:1:")) << text;
}

TEST(ParseJson, RefusesWhatIsCutShortAtAnyByte) {
    const std::string text = R"({"a": [1, 2.5, true, null, "xy"], "b": {"a": {}}})";
    for (std::size_t length = 0; length < text.size(); ++length)
        EXPECT_EQ(parse_error(text.substr(0, length)).code(), base::ErrorCode::bad_input) << length;
}

TEST(ParseJson, RefusesDepthThatWouldOverflowTheStack) {
    EXPECT_THAT(parse_error(std::string(1000000, '[')).message(), HasSubstr("64 levels"));
    EXPECT_NO_THROW(parse_json(std::string(64, '[') + std::string(64, ']'), "origin"));
}

TEST(ParseJson, RefusesInvalidUtf8AndTrailingText) {
    EXPECT_EQ(parse_error("\"\xff\"").code(), base::ErrorCode::bad_input);
    EXPECT_EQ(parse_error("{} {}").where(), "file.json:1:4");
}

TEST(ParseJson, ExcerptOfALongLineIsShort) {
    EXPECT_LT(parse_error("[" + std::string(100000, ' ') + "x" + std::string(100000, ' ') + "]").message().size(),
              250u);
}

TEST(ParseJson, RefusesNumbersThatNoDoubleHoldsAndWordsForThem) {
    for (const char* number : {"1e999", "-1e999", "NaN", "nan", "Infinity", "-inf", "0x10", "01", "1.", ".5", "+1"}) {
        const base::Error error =
            test::error_of([&] { parse_json(std::string("{\n  \"a\": [") + number + "]\n}", "a.json"); });
        EXPECT_EQ(error.code(), base::ErrorCode::bad_input) << number;
        EXPECT_TRUE(error.where().starts_with("a.json:2:")) << error.what();
    }
    EXPECT_EQ(parse_json("[1e-999, 5e-324]", "").at(1).get<double>(), 5e-324);
}

}  // namespace
}  // namespace shadowbench::scene
