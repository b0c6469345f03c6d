#include "bench/functions.h"
#include "document/technique_choice.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "errors.h"

namespace shadowbench::bench {
namespace {

using base::ErrorCode;
using curves::Curve;

std::vector<FunctionResult> measure(const std::vector<Curve>& functions, const char* technique) {
    const document::TechniqueChoice choices[] = {document::read_technique(technique)};
    return measure_functions(functions, choices, 2);
}

TEST(MeasureFunctions, finds_no_error_in_lossless_techniques) {
    const std::vector<Curve> functions{{{0, 1}, {1, 1}, {1, 0.25f}, {3, 0.2f}}, {{0, 1}, {2, 0}}};
    const FunctionResult result = measure(functions, "deep:tolerance=0.001")[0];
    EXPECT_EQ(result.functions, 2u);
    EXPECT_EQ(result.vertices_in, 6u);
    EXPECT_NEAR(result.error_max, 0.0, 1e-6);
    EXPECT_EQ(result.over_tolerance, 0u);
    EXPECT_EQ(result.broken, 0u);
    ASSERT_TRUE(result.times);
    EXPECT_EQ(result.times->lookup_random_ns.raw.size(), 2u);
    ASSERT_EQ(result.stored.size(), 2u);
    EXPECT_EQ(result.stored[1], functions[1]);
}

TEST(MeasureFunctions, compresses_a_staircase_within_its_tolerance) {
    Curve stairs;
    for (int i = 0; i <= 100; ++i) {
        const float z = static_cast<float>(i);
        stairs.push_back({z, 1.0f - 0.01f * z});
        stairs.push_back({z, std::max(0.0f, 0.99f - 0.01f * z)});
    }
    const FunctionResult result = measure({stairs}, "deep:tolerance=0.02")[0];
    EXPECT_LE(result.error_max, 0.02 + 1e-6);
    EXPECT_GT(result.error_max, 0.0);
    EXPECT_LT(result.nodes_out, 20u) << "202 vertices lie along one line";
    EXPECT_EQ(result.error_rms, result.error_max) << "one function";
    ASSERT_TRUE(result.over_fewest);
    EXPECT_EQ(result.over_fewest->cells, 1u);
    EXPECT_EQ(result.over_fewest->nodes, result.nodes_out);
    EXPECT_EQ(result.over_fewest->fewest, 2u);
}

TEST(MeasureFunctions, counts_no_tolerance_where_none_is_promised) {
    const FunctionResult result = measure({{{0, 1}, {1, 0.5f}, {2, 0}}}, "avsm:nodes=8")[0];
    EXPECT_FALSE(result.tolerance);
    EXPECT_FALSE(result.over_tolerance);
    EXPECT_TRUE(to_json(result)["over_tolerance"].is_null());
    EXPECT_TRUE(to_json(result)["nodes_over_fewest"].is_null());
}

// What a technique does not promise is reported, and fails nothing.
TEST(MeasureFunctions, reports_how_far_functions_rise_and_leave_their_range) {
    const Curve knee{{0, 1}, {1, 0.95f}, {2, 0.6f}, {3, 0.2f}, {4, 0}, {5, 0}, {9, 0}};
    const FunctionResult published = measure({knee}, "deep:tolerance=0.1,compression=published")[0];
    EXPECT_GT(published.outside_max, 0.01);
    EXPECT_LE(published.outside_max, 0.1 + 1e-6);
    EXPECT_GT(published.rise_max, 0.01);
    EXPECT_LE(published.rise_max, 0.1 + 1e-6);
    EXPECT_EQ(published.broken, 0u);
    EXPECT_EQ(published.over_tolerance, 0u);
    EXPECT_TRUE(published.times);
    const FunctionResult bounded = measure({knee}, "deep:tolerance=0.1")[0];
    EXPECT_EQ(bounded.rise_max, 0.0);
    EXPECT_EQ(bounded.outside_max, 0.0);
}

TEST(MeasureFunctions, needs_functions) {
    test::error_of([] { measure({}, "deep"); }, ErrorCode::bad_input, "");
}

TEST(ReadTechnique, reads_names_numbers_and_words) {
    const document::TechniqueChoice deep = document::read_technique("deep:tolerance=0.5");
    EXPECT_STREQ(deep.row->id, "deep");
    EXPECT_EQ(deep.values.number("tolerance"), 0.5);
    EXPECT_TRUE(document::read_technique("deep:tolerance=noise").values.is_word("tolerance"));
    EXPECT_EQ(document::read_technique("avsm:nodes=4,filter=point").values.integer("nodes"), 4);
}

TEST(ReadTechnique, refuses_unknown_names_and_wrong_values) {
    const auto refuses = [](const std::string& text, const std::string& below) {
        return test::error_of([&] { document::read_technique(text); }, ErrorCode::usage, "--technique " + text + below);
    };
    EXPECT_NE(refuses("shallow", "").find("deep"), std::string::npos) << "lists the techniques";
    refuses("deep:tolerance", "");
    refuses("deep:tolerance=7", "/tolerance");
    refuses("deep:tolerence=0.1", "/tolerence");
    refuses("avsm:nodes=2.5", "/nodes");
    refuses("ray_traced", "");
}

TEST(ReadTechnique, refuses_values_that_are_not_finite_and_names_given_twice) {
    const auto refuses = [](const std::string& text, const std::string& below) {
        test::error_of([&] { document::read_any_technique(text); }, ErrorCode::usage, "--technique " + text + below);
    };
    for (const char* value : {"nan", "inf", "1e999", "0x1p-3", "-1e-300", ""})
        refuses(std::string("deep:tolerance=") + value, "/tolerance");
    refuses("deep:tolerance=0,02", "");
    refuses("avsm:nodes=99999999999999999999", "/nodes");
    refuses("deep:tolerance=0.1,tolerance=0.2", "");  // one of the two would be lost silently
}

}  // namespace
}  // namespace shadowbench::bench
