// Faults put into results are found, each with the right code and name; noise is not.
#include <gtest/gtest.h>

#include "compare/compare.h"
#include "compare/made.h"

namespace shadowbench::compare {
namespace {

using nlohmann::json;

Comparison compared(const json& baseline, const json& current, const Options& options = {}) {
    return compare(side({baseline}), side({current}), options);
}

TEST(Injection, EqualResultsAreTheSame) {
    const Comparison comparison = compared(made_result(), made_result());
    EXPECT_EQ(exit_code(comparison), 0);
    EXPECT_TRUE(comparison.fronts.empty());
    for (const Line& result : comparison.lines)
        EXPECT_TRUE(result.verdict == Verdict::same || result.verdict == Verdict::inconclusive) << title_of(result);
}

TEST(Injection, OneByteIsLarger) {
    json current = made_result();
    cell_of(current, 0)["bytes"] = 1001;
    const Comparison comparison = compared(made_result(), current);
    EXPECT_EQ(exit_code(comparison), 2);
    EXPECT_EQ(line(comparison, "deep", "bytes").verdict, Verdict::larger);
    EXPECT_EQ(title_of(line(comparison, "deep", "bytes")), "made / key / deep tolerance=0.02");
    EXPECT_EQ(line(comparison, "uncompressed", "bytes").verdict, Verdict::same);
}

TEST(Injection, OneNodeIsLarger) {
    for (const char* measure : {"total", "max"}) {
        json current = made_result();
        json& nodes = cell_of(current, 1)["nodes"][measure];
        nodes = nodes.get<int>() + 1;
        const Comparison comparison = compared(made_result(), current);
        EXPECT_EQ(exit_code(comparison), 2);
        EXPECT_EQ(line(comparison, "uncompressed", std::string("nodes.") + measure).verdict, Verdict::larger);
        EXPECT_EQ(line(comparison, "uncompressed", std::string("nodes.") + measure).reason.substr(0, 2), "+1");
    }
}

TEST(Injection, AThousandthOfErrorIsLessAccurate) {
    for (const char* which : {"curve_error", "lookup_error"})
        for (const char* norm : {"max", "rms", "mean", "p99"}) {
            json current = made_result();
            json& error = cell_of(current, 0)[which][norm];
            error = error.get<double>() + 1e-3;
            const Comparison comparison = compared(made_result(), current);
            EXPECT_EQ(exit_code(comparison), 2);
            const std::string measure = std::string(which) + "." + norm;
            EXPECT_EQ(line(comparison, "deep", measure).verdict, Verdict::less_accurate) << measure;
        }
}

TEST(Injection, ImprovementsAreNamedAndDoNotFail) {
    json current = made_result();
    cell_of(current, 0)["bytes"] = 999;
    cell_of(current, 0)["lookup_error"]["rms"] = 0.04;
    const Comparison comparison = compared(made_result(), current);
    EXPECT_EQ(exit_code(comparison), 0);
    EXPECT_EQ(line(comparison, "deep", "bytes").verdict, Verdict::smaller);
    EXPECT_EQ(line(comparison, "deep", "lookup_error.rms").verdict, Verdict::more_accurate);
}

TEST(Injection, ABrokenPromiseIsLessAccurate) {
    json failed = made_result();
    cell_of(failed, 0)["status"] = "failed";
    cell_of(failed, 0)["reason"] = "not monotone";
    cell_of(failed, 0)["times"] = nullptr;
    Comparison comparison = compared(made_result(), failed);
    EXPECT_EQ(exit_code(comparison), 2);
    EXPECT_EQ(line(comparison, "deep", "promises").verdict, Verdict::less_accurate);
    EXPECT_NE(line(comparison, "deep", "promises").reason.find("not monotone"), std::string::npos);
    comparison = compared(failed, made_result());
    EXPECT_EQ(exit_code(comparison), 0);
    EXPECT_EQ(line(comparison, "deep", "promises").verdict, Verdict::more_accurate);
    json degraded = made_result();
    cell_of(degraded, 0)["verdict"] = "degraded";
    EXPECT_EQ(exit_code(compared(made_result(), degraded)), 2);
}

// In a result, null stands for an error that is not finite.
TEST(Injection, AnErrorThatIsNotFiniteIsLessAccurate) {
    json current = made_result();
    cell_of(current, 0)["lookup_error"]["max"] = nullptr;
    const Comparison comparison = compared(made_result(), current);
    EXPECT_EQ(line(comparison, "deep", "lookup_error.max").verdict, Verdict::less_accurate);
    EXPECT_EQ(exit_code(comparison), 2);
    EXPECT_EQ(exit_code(compared(current, current)), 0);
}

TEST(Injection, AToleranceAppliesToTheMeasureItNames) {
    json current = made_result();
    cell_of(current, 0)["lookup_error"]["rms"] = 0.0504;
    Options options;
    options.tolerance["lookup_error.rms"] = 0.01;
    EXPECT_EQ(exit_code(compared(made_result(), current, options)), 0);
    cell_of(current, 0)["bytes"] = 1001;
    EXPECT_EQ(exit_code(compared(made_result(), current, options)), 2);
    // The default tolerance allows for the last digits of sums in another order.
    current = made_result();
    cell_of(current, 0)["lookup_error"]["rms"] = 0.05 * (1.0 + 1e-9);
    EXPECT_EQ(exit_code(compared(made_result(), current)), 0);
}

TEST(Injection, AnErrorThatWasZeroIsLessAccurate) {
    json baseline = made_result();
    for (const char* norm : {"max", "rms", "mean", "p99"}) cell_of(baseline, 1)["curve_error"][norm] = 0;
    json current = baseline;
    cell_of(current, 1)["curve_error"]["max"] = 1e-13;
    EXPECT_EQ(exit_code(compared(baseline, current)), 0);
    cell_of(current, 1)["curve_error"]["max"] = 1e-9;
    EXPECT_EQ(exit_code(compared(baseline, current)), 2);
}

// --- times -----------------------------------------------------------------------------------------------------------

// Processes of two sides on one noisy machine. `turns`: interleaved and judged in pairs; otherwise one block after the
// other.
Comparison measured(std::uint64_t seed, std::size_t processes, bool turns, double factor, double slow = 0.05) {
    Noise noise(seed, slow);
    std::vector<json> a(processes, made_result()), b(processes, made_result());
    if (turns)
        for (std::size_t i = 0; i < processes; ++i) {
            // A B, B A: neither side always goes first.
            if (i % 2 == 0) make_times(a[i], noise);
            make_times(b[i], noise, 0, factor);
            if (i % 2 == 1) make_times(a[i], noise);
        }
    else {
        for (json& result : a) make_times(result, noise);
        for (json& result : b) make_times(result, noise, 0, factor);
    }
    const char* const mark = turns ? "ab" : "";
    return compare(side(a, mark), side(b, mark), {});
}

int alarms(bool turns, std::size_t processes, int rounds, double slow = 0.05) {
    int count = 0;
    for (int seed = 1; seed <= rounds; ++seed) count += exit_code(measured(seed, processes, turns, 1.0, slow)) != 0;
    return count;
}

// Counts how often a time of the cell slowed by `factor` is called slower. The other cell never may be.
int finds(bool turns, std::size_t processes, int rounds, double factor) {
    int count = 0;
    for (int seed = 1; seed <= rounds; ++seed) {
        const Comparison comparison = measured(1000 + seed, processes, turns, factor);
        count += line(comparison, "deep", "lookup_random").verdict == Verdict::slower;
        EXPECT_NE(line(comparison, "uncompressed", "lookup_random").verdict, Verdict::slower) << seed;
    }
    return count;
}

TEST(Injection, TenPercentSlowerIsSlowerInTurns) {
    const Comparison comparison = measured(1, 20, true, 1.10);
    EXPECT_EQ(exit_code(comparison), 1);
    for (const char* measure : {"build", "lookup_image", "lookup_random"}) {
        EXPECT_EQ(line(comparison, "deep", measure).verdict, Verdict::slower) << measure;
        EXPECT_NE(line(comparison, "uncompressed", measure).verdict, Verdict::slower) << measure;
    }
    EXPECT_EQ(exit_code(measured(1, 20, true, 1.0 / 1.10)), 0);
    EXPECT_EQ(line(measured(1, 20, true, 1.0 / 1.10), "deep", "build").verdict, Verdict::faster);
}

TEST(Injection, LargerWinsOverSlower) {
    std::vector<json> a(20, made_result()), b(20, made_result());
    Noise noise(1);
    for (std::size_t i = 0; i < a.size(); ++i) {
        make_times(a[i], noise);
        make_times(b[i], noise, 0, 1.2);
        cell_of(b[i], 0)["bytes"] = 1001;
    }
    EXPECT_EQ(exit_code(compare(side(a, "ab"), side(b, "ab"), {})), 2);
}

TEST(Injection, EqualBuildsRaiseNoAlarmInTurns) {
    EXPECT_EQ(alarms(true, 20, 40), 0);
    EXPECT_EQ(alarms(true, 20, 20, 0.10), 0);
}

TEST(Injection, EqualBuildsRaiseNoAlarmApart) {
    EXPECT_EQ(alarms(false, 10, 40), 0);
}

// Slowdowns up to the minimum effect do not count; clearly larger ones are found.
TEST(Injection, SlowdownsAreFoundBeyondTheMinimumEffect) {
    EXPECT_EQ(finds(true, 20, 20, 1.03), 0);
    EXPECT_LE(finds(true, 20, 20, 1.05), 1);
    EXPECT_GE(finds(true, 20, 20, 1.10), 19);
    EXPECT_EQ(finds(false, 10, 20, 1.05), 0);
    EXPECT_GE(finds(false, 10, 20, 1.20), 19);
}

// Another tenant on the same core: one whole block is slower, also over the floor.
TEST(Injection, AnotherStateOfTheMachineIsNotSlower) {
    std::vector<json> a(10, made_result()), b(10, made_result());
    Noise noise(1);
    for (json& result : a) make_times(result, noise);
    for (json& result : b) {
        make_times(result, noise, 0, 1.5);
        result["variants"][0]["lights"][0]["capture"]["embree_check"]["times"]["embree_rays_per_second"] = 1.4e6;
    }
    Comparison comparison = compare(side(a), side(b), {});
    EXPECT_EQ(exit_code(comparison), 0);
    EXPECT_EQ(line(comparison, "deep", "build").verdict, Verdict::inconclusive);
    EXPECT_TRUE(line(comparison, "deep", "build").suspicious);  // --confirm runs it again
    EXPECT_NE(line(comparison, "deep", "build").reason.find("Embree"), std::string::npos);
}

}  // namespace
}  // namespace shadowbench::compare
