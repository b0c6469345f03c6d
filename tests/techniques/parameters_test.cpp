#include "techniques/parameters.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "techniques/technique.h"

namespace shadowbench::techniques {
namespace {

using nlohmann::json;

base::Error error_of(const char* id, const json& parameters) {
    try {
        read_parameters(find(id, "").parameters, parameters, "/techniques/2");
    } catch (const base::Error& e) {
        return e;
    }
    ADD_FAILURE() << "accepted: " << parameters;
    return {base::ErrorCode::internal, "", ""};
}

TEST(Parameters, MissingOnesHaveTheirDefaults) {
    const ParameterValues values = read_parameters(find("avsm", "").parameters, json::object(), "");
    EXPECT_EQ(values.integer("nodes"), 8);
    EXPECT_EQ(values.word("filter"), "footprint");
}

TEST(Parameters, AnUnknownNameIsAnErrorThatListsThoseThereAre) {
    const base::Error e = error_of("deep", {{"tolerence", 0.1}});
    EXPECT_EQ(e.code(), base::ErrorCode::bad_input);
    EXPECT_EQ(e.where(), "/techniques/2/tolerence");
    EXPECT_THAT(e.message(), ::testing::HasSubstr("tolerance, compression, filter"));
}

TEST(Parameters, ValuesOutOfRangeOrOfTheWrongKindSayWhatIsExpected) {
    EXPECT_THAT(error_of("avsm", {{"nodes", 1}}).message(), ::testing::HasSubstr("from 2 to 64"));
    EXPECT_THAT(error_of("avsm", {{"nodes", 65}}).message(), ::testing::HasSubstr("from 2 to 64"));
    EXPECT_THAT(error_of("avsm", {{"nodes", 4.5}}).message(), ::testing::HasSubstr("whole number"));
    EXPECT_THAT(error_of("avsm", {{"nodes", "many"}}).message(), ::testing::HasSubstr("\"many\""));
    EXPECT_THAT(error_of("avsm", {{"filter", "cubic"}}).message(), ::testing::HasSubstr("\"bilinear\""));
    EXPECT_THAT(error_of("deep", {{"tolerance", "loud"}}).message(), ::testing::HasSubstr("\"noise\""));
    EXPECT_THAT(error_of("deep", {{"tolerance", -0.1}}).message(), ::testing::HasSubstr("from 0 to 1"));
    EXPECT_THAT(error_of("deep", {{"tolerance", nullptr}}).message(), ::testing::HasSubstr("null"));
}

TEST(Parameters, WhatIsWrittenReadsBackTheSame) {
    for (const Technique& row : all()) {
        const ParameterValues values = read_parameters(row.parameters, json::object(), "");
        EXPECT_EQ(read_parameters(row.parameters, to_json(values), "").values, values.values) << row.id;
    }
}

TEST(Parameters, OnlyWhatDiffersFromTheDefaultsIsShown) {
    const auto& parameters = find("deep", "").parameters;
    const ParameterValues values = read_parameters(parameters, {{"tolerance", 0.02}}, "");
    EXPECT_EQ(to_string(values, parameters, false), "tolerance=0.02");
    EXPECT_EQ(to_string(values, parameters, true),
              "tolerance=0.02 compression=bounded filter=box radius=0.5 mip=none mip_from=compressed kernel=box probes=0 "
              "search=binary storage=memory slots=64");
}

TEST(Parameters, EveryRowHasASchemaWithItsDefaults) {
    for (const Technique& row : all()) {
        const json schema = parameter_schema(row.id, row.parameters);
        EXPECT_EQ(schema["properties"]["type"]["const"], row.id);
        EXPECT_EQ(schema["properties"].size(), row.parameters.size() + 1);
        EXPECT_EQ(schema["additionalProperties"], false);
        for (const Parameter& p : row.parameters) {
            EXPECT_TRUE(schema["properties"][p.name].contains("default")) << row.id << " " << p.name;
            EXPECT_TRUE(schema["properties"][p.name].contains("description")) << row.id << " " << p.name;
        }
    }
}

TEST(Registry, AnUnknownTechniqueIsAnErrorThatListsThoseThereAre) {
    try {
        find("depp", "/techniques/0/type");
        FAIL();
    } catch (const base::Error& e) {
        EXPECT_EQ(e.where(), "/techniques/0/type");
        EXPECT_THAT(e.message(), ::testing::HasSubstr("shadow_map, pcf, deep"));
    }
}

// A technique that asks for an undeclared name has a fault; it must not read past the end of the values.
TEST(Parameters, AnUndeclaredNameIsAnErrorThatListsTheDeclaredOnes) {
    const Parameter declared[] = {{"size", ParameterKind::integer, "", 3, 1, 9},
                                  {"way", ParameterKind::choice, "", 0, 0, 0, "up", {"up", "down"}}};
    const ParameterValues values = read_parameters(declared, json::object(), "");
    const auto message = [](const auto& ask) {
        try {
            ask();
        } catch (const base::Error& error) {
            EXPECT_EQ(error.code(), base::ErrorCode::internal) << error.what();
            return std::string(error.what());
        }
        ADD_FAILURE() << "no error";
        return std::string();
    };
    const std::string expected = "sise: no such parameter; there are: size, way";
    EXPECT_EQ(message([&] { values.number("sise"); }), expected);
    EXPECT_EQ(message([&] { values.integer("sise"); }), expected);
    EXPECT_EQ(message([&] { values.word("sise"); }), expected);
    EXPECT_EQ(message([&] { values.is_word("sise"); }), expected);
    EXPECT_EQ(message([&] { values.at("sise"); }), expected);
    EXPECT_EQ(message([&] { ParameterValues().number("size"); }), "size: no such parameter: there are none");
    const Parameter others[] = {{"depth", ParameterKind::number, "", 1, 0, 2}};
    EXPECT_EQ(message([&] { to_string(values, others, true); }), "depth: no such parameter; there are: size, way");
    EXPECT_EQ(message([&] { values.number("way"); }), "way: not a number but the word \"up\"");
    EXPECT_EQ(message([&] { values.word("size"); }), "size: not a word but 3");
    EXPECT_EQ(values.integer("size"), 3);
    EXPECT_EQ(values.word("way"), "up");
}

}  // namespace
}  // namespace shadowbench::techniques
