// Injected faults reach the right kernels with the right size, and no others.
#include <gtest/gtest.h>

#include <stdexcept>

#include <benchmark/benchmark.h>

#include "kernels/exact.h"
#include "kernels/inject.h"
#include "kernels/measure.h"
#include "kernels/runner.h"
#include "kernels/test/program.h"
#include "temporary_folder.h"

namespace shadowbench::kernels {
namespace {

using nlohmann::json;

Kernel counting(const std::string& name, int& passes_made) {
    return {name, [&passes_made] {
                Subject subject;
                subject.exact = {100.0, 10.0, 0.25, {}};
                subject.pass = [&passes_made] { ++passes_made; };
                return subject;
            }};
}

// Keeps what Google Benchmark reports.
struct Reports : benchmark::BenchmarkReporter {
    std::vector<Run> runs;
    bool ReportContext(const Context&) override { return true; }
    void ReportRuns(const std::vector<Run>& reported) override {
        runs.insert(runs.end(), reported.begin(), reported.end());
    }
};

// Runs the kernels for a short time.
Reports run(const Kernels& kernels, const std::vector<Injection>& injections, bool& wrong) {
    std::string program = "kernels", time = "--benchmark_min_time=0.001";
    char* argv[] = {program.data(), time.data(), nullptr};
    int argc = 2;
    benchmark::Initialize(&argc, argv);
    benchmark::ClearRegisteredBenchmarks();
    const Runner runner(kernels, injections);
    Reports reports;
    benchmark::RunSpecifiedBenchmarks(&reports);
    benchmark::ClearRegisteredBenchmarks();
    wrong = runner.wrong();
    return reports;
}

// Counts the passes of a kernel in this number of iterations.
int passes_in(int iterations, double slow) {
    int passes_made = 0;
    const Kernel kernel = counting("k", passes_made);
    const Subject subject = kernel.prepare();
    Faults faults;
    faults.slow = slow;
    benchmark::ClearRegisteredBenchmarks();
    benchmark::RegisterBenchmark("k", [&](benchmark::State& state) {
        measure(state, "k", subject, faults);
    })->Iterations(iterations);
    Reports reports;
    benchmark::RunSpecifiedBenchmarks(&reports, std::string("."));
    benchmark::ClearRegisteredBenchmarks();
    return passes_made;
}

TEST(Inject, ASlowKernelMakesSoManyMorePasses) {
    EXPECT_EQ(passes_in(1, 0.0), passes);
    EXPECT_EQ(passes_in(1, 0.1), passes + passes / 10) << "in every single iteration";
    EXPECT_EQ(passes_in(7, 0.1), 7 * (passes + passes / 10));
    EXPECT_EQ(passes_in(100, 0.0), 100 * passes);
    EXPECT_EQ(passes_in(100, 0.025), 100 * passes + 25) << "a smaller share over several iterations";
}

TEST(Inject, FaultsAddUpAndMissOtherKernels) {
    const std::vector<Injection> injections{read_injection("node:compress/hair:1"), read_injection("byte:compress:2"),
                                            read_injection("error:tolerance:0.02$:1e-3"), read_injection("slow:x:0.1")};
    EXPECT_EQ(injections[2].amount, 1e-3) << "the expression may contain colons";
    const Faults hit = faults_of("compress/hair/tolerance:0.02", injections);
    EXPECT_EQ(hit.nodes, 1.0);
    EXPECT_EQ(hit.bytes, 2.0);
    EXPECT_EQ(hit.error, 1e-3);
    EXPECT_EQ(hit.slow, 0.0);
    const Faults missed = faults_of("build/deep", injections);
    EXPECT_EQ(missed.nodes + missed.bytes + missed.error + missed.slow, 0.0);
}

TEST(Inject, AbsentCountsStayAbsent) {
    Faults faults;
    faults.nodes = faults.bytes = faults.error = 1.0;
    const Exact exact = with({{}, 4.0, {}, 0.5}, faults);
    EXPECT_FALSE(exact.bytes || exact.error);
    EXPECT_EQ(exact.nodes, 5.0);
    EXPECT_EQ(exact.lookup_error, 1.5);
}

TEST(Inject, AWrongKernelIsNotTimedAndSaysWhy) {
    int passes_made = 0;
    const Kernels kernels{{"wrong", []() -> Subject { throw std::runtime_error("it is 3 too dark"); }},
                          counting("right", passes_made)};
    bool wrong = false;
    const Reports reports = run(kernels, {}, wrong);
    EXPECT_TRUE(wrong);
    ASSERT_EQ(reports.runs.size(), 2u);
    EXPECT_TRUE(reports.runs[0].error_occurred);
    EXPECT_EQ(reports.runs[0].error_message, "it is 3 too dark");
    EXPECT_FALSE(reports.runs[1].error_occurred);
    EXPECT_GT(passes_made, 0);

    const TemporaryFolder folder;
    EXPECT_EQ(write_exact(kernels, "", {}, folder.path("exact.json")), 1u);
    const json entries = testing::read_json(folder.path("exact.json")).at("benchmarks");
    EXPECT_EQ(entries[0].at("error_message"), "it is 3 too dark");
    EXPECT_FALSE(entries[0].contains("bytes"));
    EXPECT_EQ(entries[1].at("bytes"), 100.0);
}

TEST(Inject, AFilterWithoutMatchesWritesNothing) {
    const TemporaryFolder folder;
    for (const auto& [filter, says] : {std::pair{"nothing", "no kernel has such a name"}, {"(", "is not valid"}}) {
        const testing::Outcome outcome =
            testing::run(std::string("--benchmark_filter='") + filter + "' --exact=" + folder.path("exact.json"));
        EXPECT_EQ(outcome.code, 64);
        EXPECT_NE(outcome.said.find(says), std::string::npos) << outcome.said;
        EXPECT_FALSE(std::filesystem::exists(folder.path("exact.json")));
    }
}

TEST(Inject, TheProgramChangesOnlyTheNamedCounts) {
    const TemporaryFolder folder;
    const std::string filter = "--benchmark_filter='^compress/hair|^reference' ";
    ASSERT_EQ(testing::run(filter + "--exact=" + folder.path("a.json")).code, 0);
    ASSERT_EQ(testing::run(filter + "--exact=" + folder.path("b.json") +
                           " --inject=node:compress/hair/tolerance:0.02:1 --inject=byte:compress/hair/tolerance:0.1:1"
                           " --inject=error:compress/hair/tolerance:0.002:1e-3")
                  .code,
              0);
    const json a = testing::read_json(folder.path("a.json")).at("benchmarks");
    json b = testing::read_json(folder.path("b.json")).at("benchmarks");
    ASSERT_EQ(a.size(), 5u);
    EXPECT_NE(a, b);
    for (json& entry : b) {
        if (entry.at("name") == "compress/hair/tolerance:0.02") entry["nodes"] = entry["nodes"].get<double>() - 1.0;
        if (entry.at("name") == "compress/hair/tolerance:0.1") entry["bytes"] = entry["bytes"].get<double>() - 1.0;
        if (entry.at("name") != "compress/hair/tolerance:0.002") continue;
        const double error = a[2].at("error").get<double>();
        EXPECT_DOUBLE_EQ(entry["error"].get<double>(), error + 1e-3);
        entry["error"] = error;
    }
    EXPECT_EQ(a, b);
}

}  // namespace
}  // namespace shadowbench::kernels
