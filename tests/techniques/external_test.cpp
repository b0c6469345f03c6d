// Techniques from shared libraries: tests/external/stairs.cpp is sound, faulty.cpp does what its parameter says.
#include "techniques/external/library.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "errors.h"
#include "techniques/external/load.h"
#include "techniques/external/shadowbench_technique.hpp"
#include "techniques/hand_rays.h"
#include "temporary_folder.h"

namespace shadowbench::techniques {
namespace {

using base::ErrorCode;
using ::testing::HasSubstr;

const std::string stairs_file = SHADOWBENCH_STAIRS, faulty_file = SHADOWBENCH_FAULTY,
                  nothing_file = SHADOWBENCH_NOTHING;

Technique row_of(const std::string& file) {
    const OpenLibrary library = open_library(file);
    return make_row(library.techniques.at(0), library.library);
}

testing::HandMap map_of(const Technique& row, const testing::HandRays& rays, const nlohmann::json& parameters) {
    return testing::make_map(row, read_parameters(row.parameters, parameters, ""), rays);
}

// What the library does wrong while the environment asks for it.
class WithFault {
public:
    explicit WithFault(const char* fault) { ::setenv("SHADOWBENCH_TEST_FAULT", fault, 1); }
    ~WithFault() { ::unsetenv("SHADOWBENCH_TEST_FAULT"); }
    WithFault(const WithFault&) = delete;
    WithFault& operator=(const WithFault&) = delete;
};

TEST(ExternalTechnique, IsARowAsItsLibraryDescribesIt) {
    const Technique row = row_of(stairs_file);
    EXPECT_STREQ(row.id, "stairs");
    EXPECT_EQ(row.version, 1);
    ASSERT_EQ(row.parameters.size(), 1u);
    EXPECT_STREQ(row.parameters[0].name, "stairs");
    EXPECT_EQ(row.parameters[0].kind, ParameterKind::integer);
    EXPECT_EQ(row.parameters[0].standard, 64.0);
    EXPECT_EQ(row.parameters[0].max, 1024.0);
    ASSERT_EQ(row.traits.trades.size(), 1u);
    EXPECT_EQ(row.traits.trades[0].scale, Trade::Scale::logarithmic);
    EXPECT_TRUE(row.promises.monotone && row.promises.localised && !row.promises.opaque_only);
    EXPECT_EQ(row.library.hash.size(), 16u);
    EXPECT_EQ(row.library, identify(stairs_file));
    const ParameterValues eight = read_parameters(row.parameters, {{"stairs", 8}}, "");
    EXPECT_EQ(row.error_bound(eight, {}), 1.0 / 16);
    rays::MapLayout media;
    media.media = true;
    EXPECT_TRUE(std::isinf(row.error_bound(eight, media)));
}

// Two walls that let half through each, over one of two rays: 1, 3/4, 5/8.
TEST(ExternalTechnique, AnswersWhatItsFunctionStored) {
    const Technique row = row_of(stairs_file);
    const testing::HandRays rays{2, 1, 2, {{{1, 1, 0.5f}, {2, 2, 0.5f}}, {}, {}, {}}};
    const testing::HandMap built = map_of(row, rays, {{"stairs", 8}});
    const auto at = [&](float x, float z, float width) { return built({x, 0.5f, z, width}); };
    EXPECT_EQ(at(0.5f, 1.0f, 0.0f), 1.0f) << "a surface shades only what is strictly behind it";
    EXPECT_EQ(at(0.5f, 1.5f, 0.0f), 0.75f);
    EXPECT_EQ(at(0.5f, 2.5f, 0.0f), 0.625f);
    EXPECT_EQ(at(1.5f, 2.5f, 0.0f), 1.0f) << "the other pixel is empty";
    EXPECT_EQ(at(1.0f, 2.5f, 2.0f), 0.8125f) << "a footprint over both pixels";
    EXPECT_EQ(at(0.75f, 2.5f, 1.0f), 0.75f * 0.625f + 0.25f) << "weighted by area";
    EXPECT_EQ(at(-0.5f, 2.5f, 1.0f), 1.0f);
    EXPECT_EQ(at(0.5f, std::numeric_limits<float>::quiet_NaN(), 0.0f), 1.0f);
    EXPECT_EQ(at(0.5f, std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()), 0.625f);
    EXPECT_EQ(built.map->nodes().total, 4u);
    EXPECT_EQ(built.map->nodes().max, 4u);
    EXPECT_EQ(built.map->bytes(), 3 * sizeof(std::size_t) + 4 * sizeof(curves::Vertex));
    EXPECT_GE(built.map->working_bytes(), built.map->bytes());
    curves::Curve curve;
    built.map->stored(0, 0, 0, {}, curve);
    EXPECT_EQ(curve, (curves::Curve{{1, 1}, {1, 0.75f}, {2, 0.75f}, {2, 0.625f}}));
    std::vector<const void*> lines;
    built.map->touched({0.5f, 0.5f, 1.5f, 0.0f}, lines);
    EXPECT_FALSE(lines.empty());
    EXPECT_EQ(built.map->fault(), "");
}

// Without the checks at the border, each of these would end the program or pass for an answer.
TEST(ExternalTechnique, OfAFaultyLibraryFailsWithTheReason) {
    const Technique row = row_of(faulty_file);
    const testing::HandRays wall{1, 1, 1, {{{1, 1, 0.5f}}}};
    const auto fault_of = [&](const char* fault) -> std::string {
        try {
            const testing::HandMap built = map_of(row, wall, {{"fault", fault}});
            EXPECT_TRUE(std::isnan(built({0.5f, 0.5f, 2.0f, 0.0f})) || built.map->fault().empty());
            curves::Curve curve;
            built.map->stored(0, 0, 0, {}, curve);
            std::vector<const void*> lines;
            built.map->touched({0.5f, 0.5f, 2.0f, 0.0f}, lines);
            return built.map->fault();
        } catch (const base::Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::internal) << error.what();
            return error.message();
        }
    };
    EXPECT_EQ(fault_of("none"), "");
    EXPECT_EQ(fault_of("create"), "technique faulty: create() failed: line one line two");
    EXPECT_THAT(fault_of("no_map"), HasSubstr("create() made no map"));
    EXPECT_THAT(fault_of("add"), HasSubstr("add() failed: as it was asked to"));
    EXPECT_THAT(fault_of("finish"), HasSubstr("finish() failed"));
    EXPECT_THAT(fault_of("lookup"), HasSubstr("lookup() failed"));
    EXPECT_THAT(fault_of("throw"), HasSubstr("add() threw an exception: over the border"));
    EXPECT_THAT(fault_of("vertices"), HasSubstr("stored() returned"));
    EXPECT_THAT(fault_of("endless"), HasSubstr("stored() returned"));
    EXPECT_THAT(fault_of("unsorted"), HasSubstr("whose depth is below that of the vertex before"));
    EXPECT_THAT(fault_of("nodes"), HasSubstr("nodes() of cell (0, 0) returned 4000000000"));
    EXPECT_THAT(fault_of("bytes"), HasSubstr("holds 8 bytes, and that building it never held more than 4"));
    EXPECT_THAT(fault_of("least"), HasSubstr("holds 8 bytes, and least_bytes() says at least 16"));
    EXPECT_THAT(fault_of("heavy"), HasSubstr("bytes() returned 9223372036854775808 and 9223372036854775808; at most"));
    EXPECT_THAT(fault_of("immense"), HasSubstr("least_bytes() returned 1152921504606846976; at most"));
    EXPECT_EQ(row.least_bytes(read_parameters(row.parameters, {{"fault", "immense"}}, ""), {}), 0u)
        << "the whole scenario would be refused for lack of memory";
    EXPECT_THAT(fault_of("null_lines"), HasSubstr("touched() gave a null pointer"));
    EXPECT_THAT(fault_of("bound"), HasSubstr("error_bound() returned -1"));
    EXPECT_TRUE(std::isinf(row.error_bound(read_parameters(row.parameters, {{"fault", "bound"}}, ""), {})))
        << "asking the row must not end a run";
}

TEST(ExternalTechnique, ThatAnswersTooFewLeavesNoOldAnswer) {
    const Technique row = row_of(faulty_file);
    const testing::HandMap built = map_of(row, {1, 1, 1, {{}}}, {{"fault", "few"}});
    const std::vector<Query> queries(3, Query{0.5f, 0.5f, 2.0f, 0.0f});
    std::vector<float> visibility(3, 0.25f);
    built.map->lookup(queries, visibility);
    EXPECT_EQ(visibility[1], 1.0f);
    EXPECT_TRUE(std::isnan(visibility[2]));
}

Curve level_of_word(const CellRays&, const Values& values) {
    return {{0.0f, values[0].word[0] == 'h' ? 0.5f : 0.25f}};
}

// Words are gone once a map is made, and the function runs later.
TEST(ExternalHelper, KeepsTheWordsForItsFunction) {
    static constexpr const char* words[] = {"half", "less"};
    const shadowbench_parameter parameter = choice("level", "how bright", "half", words);
    EXPECT_EQ(parameter.word_count, 2u);
    std::string word = parameter.standard_word;
    FunctionMap<level_of_word, SHADOWBENCH_CELL_PIXEL> map(Values{{0.0, word.c_str()}}, {1, 1, 1, 1, 1, 1, 0, 0, 1});
    word = "less";
    const std::uint32_t begin[] = {0, 0};
    map.add({0, 0, 1, 1, 1, begin, nullptr, nullptr, nullptr});
    map.finish();
    EXPECT_EQ(map.stored(0, 0, nullptr, 0).at(0).value, 0.5f);
}

TEST(ExternalLibrary, IsRefusedWithTheReason) {
    const auto reason = [](const char* fault) {
        const WithFault with(fault);
        return test::error_of([] { open_library(faulty_file); }, ErrorCode::bad_input, faulty_file);
    };
    EXPECT_THAT(reason("abi"), HasSubstr("made for version 7 of shadowbench_technique.h, and this program for 1"));
    EXPECT_THAT(reason("size"), HasSubstr("has 8 bytes instead of"));
    EXPECT_THAT(reason("throw"), HasSubstr("shadowbench_techniques() threw an exception"));
    EXPECT_THAT(reason("null"), HasSubstr("returned a null pointer"));
    EXPECT_THAT(reason("empty"), HasSubstr("has no techniques"));
    EXPECT_THAT(reason("many"), HasSubstr("declares 4000000000 techniques; at most"));
    EXPECT_THAT(reason("no_list"), HasSubstr("no list of them"));
    EXPECT_THAT(reason("twice"), HasSubstr("two of its techniques are \"faulty\""));
    EXPECT_THAT(reason("id"), HasSubstr("technique \"Faulty!\": an id is of lower-case letters"));
    EXPECT_THAT(reason("null_title"), HasSubstr("the title of a technique is a null pointer"));
    EXPECT_THAT(reason("incomplete"), HasSubstr("lacks a function: create, destroy, add, finish, lookup and bytes"));
    EXPECT_THAT(reason("no_stored"), HasSubstr("lacks the function stored"));
    EXPECT_THAT(reason("cells"), HasSubstr("cells of kind 9"));
    EXPECT_THAT(reason("standard"), HasSubstr("parameter \"fault\": its default is none of its words"));
    EXPECT_THAT(reason("kind"), HasSubstr("kind -1"));
    EXPECT_THAT(test::error_of([] { open_library(nothing_file); }, ErrorCode::bad_input, nothing_file),
                HasSubstr("does not export shadowbench_techniques()"));
    const TemporaryFolder folder;
    const std::string text = (folder.path() / "text.so").string();
    std::ofstream(text) << "no library\n";
    EXPECT_THAT(test::error_of([&] { open_library(text); }, ErrorCode::bad_input, text),
                HasSubstr("not a shared library that can be loaded"));
    const std::string missing = (folder.path() / "missing.so").string();
    test::error_of([&] { open_library(missing); }, ErrorCode::no_such_file, missing);
}

// The rows stay for the rest of a program, so this one ends. Broken libraries must not hinder the others.
[[noreturn]] void add_rows() {
    const std::size_t before = all().size();
    const Technique* first = &all().front();
    load_library(stairs_file);
    load_library(stairs_file);
    ASSERT_EQ(all().size(), before + 1);
    EXPECT_EQ(&all().front(), first) << "pointers to rows hold";
    EXPECT_EQ(find("stairs", "").library, identify(stairs_file));
    load_library(nothing_file);
    const Technique& broken = find(id_of_file(nothing_file), "");
    const auto map = broken.create({});
    const rays::MapLayout layout;
    const rays::LightView view;
    EXPECT_THAT(test::error_of(
                    [&] {
                        map->begin({layout, view, nullptr, 0});
                    },
                    ErrorCode::internal, broken.library.file),
                HasSubstr("does not export"));
    const WithFault with("taken");
    load_library(faulty_file);
    EXPECT_THAT(find(id_of_file(faulty_file), "").title, HasSubstr("there is a technique \"deep\" already"));
    EXPECT_EQ(find("deep", "").library.file, "");
    std::exit(::testing::Test::HasFailure() ? 1 : 0);
}

TEST(ExternalLibrary, AddsRowsToTheRegistryOnce) {
    EXPECT_EXIT(add_rows(), ::testing::ExitedWithCode(0), "");
    EXPECT_EQ(id_of_file("/x/libMy-Shadow.2.so"), "my_shadow");
    EXPECT_EQ(id_of_file("2.so"), "library_2");
}

}  // namespace
}  // namespace shadowbench::techniques
