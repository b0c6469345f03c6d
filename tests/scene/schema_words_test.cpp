#include "scene/schema_words.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace shadowbench::scene {
namespace {

using nlohmann::json;

TEST(Describe, PutsSchemasInWords) {
    EXPECT_EQ(describe(json::parse(R"({"type": "number", "exclusiveMinimum": 0, "maximum": 1})")), "number in (0, 1]");
    EXPECT_EQ(describe(json::parse(R"({"type": "integer", "minimum": 2})")), "integer of at least 2");
    EXPECT_EQ(describe(json::parse(R"({"enum": ["a", "b"]})")), "one of: a, b");
    EXPECT_EQ(describe(json::parse(R"({"const": 3})")), "3");
    EXPECT_EQ(describe(json::object()), "another value");
}

TEST(HasType, KnowsThatIntegersAreNumbers) {
    EXPECT_TRUE(has_type(3, "number"));
    EXPECT_TRUE(has_type(3, "integer"));
    EXPECT_FALSE(has_type(3.5, "integer"));
    EXPECT_TRUE(has_type("x", json{"number", "string"}));
    EXPECT_FALSE(has_type(nullptr, json{"number", "string"}));
}

}  // namespace
}  // namespace shadowbench::scene
