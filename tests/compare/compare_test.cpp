#include "compare/compare.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "compare/made.h"
#include "compare/report.h"

namespace shadowbench::compare {
namespace {

using nlohmann::json;

TEST(Compare, AnotherScenarioIsNotComparable) {
    json current = made_result();
    current["scenario_hash"] = "ffff";
    current["variants"][0]["lights"][0]["map"]["seed"] = 2;
    const Comparison comparison = compare(side({made_result()}), side({current}), {});
    ASSERT_EQ(comparison.lines.size(), 1u);
    EXPECT_EQ(comparison.lines[0].verdict, Verdict::not_comparable);
    EXPECT_NE(comparison.lines[0].reason.find("seed 1 against 2"), std::string::npos) << comparison.lines[0].reason;
    EXPECT_EQ(exit_code(comparison), 2);  // otherwise a changed scenario would open the gate
    Options options;
    options.allow_missing = true;
    EXPECT_EQ(exit_code(compare(side({made_result()}), side({current}), options)), 0);
}

TEST(Compare, AnotherVersionOfATechniqueIsNotComparable) {
    json current = made_result();
    cell_of(current, 0)["version"] = 4;
    const Comparison comparison = compare(side({made_result()}), side({current}), {});
    EXPECT_EQ(line(comparison, "deep", "").verdict, Verdict::not_comparable);
    EXPECT_EQ(line(comparison, "uncompressed", "bytes").verdict, Verdict::same);
    EXPECT_EQ(exit_code(comparison), 2);
}

TEST(Compare, AnotherMachineComparesOnlyExactMeasures) {
    json current = made_result();
    current["machine"]["cpu"] = "another";
    Comparison comparison = compare(side({made_result()}), side({current}), {});
    EXPECT_EQ(exit_code(comparison), 0);
    EXPECT_EQ(line(comparison, "", "times").verdict, Verdict::not_comparable);
    EXPECT_EQ(line(comparison, "deep", "bytes").verdict, Verdict::same);
    cell_of(current, 0)["bytes"] = 1001;
    EXPECT_EQ(exit_code(compare(side({made_result()}), side({current}), {})), 2);
}

// Which machine measured a cell differs between two merged results, even of the same machines.
TEST(Compare, ResultsMergedFromSeveralMachinesCompareOnlyExactMeasures) {
    json merged = made_result();
    for (const char* node : {"n1", "n2"})
        merged["times"]["cells"].push_back({{"node", node}, {"machine", merged["machine"]}});
    json later = merged;
    later["times"]["started"] = "2026-11-26T02:00:00Z";
    for (const json& baseline : {merged, made_result()}) {
        const Comparison comparison = compare(side({baseline}), side({later}), {});
        EXPECT_EQ(line(comparison, "", "times").verdict, Verdict::not_comparable);
        EXPECT_EQ(line(comparison, "deep", "bytes").verdict, Verdict::same);
    }
    merged["times"]["cells"].erase(1);
    later["times"]["cells"].erase(1);
    EXPECT_EQ(line(compare(side({merged}), side({later}), {}), "deep", "bytes").verdict, Verdict::same);
    EXPECT_EQ(side({merged}).suites[0].machine, "AMD EPYC, 2 cores") << "all cells of one machine";
}

TEST(Compare, MissingCellsFailAndExtraOnesAreListed) {
    json fewer = made_result();
    fewer["variants"][0]["lights"][0]["cells"].erase(1);
    fewer["only"] = {"deep"};
    Options options;
    Comparison comparison = compare(side({made_result()}), side({fewer}), options);
    EXPECT_EQ(exit_code(comparison), 2);
    EXPECT_EQ(line(comparison, "uncompressed", "").verdict, Verdict::missing);
    EXPECT_NE(line(comparison, "uncompressed", "").reason.find("limited to deep"), std::string::npos);
    fewer["only"] = {"deep", "uncompressed"};
    EXPECT_EQ(line(compare(side({made_result()}), side({fewer}), {}), "uncompressed", "").reason, "the current result lacks this cell");
    options.allow_missing = true;
    EXPECT_EQ(exit_code(compare(side({made_result()}), side({fewer}), options)), 0);
    comparison = compare(side({fewer}), side({made_result()}), {});
    EXPECT_EQ(exit_code(comparison), 0);
    EXPECT_EQ(line(comparison, "uncompressed", "").verdict, Verdict::extra);
}

TEST(Compare, MissingMeasuresFailToo) {
    json current = made_result();
    cell_of(current, 0)["curve_error"] = nullptr;
    EXPECT_EQ(exit_code(compare(side({made_result()}), side({current}), {})), 2);
    current = made_result();
    cell_of(current, 0)["times"] = nullptr;
    EXPECT_EQ(exit_code(compare(side({made_result()}), side({current}), {})), 2);
}

TEST(Compare, MissingScenariosFail) {
    json other = made_result();
    other["name"] = "other";
    const Comparison comparison = compare(side({made_result(), other}), side({made_result()}), {});
    EXPECT_EQ(exit_code(comparison), 2);
    EXPECT_EQ(title_of(comparison.lines.back()), "other");
}

// Two settings of one scenario are distinguished by their hashes.
TEST(Compare, ScenariosOfOneNameMatchByHash) {
    json other = made_result();
    other["scenario_hash"] = "ffffffffffffffff";
    cell_of(other, 0)["bytes"] = 7;
    const Comparison comparison = compare(side({made_result(), other}), side({other, made_result()}), {});
    EXPECT_EQ(exit_code(comparison), 0);
    EXPECT_EQ(comparison.lines[0].suite, "made [00112233]");
}

TEST(Compare, KernelsCompareLikeCells) {
    json current = made_kernels();
    for (json& run : current["benchmarks"])
        if (run["name"] == "sweep(x)/8") run["nodes"] = 33;
    const Comparison comparison = compare(side({made_kernels()}), side({current}), {});
    EXPECT_EQ(exit_code(comparison), 2);
    EXPECT_EQ(line(comparison, "sweep", "nodes").verdict, Verdict::larger);
    EXPECT_EQ(line(comparison, "compress", "nodes").verdict, Verdict::same);
}

TEST(Compare, MoreInstructionsAreSlower) {
    json baseline = made_kernels(), current = made_kernels();
    for (json& run : baseline["benchmarks"]) run["instructions"] = 1000000;
    for (json& run : current["benchmarks"]) run["instructions"] = 1000100;
    EXPECT_EQ(exit_code(compare(side({baseline}), side({current}), {})), 0);
    for (json& run : current["benchmarks"]) run["instructions"] = 1100000;
    EXPECT_EQ(exit_code(compare(side({baseline}), side({current}), {})), 1);
}

// The state of a process lasts: its repetitions are not independent observations.
TEST(Compare, FewProcessesDecideNothing) {
    json slower = made_result();
    for (const char* order : {"lookup_image_order", "lookup_random_order"})
        for (json& value : cell_of(slower, 0)["times"][order]["ratio_to_floor"]["raw"])
            value = 2.0 * value.get<double>();
    const Comparison comparison = compare(side({made_result()}), side({slower}), {});
    EXPECT_EQ(exit_code(comparison), 0);
    EXPECT_EQ(line(comparison, "deep", "lookup_image").verdict, Verdict::inconclusive);
    EXPECT_TRUE(line(comparison, "deep", "lookup_image").suspicious);
    EXPECT_EQ(suspicious(comparison).size(), 2u);
    EXPECT_NE(line(comparison, "deep", "lookup_image").reason.find("looks slower, but fewer than 4"),
              std::string::npos);
}

TEST(Compare, ATimeOfZeroIsNotComparable) {
    json zero = made_result();
    cell_of(zero, 0)["times"]["lookup_image_order"]["ratio_to_floor"]["raw"] = {0, 0, 0};
    const Comparison comparison = compare(side({zero}), side({zero}), {});
    EXPECT_EQ(line(comparison, "deep", "lookup_image").verdict, Verdict::not_comparable);
    EXPECT_EQ(exit_code(comparison), 0);
}

TEST(Compare, BuildsTooShortForTheClockAreNotJudged) {
    json a = made_result(), b = made_result();
    cell_of(a, 0)["times"]["build_ms"]["raw"] = {0.002, 0.002};
    cell_of(b, 0)["times"]["build_ms"]["raw"] = {0.004, 0.004};
    EXPECT_EQ(line(compare(side({a}), side({b}), {}), "deep", "build").verdict, Verdict::same);
}

// A change that reads fewer lines lowers the floor too: relative to it the same lookup looks slower.
TEST(Compare, AChangedFloorIsNotSlower) {
    std::vector<json> a(10, made_result()), b(10, made_result());
    Noise noise(1);
    for (std::size_t i = 0; i < a.size(); ++i) {
        make_times(a[i], noise);
        make_times(b[i], noise);
        json& lookup = cell_of(b[i], 0)["times"]["lookup_random_order"];
        for (json& value : lookup["ratio_to_floor"]["raw"]) value = 1.5 * value.get<double>();
        for (json& value : lookup["ns"]["raw"]) value = 0.8 * value.get<double>();
    }
    const Comparison comparison = compare(side(a), side(b), {});
    EXPECT_EQ(line(comparison, "deep", "lookup_random").verdict, Verdict::inconclusive);
    EXPECT_NE(line(comparison, "deep", "lookup_random").reason.find("the floor changed"), std::string::npos);
}

// Among many cells one is likely to look slower by chance, so that few processes cannot show it.
TEST(Compare, ASlowdownThatMayBeChanceAmongManyIsInconclusive) {
    json many = made_result();
    json& cells = many["variants"][0]["lights"][0]["cells"];
    for (int i = 0; i < 20; ++i) {
        cells.push_back(cells[0]);
        cells.back()["label"] = "tolerance=" + std::to_string(i);
    }
    std::vector<json> a(5, many), b(5, many);
    Noise noise(1);
    for (json& result : a) make_times(result, noise);
    for (json& result : b) make_times(result, noise, 0, 1.5);
    const Comparison comparison = compare(side(a), side(b), {});
    EXPECT_EQ(comparison.judged_times, 66u);
    EXPECT_EQ(line(comparison, "deep", "lookup_random").verdict, Verdict::inconclusive);
    EXPECT_TRUE(line(comparison, "deep", "lookup_random").suspicious);
    EXPECT_NE(line(comparison, "deep", "lookup_random").reason.find("beyond chance among 66"), std::string::npos);
}

TEST(Compare, ASecondLookDecides) {
    const auto looked = [](std::uint64_t seed, double factor) {
        std::vector<json> a(20, made_result()), b(20, made_result());
        Noise noise(seed);
        for (std::size_t i = 0; i < a.size(); ++i) {
            make_times(a[i], noise);
            make_times(b[i], noise, 0, factor);
        }
        return compare(side(a, "ab"), side(b, "ab"), {});
    };
    Comparison first = looked(1, 1.2);
    confirm(first, looked(2, 1.2));
    EXPECT_EQ(exit_code(first), 1);
    EXPECT_EQ(line(first, "deep", "build").reason.rfind("confirmed by 20 fresh pairs", 0), 0u);
    first = looked(1, 1.2);
    confirm(first, looked(2, 1.0));
    EXPECT_EQ(exit_code(first), 0);
    EXPECT_EQ(line(first, "deep", "build").verdict, Verdict::inconclusive);
    EXPECT_EQ(line(first, "deep", "build").reason.rfind("looked slower, not confirmed by", 0), 0u);
    EXPECT_TRUE(suspicious(first).empty());
    // A time that was not run again keeps its verdict.
    first = looked(1, 1.2);
    confirm(first, Comparison());
    EXPECT_EQ(exit_code(first), 1);
}

// A cell that runs alone is not swept, so its name lacks the swept values.
TEST(Compare, ASecondLookFindsACellOfASweepByItsTechnique) {
    const auto looked = [](std::uint64_t seed, bool swept) {
        std::vector<json> a(20, made_result()), b(20, made_result());
        Noise noise(seed);
        for (std::vector<json>* side : {&a, &b})
            for (json& result : *side) {
                cell_of(result, 0)["label"] = "";
                if (swept) result["scenario"]["sweeps"] = {{"/techniques/0/tolerance", {0.02, 0.1}}};
            }
        for (std::size_t i = 0; i < a.size(); ++i) {
            make_times(a[i], noise);
            make_times(b[i], noise, 0, 1.2);
        }
        return compare(side(a, "ab"), side(b, "ab"), {});
    };
    Comparison first = looked(1, true);
    ASSERT_EQ(line(first, "deep", "build").cell, "deep tolerance=0.02");
    confirm(first, looked(2, false));
    EXPECT_EQ(line(first, "deep", "build").reason.rfind("confirmed by 20 fresh pairs", 0), 0u);
    EXPECT_EQ(line(first, "deep", "build").cell, "deep tolerance=0.02") << "it keeps its name";
}

// --- fronts ----------------------------------------------------------------------------------------------------------

TEST(Fronts, ACellThatLeavesIsNamedWithTheCellThatBeatsIt) {
    json current = made_result();
    cell_of(current, 1)["bytes"] = 900;  // uncompressed: smaller than deep now, and more accurate
    const Comparison comparison = compare(side({made_result()}), side({current}), {});
    ASSERT_EQ(comparison.fronts.size(), 1u);
    EXPECT_EQ(comparison.fronts[0].cell, "deep tolerance=0.02");
    EXPECT_EQ(comparison.fronts[0].front, "bytes and error");
    EXPECT_FALSE(comparison.fronts[0].joined);
    EXPECT_EQ(comparison.fronts[0].by, std::vector<std::string>{"uncompressed"});
    const Comparison back = compare(side({current}), side({made_result()}), {});
    ASSERT_EQ(back.fronts.size(), 1u);
    EXPECT_TRUE(back.fronts[0].joined);
    EXPECT_EQ(back.fronts[0].by, std::vector<std::string>{"uncompressed"});
}

TEST(Fronts, ANewTechniqueBeatsAnOldOne) {
    json current = made_result();
    json better = cell_of(current, 0);
    better["label"] = "tolerance=0.01";
    better["parameters"]["tolerance"] = 0.01;
    better["bytes"] = 500;
    for (json& value : better["times"]["lookup_random_order"]["ns"]["raw"]) value = 1.0;
    current["variants"][0]["lights"][0]["cells"].push_back(better);
    const Comparison comparison = compare(side({made_result()}), side({current}), {});
    EXPECT_EQ(comparison.fronts.size(), 4u);  // one joins and one leaves, of both fronts
    for (const FrontChange& change : comparison.fronts)
        EXPECT_EQ(change.joined, change.cell == "deep tolerance=0.01") << change.cell;
}

TEST(Fronts, AChangeThatItsIntervalsLeaveOpenIsPerhapsOne) {
    json current = made_result();
    cell_of(current, 1)["bytes"] = 900;  // uncompressed: smaller than deep now, and more accurate
    cell_of(current, 1)["on_bytes_error_front"] = "certainly";
    const auto marked = [&](const char* mark) {
        cell_of(current, 0)["on_bytes_error_front"] = mark;
        return compare(side({made_result()}), side({current}), {});
    };
    const Comparison sure = marked("no"), open = marked("perhaps");
    ASSERT_EQ(sure.fronts.size(), 1u);
    EXPECT_FALSE(sure.fronts[0].perhaps);
    ASSERT_EQ(open.fronts.size(), 1u);
    EXPECT_TRUE(open.fronts[0].perhaps);
    EXPECT_NE(to_text(open, false).find("perhaps left the front of bytes and error"), std::string::npos);
    EXPECT_TRUE(to_json(open)["fronts"][0]["perhaps"].get<bool>());
    EXPECT_TRUE(marked("certainly").fronts.empty()) << "its intervals say that nothing beats it";
}

// Times that did not provably change do not move the front.
TEST(Fronts, NoiseDoesNotMoveThem) {
    json current = made_result();
    for (json& value : cell_of(current, 0)["times"]["lookup_random_order"]["ns"]["raw"]) value = 1000.0;
    EXPECT_TRUE(compare(side({made_result()}), side({current}), {}).fronts.empty());
}

}  // namespace
}  // namespace shadowbench::compare
