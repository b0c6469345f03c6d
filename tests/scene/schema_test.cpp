#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "scene/scenario.h"
#include "scene/support.h"

namespace shadowbench::scene {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

json minimal() {
    return json::parse(R"({
        "name": "minimal",
        "scene": {"objects": [{"type": "sphere", "centre": [0, 0, 0], "radius": 1}]},
        "lights": [{"type": "directional", "direction": [0, -1, 0]}],
        "techniques": [{"type": "uncompressed"}]
    })");
}

struct Wrong {
    const char* pointer;  // the place that is set
    const char* value;
    const char* where;    // the place of the error
    const char* message;  // its message
};

class WrongValue : public testing::TestWithParam<Wrong> {};

TEST_P(WrongValue, IsAnErrorThatPointsAtItAndTeaches) {
    json document = minimal();
    document[json::json_pointer(GetParam().pointer)] = json::parse(GetParam().value);
    const base::Error error = test::error_of([&] { check_schema(document, scenario_schema()); });
    EXPECT_EQ(error.code(), base::ErrorCode::bad_input);
    EXPECT_EQ(error.where(), GetParam().where);
    EXPECT_THAT(error.message(), HasSubstr(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    UnknownKeys, WrongValue,
    testing::Values(Wrong{"/colour", "1", "/colour", "the keys here are: $schema, lights, name"},
                    Wrong{"/ray", "{}", "/ray", "perhaps \"rays\""},
                    Wrong{"/lights/0/color", "1", "/lights/0/color", "perhaps \"colour\""},
                    Wrong{"/lights/0/position", "[0, 1, 0]", "/lights/0/position",
                          "the keys here are: casts_shadow, colour, direction"},
                    Wrong{"/scene/objects/0/extinction", "1", "/scene/objects/0/extinction", "casts_shadow, centre"},
                    Wrong{"/scene/object", "[]", "/scene/object", "perhaps \"objects\""},
                    Wrong{"/receivers", R"({"type": "probes", "fov": 3})", "/receivers/fov", "unknown key \"fov\""},
                    Wrong{"/sweeps", R"({"rays/seed": [1]})", "/sweeps/rays~1seed", "keys here match: ^/"}));

INSTANTIATE_TEST_SUITE_P(
    WrongTypes, WrongValue,
    testing::Values(
        Wrong{"/rays", "3", "/rays", "expected object, got number 3"},
        Wrong{"/rays", R"({"resolution": "big"})", "/rays/resolution", "expected integer in [1, 16384] or array"},
        Wrong{"/rays", R"({"resolution": [1, 2, 3]})", "/rays/resolution", "got array of 3 items"},
        Wrong{"/rays", R"({"resolution": [1, "x"]})", "/rays/resolution/1", "got string \"x\""},
        Wrong{"/rays", R"({"samples_per_pixel": 1.5})", "/rays/samples_per_pixel", "expected integer"},
        Wrong{"/scene/objects/0/casts_shadow", "1", "/scene/objects/0/casts_shadow", "expected boolean"},
        Wrong{"/scene/objects/0/centre/2", "null", "/scene/objects/0/centre/2", "got null"},
        Wrong{"/scene/objects/0", "\"sphere\"", "/scene/objects/0", "expected object"},
        Wrong{"/scene/objects/0/opacity", "[1, 1]", "/scene/objects/0/opacity", "array of 3 items"},
        Wrong{"/lights", "{}", "/lights", "expected array"}, Wrong{"/name", "\"a b\"", "/name", "A-Za-z0-9"},
        Wrong{"/name", "\"..\"", "/name", "expected string that matches"},
        Wrong{"/name", "\".\"", "/name", "expected string that matches"}, Wrong{"", "[]", "/", "expected object"},
        Wrong{"", "3", "/", "expected object"}, Wrong{"/name", "\"\"", "/name", "expected string that matches"}));

INSTANTIATE_TEST_SUITE_P(
    OutOfRange, WrongValue,
    testing::Values(Wrong{"/rays", R"({"resolution": 16385})", "/rays/resolution", "[1, 16384]"},
                    Wrong{"/rays", R"({"samples_per_pixel": 4097})", "/rays/samples_per_pixel", "[1, 4096]"},
                    Wrong{"/rays", R"({"seed": -1})", "/rays/seed", "[0, 9007199254740991]"},
                    Wrong{"/rays", R"({"pattern": "regulra"})", "/rays/pattern", "one of: regular, jittered"},
                    Wrong{"/scene/objects/0/radius", "0", "/scene/objects/0/radius", "got number 0"},
                    Wrong{"/scene/objects/0/opacity", "1.5", "/scene/objects/0/opacity", "number in [0, 1]"},
                    Wrong{"/scene/objects/0/opacity", "[0, 2, 0]", "/scene/objects/0/opacity/1", "number in [0, 1]"},
                    Wrong{"/scene/objects/0/centre/0", "1e30", "/scene/objects/0/centre/0", "got number 1e+30"},
                    Wrong{"/receivers", R"({"type": "probes", "count": 0})", "/receivers/count", "[1, 67108864]"},
                    Wrong{"/receivers", R"({"type": "probes", "filter_width": 0})", "/receivers/filter_width",
                          "[1e-06, 1024]"},
                    Wrong{"/scene/objects", "[]", "/scene/objects", "at least 1 items"},
                    Wrong{"/techniques", "[]", "/techniques", "1 to 256 items"}));

INSTANTIATE_TEST_SUITE_P(
    Missing, WrongValue,
    testing::Values(Wrong{"/scene/objects/0", R"({"centre": [0, 0, 0]})", "/scene/objects/0", "\"type\" is missing"},
                    Wrong{"/scene/objects/0", R"({"type": "sphere", "radius": 1})", "/scene/objects/0",
                          "\"centre\" is missing"},
                    Wrong{"/scene/objects/0/type", "\"shpere\"", "/scene/objects/0/type", "perhaps \"sphere\""},
                    Wrong{"/lights/0/type", "\"area\"", "/lights/0/type", "one of: directional, spot, point"},
                    Wrong{"/techniques/0", "{}", "/techniques/0", "\"type\" is missing"}));

TEST(CheckSchema, AcceptsAMinimalScenario) {
    EXPECT_NO_THROW(check_schema(minimal(), scenario_schema()));
}

TEST(CheckSchema, LeavesTechniqueParametersToTheTechnique) {
    json document = minimal();
    document["techniques"][0]["anything"] = {1, 2, 3};
    EXPECT_NO_THROW(check_schema(document, scenario_schema()));
}

TEST(CheckSchema, MessageOfALongValueIsOneShortLine) {
    json document = minimal();
    document["name"] = std::string(100000, '\n');
    const base::Error error = test::error_of([&] { check_schema(document, scenario_schema()); });
    EXPECT_LT(error.message().size(), 200u);
    EXPECT_THAT(error.message(), Not(HasSubstr("\n")));
}

std::vector<std::string> places(const std::vector<base::Error>& faults) {
    std::vector<std::string> where;
    for (const base::Error& fault : faults) where.push_back(fault.where());
    return where;
}

TEST(SchemaFaults, ReportEachFaultOnce) {
    json document = minimal();
    EXPECT_TRUE(schema_faults(document, scenario_schema(), 32).empty());
    document["ray"] = 1;
    document["rays"] = {{"resolution", 0}, {"seed", "x"}};
    document["lights"][0]["color"] = 1;
    document["lights"].push_back({{"type", "directional"}, {"direction", {0, "down", nullptr}}});
    document["scene"]["objects"].push_back({{"type", "sphere"}});
    document.erase("name");
    const std::vector<base::Error> faults = schema_faults(document, scenario_schema(), 32);
    EXPECT_THAT(places(faults),
                testing::UnorderedElementsAre("", "/ray", "/rays/resolution", "/rays/seed", "/lights/0/color",
                                              "/lights/1/direction/1", "/lights/1/direction/2", "/scene/objects/1",
                                              "/scene/objects/1"));
    EXPECT_STREQ(faults[0].what(), test::error_of([&] { check_schema(document, scenario_schema()); }).what());
}

TEST(SchemaFaults, AreNoMoreThanAskedFor) {
    json document = minimal();
    for (int i = 0; i < 100'000; ++i) document["unknown" + std::to_string(i)] = 1;
    EXPECT_EQ(schema_faults(document, scenario_schema(), 32).size(), 32u);
    document = minimal();
    document["scene"]["objects"] = json::array();
    for (int i = 0; i < 1000; ++i) document["scene"]["objects"].push_back(i);
    EXPECT_EQ(schema_faults(document, scenario_schema(), 5).size(), 5u);
}

TEST(CheckSchema, NamesTheFormsOfAnAlternative) {
    const json schema = json::parse(R"({"properties": {"tolerance":
        {"anyOf": [{"type": "number", "minimum": 0, "maximum": 1}, {"enum": ["noise"]}]}}})");
    const base::Error error = test::error_of([&] { check_schema(json{{"tolerance", 2}}, schema); });
    EXPECT_EQ(error.where(), "/tolerance");
    EXPECT_THAT(error.message(), AllOf(HasSubstr("number in [0, 1]"), HasSubstr("noise"), HasSubstr("got number 2")));
    EXPECT_NO_THROW(check_schema(json{{"tolerance", "noise"}}, schema));
}

// Every property, at any depth, must have a description.
void expect_described(const json& schema, const std::string& where) {
    if (schema.is_array())
        for (const json& part : schema) expect_described(part, where);
    if (!schema.is_object()) return;
    for (const auto& [key, value] : schema.items()) {
        if (key == "properties" && where.find("/if") == std::string::npos) {
            for (const auto& [name, property] : value.items())
                EXPECT_TRUE(property.contains("description")) << where << "/properties/" << name;
        }
        expect_described(value, where + "/" + key);
    }
}

TEST(ScenarioSchema, DescribesEveryProperty) {
    expect_described(scenario_schema(), "");
}

TEST(ScenarioSchema, RefusesUnknownKeysEverywhereButInTechniques) {
    for (const auto& [name, definition] : scenario_schema()["definitions"].items())
        if (definition.contains("properties") && !definition.contains("allOf") && name != "technique") {
            EXPECT_EQ(definition.value("additionalProperties", json(true)), json(false)) << name;
        }
    for (const auto& [name, property] : scenario_schema()["properties"].items())
        if (property.contains("properties") && !property.contains("allOf")) {
            EXPECT_EQ(property.value("additionalProperties", json(true)), json(false)) << name;
        }
}

}  // namespace
}  // namespace shadowbench::scene
