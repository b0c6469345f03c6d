// sweep with GNU parallel, on this machine.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <string>

#include "processes.h"
#include "sweep/swept.h"

namespace shadowbench {
namespace {

using testing::HasSubstr;

class WithParallel : public Swept {
protected:
    WithParallel() : Swept(5) {}

    void SetUp() override {
        if (shell("command -v parallel >/dev/null") != 0) GTEST_SKIP() << "GNU parallel is missing";
    }
    int sweep(const std::string& more = "") const {
        return shell(program("sweep swept.json --out sweep --engine parallel --nodes 2 " + more, "sweep.log"));
    }
};

TEST_F(WithParallel, MeasuresAllPartsAndMergesThem) {
    ASSERT_EQ(sweep(), 0) << text("sweep.log");
    EXPECT_EQ(cells(), 5u);
    EXPECT_THAT(text("sweep/batch/part-1.log"), HasSubstr("shard 1/2 has 2 of 5 cells: 2 measured"));
    expect_result_of_one_machine();
}

// The log of finished parts alone would say that nothing is left to do.
TEST_F(WithParallel, MeasuresACellAgainThatWasRemoved) {
    ASSERT_EQ(sweep("--ssh :"), 0) << text("sweep.log");
    fs::remove(fs::directory_iterator(path("sweep/cells"))->path());
    ASSERT_EQ(sweep("--ssh :"), 0) << text("sweep.log");
    EXPECT_EQ(cells(), 5u);
    ASSERT_EQ(sweep("--ssh :"), 0) << text("sweep.log");
    EXPECT_EQ(lines("measuring: ").size(), 5u);
    EXPECT_EQ(lines("written: ").size(), 5u);
    int times = 0;
    for (const auto& [line, count] : lines("shard ")) times += count;
    EXPECT_EQ(times, 4) << "parts that are finished are not started again";
}

TEST_F(WithParallel, PassesOnTheExitCodeOfAPartThatFails) {
    const std::string set = R"(--set 'sweeps={"/receivers": [{"type": "points", "positions": [[50, 0, 0]]},)"
                            R"( {"type": "probes", "count": 200}]}')";
    EXPECT_EQ(sweep(set), 65);
    EXPECT_THAT(text("sweep.log"), HasSubstr("part 0 ended with exit code 65; "));
    EXPECT_THAT(text("sweep.log"), HasSubstr("swept.json: /receivers: none of"));
    EXPECT_THAT(text("sweep.log"), HasSubstr("1 of 2 cells are missing"));
    EXPECT_EQ(cells(), 1u) << "the other part was measured";
}

// GNU parallel puts each part into a group of its own, so a signal to its group would leave the parts measuring, beside
// those of the next call. SIGKILL leaves nobody who could pass it on.
TEST_F(WithParallel, InterruptedOrKilledLeavesNoPartBehind) {
    const std::string slow =
        "--set timing.repetitions=10000 --set timing.lookups=100000 --set receivers.count=100000 --threads 1";
    for (const int signal : {SIGTERM, SIGKILL}) {
        const std::string out = "sweep-" + std::to_string(signal);
        const std::string script =
            "(" + program("sweep swept.json --out " + out + " --engine parallel " + slow, "sweep.log") +
            ") & until grep -q measuring: " + path(out + "/batch/part-0.log") +
            " 2>/dev/null; do kill -0 $! || exit 99; sleep 0.02; done; kill -" + std::to_string(signal) +
            " $!; wait $!";
        EXPECT_EQ(shell(script), 128 + signal) << text("sweep.log");
        EXPECT_TRUE(soon([&] { return tasks("", out).empty(); })) << signal;
    }
}

// What is printed does the same, in any POSIX shell, whatever quotes the names and values need.
TEST_F(WithParallel, PrintsCommandsThatAShellCanRun) {
    const std::string arguments =
        "sweep swept.json --engine parallel --nodes 2 --out \"sweep's {} %d\" --set "
        "'sweeps={\"/rays/seed\":\n[1, 2]}'";
    ASSERT_EQ(shell(program(arguments + " --print", "script")), 0) << text("script");
    EXPECT_FALSE(fs::exists(path("sweep's {} %d"))) << "nothing was started";
    ASSERT_EQ(shell("cd " + path("") + " && sh ./script >script.log 2>&1"), 0) << text("script.log");
    EXPECT_TRUE(fs::exists(path("sweep's {} %d/result/result.json"))) << text("script.log");
}

}  // namespace
}  // namespace shadowbench
