#include "document/document.h"

#include <gtest/gtest.h>

#include <algorithm>

#include <nlohmann/json.hpp>

#include "errors.h"
#include "scene/scenario.h"
#include "techniques/technique.h"

namespace shadowbench::document {
namespace {

using base::ErrorCode;
using nlohmann::json;

json small_document() {
    return json::parse(R"({
        "name": "small",
        "scene": {"objects": [{"type": "sphere", "centre": [0, 0, 0], "radius": 1}]},
        "lights": [{"type": "directional", "direction": [0, -1, 0]}],
        "rays": {"resolution": 16, "samples_per_pixel": 4},
        "techniques": [{"type": "deep", "tolerance": 0.02}, {"type": "avsm"}]
    })");
}

TEST(SetValue, takes_dotted_paths_and_pointers) {
    json document = small_document();
    set_value(document, "rays.samples_per_pixel=64");
    set_value(document, "/techniques/0/tolerance=0.5");
    EXPECT_EQ(document["rays"]["samples_per_pixel"], 64);
    EXPECT_EQ(document["techniques"][0]["tolerance"], 0.5);
}

TEST(SetValue, takes_text_that_is_not_json_as_a_string) {
    json document = small_document();
    set_value(document, "rays.pattern=regular");
    set_value(document, "techniques.0.tolerance=noise");
    EXPECT_EQ(document["rays"]["pattern"], "regular");
    EXPECT_EQ(document["techniques"][0]["tolerance"], "noise");
}

TEST(SetValue, takes_numbers_that_are_not_finite_as_strings_that_the_schema_refuses) {
    for (const char* value : {"NaN", "nan", "inf", "-Infinity", "1e999", "0x10", "1,5", "\"64\"", ""})
        for (const char* path : {"rays.samples_per_pixel", "rays.seed", "lights.0.direction.1"}) {
            json document = small_document();
            set_value(document, std::string(path) + "=" + value);
            std::string where = std::string("/") + path;
            std::replace(where.begin(), where.end(), '.', '/');
            test::error_of([&] { expand(document); }, ErrorCode::bad_input, where);
        }
}

TEST(SetValue, holds_nested_values_to_the_rules_of_documents) {
    json document = small_document();
    set_value(document, "lights.0.direction=[0, -2, 0]");
    EXPECT_EQ(document["lights"][0]["direction"], json({0, -2, 0}));
    const std::string deep(100000, '[');  // copied recursively, it would overflow the stack
    test::error_of([&] { set_value(document, "name=" + deep); }, ErrorCode::bad_input, "--set name:1:65");
    test::error_of([&] { set_value(document, R"(rays={"seed": 1, "seed": 2})"); }, ErrorCode::bad_input,
                   "--set rays:1:13");
}

TEST(SetValue, refuses_an_index_too_large_for_an_integer) {
    json document = small_document();
    const std::string assignment = "lights.99999999999999999999999.direction=1";
    test::error_of([&] { set_value(document, assignment); }, ErrorCode::usage, "--set " + assignment);
    document["sweeps"] = {{"/lights/99999999999999999999999/direction", {1, 2}}};
    test::error_of([&] { expand(document); }, ErrorCode::bad_input,
                   "/sweeps/~1lights~199999999999999999999999~1direction");
}

TEST(SetValue, adds_a_part_that_the_document_leaves_out) {
    json document = small_document();
    set_value(document, "timing.repetitions=3");
    EXPECT_EQ(document["timing"]["repetitions"], 3);
}

TEST(SetValue, drops_a_sweep_over_the_same_value) {
    json document = small_document();
    document["sweeps"] = {{"/rays/samples_per_pixel", {1, 4}}, {"/techniques/1/nodes", {4, 8}}};
    set_value(document, "rays.samples_per_pixel=64");
    EXPECT_EQ(document["sweeps"], (json{{"/techniques/1/nodes", {4, 8}}}));
    EXPECT_EQ((*expand(document).at(0).document)["rays"]["samples_per_pixel"], 64);
    set_value(document, "/techniques/1/nodes=16");
    EXPECT_FALSE(document.contains("sweeps"));
}

TEST(SetValue, refuses_a_path_that_leads_nowhere) {
    json document = small_document();
    for (const char* assignment : {"rayz.samples=3", "techniques.7.tolerance=1", "rays.resolution.x=4", "name"})
        test::error_of([&] { set_value(document, assignment); }, ErrorCode::usage, std::string("--set ") + assignment);
    EXPECT_EQ(document, small_document());
}

TEST(CheckDocument, names_the_place_of_a_misspelt_parameter) {
    json document = small_document();
    document["techniques"][1]["tolerence"] = 0.1;
    const std::string message =
        test::error_of([&] { check_document(document); }, ErrorCode::bad_input, "/techniques/1/tolerence");
    EXPECT_NE(message.find("nodes"), std::string::npos) << "lists the parameters: " << message;
}

TEST(CheckDocument, lists_the_techniques) {
    json document = small_document();
    document["techniques"][0] = {{"type", "shallow"}};
    const std::string message =
        test::error_of([&] { check_document(document); }, ErrorCode::bad_input, "/techniques/0/type");
    EXPECT_NE(message.find("uncompressed"), std::string::npos) << message;
}

TEST(AllFaults, begin_with_the_one_that_was_thrown) {
    json document = small_document();
    document["rays"]["samples_per_pixel"] = "many";
    document["techniques"] = {{{"type", "deep"}, {"tolerance", -1}, {"kernal", 1}}, {{"type", "dep"}}, 3};
    const base::Error first(ErrorCode::bad_input, "/lights/0/direction", "has no length");
    std::vector<std::string> where;
    for (const base::Error& fault : all_faults(document, first)) where.push_back(fault.where());
    EXPECT_EQ(where[0], "/lights/0/direction");
    std::sort(where.begin(), where.end());
    EXPECT_EQ(where, (std::vector<std::string>{"/lights/0/direction", "/rays/samples_per_pixel", "/techniques/0/kernal",
                                               "/techniques/0/tolerance", "/techniques/1/type", "/techniques/2"}));
    EXPECT_EQ(all_faults(json::array(), {ErrorCode::bad_input, "/", "expected object, got array of 0 items"}).size(),
              1u);
}

TEST(FullSchema, knows_every_parameter) {
    json document = small_document();
    EXPECT_NO_THROW(scene::check_schema(document, full_schema()));
    document["techniques"][1]["nodes"] = 1000;  // the committed schema cannot detect this
    EXPECT_NO_THROW(scene::check_schema(document, scene::scenario_schema()));
    EXPECT_THROW(scene::check_schema(document, full_schema()), base::Error);
}

TEST(Expand, combines_sweeps_outside_techniques_into_variants) {
    json document = small_document();
    document["sweeps"] = {{"/rays/samples_per_pixel", {1, 4}}, {"/rays/seed", {7, 8, 9}}};
    const std::vector<Variant> variants = expand(document);
    ASSERT_EQ(variants.size(), 6u);
    EXPECT_EQ((*variants[4].document)["rays"]["samples_per_pixel"], 4);
    EXPECT_EQ((*variants[4].document)["rays"]["seed"], 8);
    ASSERT_EQ(variants[4].settings.size(), 2u);
    EXPECT_EQ(variants[4].settings[0].pointer, "/rays/samples_per_pixel");
    EXPECT_EQ(variants[4].settings[1].value, "8");
    EXPECT_FALSE(variants[4].document->contains("sweeps"));
}

TEST(Expand, replaces_a_swept_technique_by_one_for_each_combination) {
    json document = small_document();
    document["sweeps"] = {{"/techniques/0/tolerance", {0.1, 0.2}}, {"/techniques/1/nodes", {4, 8, 16}}};
    const std::vector<Variant> variants = expand(document);
    ASSERT_EQ(variants.size(), 1u);
    const json& techniques = (*variants[0].document)["techniques"];
    ASSERT_EQ(techniques.size(), 5u);
    EXPECT_EQ(techniques[1], (json{{"type", "deep"}, {"tolerance", 0.2}}));
    EXPECT_EQ(techniques[4], (json{{"type", "avsm"}, {"nodes", 16}}));
    EXPECT_EQ(variants[0].technique_where[4], "/techniques/1");
    EXPECT_TRUE(variants[0].settings.empty());
}

TEST(Expand, names_the_parameters_that_sweeps_set) {
    json document = small_document();
    document["sweeps"] = {{"/techniques/1/nodes", {4, 8}}, {"/techniques/1/cells", {"sample"}}, {"/rays/seed", {1}}};
    Variant variant = expand(document)[0];
    using Names = std::vector<std::string>;
    EXPECT_EQ(variant.swept, (std::vector<Names>{{}, {"cells", "nodes"}, {"cells", "nodes"}}));
    keep_only(variant, Names{"avsm"});
    EXPECT_EQ(variant.swept, (std::vector<Names>{{"cells", "nodes"}, {"cells", "nodes"}}));
}

TEST(Expand, leaves_a_document_without_sweeps_as_it_is) {
    const std::vector<Variant> variants = expand(small_document());
    ASSERT_EQ(variants.size(), 1u);
    EXPECT_EQ(*variants[0].document, small_document());
}

TEST(Expand, refuses_a_swept_value_out_of_range_at_the_original_place) {
    json document = small_document();
    document["sweeps"] = {{"/techniques/0/tolerance", {0.1, 0.2}}, {"/techniques/1/nodes", {4, 800}}};
    test::error_of([&] { expand(document); }, ErrorCode::bad_input, "/techniques/1/nodes");
}

TEST(Expand, refuses_pointers_to_nothing) {
    for (const char* pointer : {"/rayz/seed", "/techniques/9/nodes", "/rays/resolution/width"}) {
        json document = small_document();
        document["sweeps"] = {{pointer, {1, 2}}};
        test::error_of([&] { expand(document); }, ErrorCode::bad_input,
                       (json::json_pointer("/sweeps") / pointer).to_string());
    }
}

TEST(Expand, escapes_the_names_of_unknown_parameters_in_their_places) {
    json document = small_document();
    document["techniques"][0]["a/b~c"] = 1;
    test::error_of([&] { expand(document); }, ErrorCode::bad_input, "/techniques/0/a~1b~0c");
    document["techniques"] = {{{"type", "*"}, {"a/b", 1}}};
    test::error_of([&] { expand(document); }, ErrorCode::bad_input, "/techniques/0/a~1b");
}

TEST(Expand, refuses_too_many_variants) {
    json document = small_document(), many = json::array();
    for (int i = 0; i < 100; ++i) many.push_back(i);
    document["sweeps"] = {{"/rays/seed", many}, {"/receivers/seed", many}};
    test::error_of([&] { expand(document); }, ErrorCode::bad_input, "/sweeps/~1receivers~1seed");
}

std::vector<std::string> types_of(const Variant& variant) {
    std::vector<std::string> types;
    for (const json& technique : (*variant.document)["techniques"]) types.push_back(technique["type"]);
    return types;
}

std::vector<std::string> types_of_all_rows() {
    std::vector<std::string> types;
    for (const techniques::Technique& row : techniques::all()) types.emplace_back(row.id);
    return types;
}

TEST(Expand, puts_every_technique_with_its_defaults_in_the_place_of_the_star) {
    json document = small_document();
    document["techniques"] = {{{"type", "*"}}};
    const std::vector<Variant> variants = expand(document);
    ASSERT_EQ(variants.size(), 1u);
    EXPECT_EQ(types_of(variants[0]), types_of_all_rows());
    for (const json& technique : (*variants[0].document)["techniques"]) EXPECT_EQ(technique.size(), 1u) << technique;
    EXPECT_EQ(variants[0].technique_where, std::vector<std::string>(techniques::all().size(), "/techniques/0"));
}

TEST(Expand, keeps_the_settings_that_are_listed_beside_the_star) {
    json document = small_document();
    const json deep = {{"type", "deep"}, {"tolerance", 0.5}}, plain = {{"type", "avsm"}},
               few = {{"type", "avsm"}, {"nodes", 2}};
    document["techniques"] = {deep, {{"type", "*"}}, plain, few};
    document["sweeps"] = {{"/techniques/3/nodes", {2, 4}}};
    const Variant variant = expand(document).at(0);
    std::vector<std::string> expected = types_of_all_rows();
    std::erase(expected, "deep");
    std::erase(expected, "avsm");
    expected.insert(expected.begin(), "deep");
    for (int i = 0; i < 3; ++i) expected.push_back("avsm");
    EXPECT_EQ(types_of(variant), expected) << "techniques named elsewhere are not repeated";
    const json& techniques = (*variant.document)["techniques"];
    EXPECT_EQ(techniques[0], deep);
    EXPECT_EQ(techniques[expected.size() - 3], plain);
    EXPECT_EQ(techniques[expected.size() - 1], (json{{"type", "avsm"}, {"nodes", 4}}));
    EXPECT_EQ(variant.technique_where.front(), "/techniques/0");
    EXPECT_EQ(variant.technique_where[1], "/techniques/1");
    EXPECT_EQ(variant.technique_where.back(), "/techniques/3");
}

TEST(Expand, removes_a_star_beside_every_technique) {
    json document = small_document();
    document["techniques"] = {{{"type", "*"}}};
    for (const std::string& type : types_of_all_rows()) document["techniques"].push_back({{"type", type}});
    EXPECT_EQ(types_of(expand(document).at(0)), types_of_all_rows());
}

TEST(Expand, leaves_tracing_techniques_out_of_the_star_without_a_scene) {
    json document = small_document();
    document["techniques"] = {{{"type", "*"}}};
    document["scene"] = {{"deep_image", {{"file", "a.exr"}}}};
    document.erase("lights");
    std::vector<std::string> expected;
    for (const techniques::Technique& row : techniques::all())
        if (!row.traits.traces) expected.emplace_back(row.id);
    EXPECT_LT(expected.size(), techniques::all().size());
    EXPECT_EQ(types_of(expand(document).at(0)), expected);
}

TEST(Expand, refuses_a_star_with_parameters_or_twice) {
    json document = small_document();
    document["techniques"] = {{{"type", "avsm"}}, {{"type", "*"}, {"nodes", 4}}};
    const std::string message = test::error_of([&] { expand(document); }, ErrorCode::bad_input, "/techniques/1/nodes");
    EXPECT_NE(message.find("takes no parameters"), std::string::npos) << message;
    test::error_of([&] { check_document(document); }, ErrorCode::bad_input, "/techniques/1/nodes");
    EXPECT_EQ(all_faults(document, {ErrorCode::bad_input, "/rays", "x"}).at(1).where(), "/techniques/1/nodes");
    document["techniques"] = {{{"type", "*"}}, {{"type", "avsm"}}, {{"type", "*"}}};
    test::error_of([&] { expand(document); }, ErrorCode::bad_input, "/techniques/2/type");
    document["techniques"] = {{{"type", "avsm"}}, {{"type", "*"}}};
    document["sweeps"] = {{"/techniques/1/nodes", {4, 8}}};
    test::error_of([&] { expand(document); }, ErrorCode::bad_input, "/techniques/1/nodes");
}

TEST(CheckDocument, takes_the_star) {
    json document = small_document();
    document["techniques"].push_back({{"type", "*"}});
    EXPECT_NO_THROW(check_document(document));
    EXPECT_EQ(all_faults(document, {ErrorCode::bad_input, "/rays", "x"}).size(), 1u);
    document["techniques"][2]["nodes"] = 4;
    EXPECT_THROW(scene::check_schema(document, full_schema()), base::Error);
}

TEST(KeepOnly, knows_what_the_star_stands_for) {
    json document = small_document();
    document["techniques"] = {{{"type", "*"}}};
    Variant variant = expand(document)[0];
    const std::vector<std::string> types{"pcf"};
    keep_only(variant, types);
    EXPECT_EQ((*variant.document)["techniques"], json::array({{{"type", "pcf"}}}));
}

TEST(SelectVariant, counts_as_expand_does) {
    json document = small_document();
    document["sweeps"] = {
        {"/rays/samples_per_pixel", {4, 9, 16}}, {"/rays/seed", {1, 2}}, {"/techniques/1/nodes", {4, 8}}};
    const std::vector<Variant> variants = expand(document);
    ASSERT_EQ(variants.size(), 6u);
    for (std::size_t i = 0; i < variants.size(); ++i) {
        const std::vector<Variant> one = expand(select_variant(document, i));
        ASSERT_EQ(one.size(), 1u);
        EXPECT_EQ(*one[0].document, *variants[i].document) << i;
    }
    test::error_of([&] { select_variant(document, 6); }, ErrorCode::usage, "variant=6");
    EXPECT_EQ(select_variant(small_document(), 0), small_document());
}

TEST(KeepOnly, keeps_techniques_with_their_places) {
    Variant variant = expand(small_document())[0];
    const std::vector<std::string> types{"avsm"};
    keep_only(variant, types);
    EXPECT_EQ((*variant.document)["techniques"].size(), 1u);
    EXPECT_EQ(variant.technique_where, std::vector<std::string>{"/techniques/1"});
}

TEST(KeepOnly, refuses_a_technique_that_the_scenario_lacks) {
    Variant variant = expand(small_document())[0];
    const std::vector<std::string> types{"pcf"};
    const std::string message = test::error_of([&] { keep_only(variant, types); }, ErrorCode::usage, "--only pcf");
    EXPECT_NE(message.find("deep avsm"), std::string::npos) << message;
}

}  // namespace
}  // namespace shadowbench::document
