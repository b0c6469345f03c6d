// Where a comparison cannot decide, it says so, and does not look as if all were well.
#include <gtest/gtest.h>

#include "compare/compare.h"
#include "compare/made.h"
#include "compare/report.h"
#include "compare/words.h"

namespace shadowbench::compare {
namespace {

using nlohmann::json;

// Sides without any noise, whose second cell is the same on both.
struct Sides {
    std::vector<json> a, b;
    explicit Sides(std::size_t processes) : a(processes, made_result()), b(processes, made_result()) {}

    void slow(const char* measure, double factor) {
        for (json& result : b)
            for (const char* order : {"lookup_image_order", "lookup_random_order"})
                for (json& value : cell_of(result, 0)["times"][order][measure]["raw"])
                    value = factor * value.get<double>();
    }
    void slow_embree(double factor) {
        for (json& result : b) {
            json& light = result["variants"][0]["lights"][0];
            light["capture"]["embree_check"]["times"]["embree_rays_per_second"] = 2e6 / factor;
        }
    }
    Comparison compared(const std::string& mark = "") const { return compare(side(a, mark), side(b, mark), {}); }
};

bool says(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

// 6 pairs of 6 times: for each time, all pairs are slower by chance with a probability of 1 in 64.
TEST(Doubt, TooFewPairsSayHowManyAreNeeded) {
    Sides six(6), seven(7);
    six.slow("ns", 3.0);
    seven.slow("ns", 3.0);
    const Comparison few = six.compared("ab");
    EXPECT_EQ(few.judged_times, 6u);
    EXPECT_EQ(few.enough, 7u);
    EXPECT_EQ(exit_code(few), 0);
    EXPECT_TRUE(line(few, "deep", "lookup_image").suspicious);
    EXPECT_TRUE(says(line(few, "deep", "lookup_image").reason, "6 pairs can not show it"));
    EXPECT_TRUE(says(method(few), "6 times need 7 pairs")) << method(few);
    const std::string text = to_text(few, false);
    EXPECT_TRUE(says(text, "too few processes to call a time slower")) << text;
    EXPECT_FALSE(says(text, "smallest slowdown")) << "there is none";
    const Comparison enough = seven.compared("ab");
    EXPECT_EQ(enough.enough, 0u);
    EXPECT_EQ(exit_code(enough), 1);
}

TEST(Doubt, TooFewProcessesApartSayHowManyAreNeeded) {
    Sides four(4), five(5);
    four.slow("ratio_to_floor", 3.0);
    four.slow("ns", 3.0);
    five.slow("ratio_to_floor", 3.0);
    five.slow("ns", 3.0);
    EXPECT_EQ(four.compared().enough, 5u) << "6 times of 1 in (8 over 4) orders";
    EXPECT_EQ(exit_code(four.compared()), 0);
    EXPECT_EQ(five.compared().enough, 0u);
    EXPECT_EQ(exit_code(five.compared()), 1);
}

// A layout that reads three times the lines is three times as slow, and so is reading them.
TEST(Doubt, ASlowdownThatTheFloorSharesIsInconclusive) {
    Sides sides(10);
    sides.slow("ns", 3.0);
    const Comparison comparison = sides.compared();
    const Line& looked = line(comparison, "deep", "lookup_random");
    EXPECT_EQ(looked.verdict, Verdict::inconclusive);
    EXPECT_TRUE(looked.suspicious);
    EXPECT_TRUE(says(looked.reason, "its floor changed with it")) << looked.reason;
    EXPECT_EQ(line(comparison, "uncompressed", "lookup_random").verdict, Verdict::same);
    // A slowdown that the machine accounts for is not suspicious.
    sides.slow_embree(3.0);
    EXPECT_EQ(line(sides.compared(), "deep", "lookup_random").verdict, Verdict::same);
}

// Another tenant makes some code 1.8 times slower; no tenant makes it five times slower.
TEST(Doubt, AnotherStateOfTheMachineHidesNoLargeSlowdown) {
    for (const auto& [factor, verdict] : {std::pair{1.8, Verdict::inconclusive}, {5.0, Verdict::slower}}) {
        Sides sides(10);
        sides.slow("ns", factor);
        sides.slow("ratio_to_floor", factor);
        sides.slow_embree(1.2);
        EXPECT_EQ(line(sides.compared(), "deep", "lookup_random").verdict, verdict) << factor;
    }
}

TEST(Doubt, InstructionsOfAnotherMachineAreNotJudged) {
    json baseline = made_kernels(), current = made_kernels();
    for (json& run : baseline["benchmarks"]) run["instructions"] = 1000000;
    for (json& run : current["benchmarks"]) run["instructions"] = 1100000;
    EXPECT_EQ(exit_code(compare(side({baseline}), side({current}), {})), 1);
    current["context"]["host_name"] = "another";
    const Comparison comparison = compare(side({baseline}), side({current}), {});
    EXPECT_EQ(exit_code(comparison), 0);
    EXPECT_EQ(line(comparison, "compress", "instructions").verdict, Verdict::not_comparable);
    EXPECT_EQ(command_of(line(comparison, "compress", "instructions").rerun),
              "shadowbench instructions --kernels build/kernels --filter '^compress/smoke/64$' --out counts.json");
}

// Pairs are files of equal name; if one were missing, all later pairs would be shifted.
TEST(Doubt, SidesWithDifferentFilesAreNotPaired) {
    Sides sides(10);
    Measured a = side(sides.a, "ab"), b = side(sides.b, "ab");
    a.files = {"0001.json", "0002.json"};
    b.files = {"0002.json", "0003.json"};
    const Comparison comparison = compare(a, b, {});
    EXPECT_FALSE(comparison.interleaved);
    ASSERT_EQ(comparison.notes.size(), 1u);
    EXPECT_TRUE(says(comparison.notes[0], "not judged in pairs"));
}

TEST(Doubt, TooFewFreshPairsChangeNoVerdict) {
    Sides many(20), few(4);
    many.slow("ns", 3.0);
    few.slow("ns", 3.0);
    Comparison first = many.compared("ab");
    confirm(first, few.compared("ab"));
    EXPECT_EQ(exit_code(first), 1);
    EXPECT_TRUE(
        says(line(first, "deep", "lookup_image").reason, "4 fresh pairs are too few to confirm it: 7 are needed"));
}

TEST(Doubt, AllTimesOfAnotherMachineInOneFolderAreLeftOut) {
    json other = made_result();
    other["machine"]["cpu"] = "another";
    other["variants"][0]["lights"][0]["capture"]["embree_check"]["times"]["embree_rays_per_second"] = 1.0;
    json& cells = other["variants"][0]["lights"][0]["cells"];
    cells.push_back(cells[0]);
    cells.back()["label"] = "tolerance=0.5";
    const Measured measured = side({made_result(), other});
    ASSERT_EQ(measured.suites.size(), 1u);
    EXPECT_EQ(measured.suites[0].speed, std::vector<double>{2e6});
    ASSERT_EQ(measured.suites[0].cells.size(), 3u);
    EXPECT_TRUE(measured.suites[0].cells[2].timed.empty());
    EXPECT_FALSE(measured.suites[0].cells[2].exact.empty());
}

}  // namespace
}  // namespace shadowbench::compare
