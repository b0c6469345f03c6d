// Techniques in processes of their own: they answer as they do in this one, and nothing that they do reaches it.
#include "service/isolation/isolated.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "errors.h"
#include "techniques/hand_rays.h"
#include "temporary_folder.h"

namespace shadowbench::service {
namespace {

using techniques::Technique;
using techniques::testing::HandMap;
using techniques::testing::HandRays;
using ::testing::HasSubstr;

Technique row_of(const techniques::OpenLibrary& library) {
    return techniques::make_row(library.techniques.at(0), library.library);
}

Technique isolated(const char* file, double call_seconds = 60.0) {
    return row_of(open_isolated(file, {SHADOWBENCH_PROGRAM, call_seconds}));
}

HandMap map_of(const Technique& row, const nlohmann::json& parameters, int width = 1) {
    HandRays rays{width, 1, 1, {}};
    for (int x = 0; x < width; ++x) rays.rays.push_back({{1.0f, 1.0f, 0.5f}, {2.0f, 3.0f, 0.3f}});
    return techniques::testing::make_map(row, techniques::read_parameters(row.parameters, parameters, ""), rays);
}

constexpr techniques::Query behind{0.5f, 0.5f, 4.0f, 0.0f};

TEST(Isolated, AnswersAsInThisProcess) {
    const Technique direct = row_of(techniques::open_library(SHADOWBENCH_STAIRS)), apart = isolated(SHADOWBENCH_STAIRS);
    EXPECT_STREQ(apart.id, direct.id);
    EXPECT_TRUE(apart.library.isolated);
    EXPECT_EQ(apart.library.hash, direct.library.hash);
    ASSERT_EQ(apart.parameters.size(), 1u);
    EXPECT_STREQ(apart.parameters[0].doc, direct.parameters[0].doc);
    EXPECT_EQ(apart.parameters[0].max, direct.parameters[0].max);
    EXPECT_EQ(apart.traits.trades.at(0).to, direct.traits.trades.at(0).to);
    const auto values = techniques::read_parameters(apart.parameters, {{"stairs", 4}}, "");
    EXPECT_EQ(apart.error_bound(values, {}), 0.125);
    const HandMap one = map_of(direct, {{"stairs", 64}}, 300), other = map_of(apart, {{"stairs", 64}}, 300);
    std::vector<techniques::Query> queries;
    for (int i = 0; i < 2000; ++i)
        queries.push_back({0.16f * static_cast<float>(i), 0.5f, 0.0025f * static_cast<float>(i), 0.7f});
    EXPECT_EQ(other.lookup(queries), one.lookup(queries));
    EXPECT_EQ(other.map->bytes(), one.map->bytes());
    EXPECT_EQ(other.map->working_bytes(), one.map->working_bytes());
    EXPECT_EQ(other.map->nodes().histogram, one.map->nodes().histogram);
    curves::Curve a, b;
    one.map->stored(7, 0, 0, {}, a);
    other.map->stored(7, 0, 0, {}, b);
    EXPECT_EQ(b, a);
    std::vector<const void*> lines;
    other.map->touched(behind, lines);
    EXPECT_TRUE(lines.empty()) << "memory of another process, which nobody here may read";
    EXPECT_EQ(other.map->fault(), "");
}

TEST(Isolated, ACrashFailsItsMapAndNoOther) {
    const Technique row = isolated(SHADOWBENCH_FAULTY);
    const HandMap sound = map_of(row, {{"fault", "none"}}), crashing = map_of(row, {{"fault", "crash"}});
    EXPECT_TRUE(std::isnan(crashing(behind)));
    EXPECT_THAT(crashing.map->fault(), HasSubstr("lookup() ended its process"));
    const std::string fault = crashing.map->fault();
    EXPECT_EQ(test::error_of([&] { crashing.map->finish(); }, base::ErrorCode::internal, SHADOWBENCH_FAULTY), fault)
        << "calls that waited for the crashed one must not hide its reason";
    EXPECT_EQ(sound(behind), 1.0f);
    EXPECT_EQ(sound.map->fault(), "");
    EXPECT_EQ(map_of(row, {{"fault", "none"}})(behind), 1.0f) << "and none that comes later";
}

TEST(Isolated, AnEndlessLoopFailsItsMapInTime) {
    const Technique row = isolated(SHADOWBENCH_FAULTY, 0.8);
    const HandMap looping = map_of(row, {{"fault", "loop"}});
    EXPECT_TRUE(std::isnan(looping(behind)));
    EXPECT_EQ(looping.map->fault(), "lookup() did not answer within 0.8 s");
    EXPECT_EQ(map_of(row, {{"fault", "none"}})(behind), 1.0f);
}

TEST(Isolated, FaultsComeWithTheirReasons) {
    const Technique row = isolated(SHADOWBENCH_FAULTY);
    const auto refusal = [&](const char* fault) {
        return test::error_of([&] { map_of(row, {{"fault", fault}}); }, base::ErrorCode::internal, SHADOWBENCH_FAULTY);
    };
    EXPECT_EQ(refusal("create"), "technique faulty: create() failed: line one line two");
    EXPECT_EQ(refusal("throw"), "technique faulty: add() threw an exception: over the border");
    EXPECT_THAT(refusal("nodes"), HasSubstr("nodes() of cell (0, 0) returned 4000000000"));
    EXPECT_EQ(map_of(row, {{"fault", "print"}})(behind), 1.0f) << "what a library prints is not an answer";
    const HandMap few = map_of(row, {{"fault", "few"}});
    EXPECT_TRUE(std::isnan(few(behind)));
}

// Else a map could take the memory of the whole machine.
TEST(Isolated, AMapBeyondItsMemoryFails) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "sanitizers reserve terabytes, so there is no limit";
#endif
    const std::size_t gib = std::size_t{1} << 30;
    const Technique row = row_of(open_isolated(SHADOWBENCH_FAULTY, {SHADOWBENCH_PROGRAM, 60.0, gib}));
    EXPECT_THAT(test::error_of(
                    [&] {
                        map_of(row, {{"fault", "greedy"}});
                    },
                    base::ErrorCode::internal, SHADOWBENCH_FAULTY),
                HasSubstr("finish() threw an exception: std::bad_alloc"));
    EXPECT_EQ(map_of(row, {{"fault", "none"}})(behind), 1.0f);
}

// Else answers of the new file would be reported as those of the old one.
TEST(Isolated, AFileThatChangesAfterItWasLoadedFails) {
    const TemporaryFolder folder;
    const std::filesystem::path file = folder.path() / "libchanging.so", next = folder.path() / "next";
    std::filesystem::copy_file(SHADOWBENCH_FAULTY, file);
    const Technique row = isolated(file.c_str());
    const HandMap first = map_of(row, {{"fault", "none"}});  // which has the process that described the library
    std::filesystem::copy_file(SHADOWBENCH_STAIRS, next);
    std::filesystem::rename(next, file);
    test::error_of([&] { map_of(row, {{"fault", "none"}}); }, base::ErrorCode::internal, file.string());
    EXPECT_EQ(first(behind), 1.0f);
}

TEST(Isolated, ALibraryThatCannotBeOpenedIsRefused) {
    const auto refusal = [](const char* fault, double seconds = 60.0) {
        ::setenv("SHADOWBENCH_TEST_FAULT", fault, 1);
        const std::string message = test::error_of([&] { isolated(SHADOWBENCH_FAULTY, seconds); },
                                                   base::ErrorCode::internal, SHADOWBENCH_FAULTY);
        ::unsetenv("SHADOWBENCH_TEST_FAULT");
        return message;
    };
    EXPECT_THAT(refusal("abi"), HasSubstr("made for version 7 of shadowbench_technique.h"));
    EXPECT_THAT(refusal("crash"), HasSubstr("shadowbench_techniques() ended its process"));
    EXPECT_THAT(refusal("hang", 0.3), HasSubstr("shadowbench_techniques() did not answer within"));
}

}  // namespace
}  // namespace shadowbench::service
