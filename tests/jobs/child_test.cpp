#include "service/jobs/child.h"

#include <gtest/gtest.h>
#include <signal.h>

#include <atomic>
#include <fstream>

#include "base/error.h"
#include "processes.h"
#include "temporary_folder.h"

namespace shadowbench::service {
namespace {

struct Outcome {
    ChildReport report;
    std::vector<std::string> lines;
};

const auto never = [] { return false; };

Outcome run_shell(const std::string& script, const ChildLimits& limits = {},
                  const std::function<bool()>& should_end = never) {
    Outcome outcome;
    outcome.report = run_child(
        "/bin/sh", {"-c", script}, limits, [&](std::string_view line) { outcome.lines.emplace_back(line); },
        should_end);
    return outcome;
}

TEST(Children, TellTheirLinesAndTheirExitCode) {
    const Outcome outcome = run_shell("echo one; echo; echo three; printf tail; echo wrong >&2; exit 3");
    EXPECT_EQ(outcome.report.end, ChildEnd::exited);
    EXPECT_EQ(outcome.report.code, 3);
    EXPECT_EQ(outcome.lines, (std::vector<std::string>{"one", "", "three"})) << "half a line is none";
    EXPECT_EQ(outcome.report.errors, "wrong\n");
}

TEST(Children, TellTheSignalThatEndedThem) {
    const Outcome outcome = run_shell("kill -SEGV $$");
    EXPECT_EQ(outcome.report.end, ChildEnd::signalled);
    EXPECT_EQ(outcome.report.code, SIGSEGV);
}

TEST(Children, LoseLinesThatHaveNoEnd) {
    const Outcome outcome = run_shell("echo first; head -c 100000 /dev/zero | tr '\\0' x; echo; echo last");
    EXPECT_EQ(outcome.lines, (std::vector<std::string>{"first", "last"}));
}

TEST(Children, KeepTheLastOfTheirErrors) {
    const Outcome outcome = run_shell("i=0; while [ $i -lt 3000 ]; do echo line $i >&2; i=$((i+1)); done");
    EXPECT_LE(outcome.report.errors.size(), 4096u);
    EXPECT_TRUE(outcome.report.errors.ends_with("line 2999\n"));
}

TEST(Children, AreEndedWhenTheyWriteWithoutEnd) {
    ChildLimits limits;
    limits.output = 1000000;
    for (const char* script : {"yes", "yes >&2", "tr '\\0' x </dev/zero"})
        EXPECT_EQ(run_shell(script, limits).report.end, ChildEnd::too_much_output) << script;
}

TEST(Children, AreEndedWhenTheirTimeIsUp) {
    ChildLimits limits;
    limits.seconds = 0.2;
    EXPECT_EQ(run_shell("trap '' TERM; sleep 1000", limits).report.end, ChildEnd::out_of_time);
    EXPECT_EQ(run_shell("exec >&- 2>&-; sleep 1000", limits).report.end, ChildEnd::out_of_time) << "and says nothing";
}

TEST(Children, AreEndedWhenTheyTakeTooMuchMemory) {
    ChildLimits limits;
    limits.memory = std::size_t{64} << 20;
    // tail keeps the line that never ends.
    EXPECT_EQ(run_shell("exec tail -n 1 </dev/zero", limits).report.end, ChildEnd::out_of_memory);
}

TEST(Children, AreEndedWhenTheyAreTold) {
    std::atomic<bool> told{false};
    const Outcome outcome = [&] {
        Outcome result;
        result.report = run_child(
            "/bin/sh", {"-c", "echo ready; sleep 1000"}, {}, [&](std::string_view) { told = true; },
            [&] { return told.load(); });
        return result;
    }();
    EXPECT_EQ(outcome.report.end, ChildEnd::stopped);
    EXPECT_EQ(outcome.report.code, SIGKILL);
}

TEST(Children, TakeTheirOwnChildrenWithThem) {
    const TemporaryFolder folder;
    const std::string note = (folder.path() / "note").string();
    // It ends, and leaves one that holds its output open.
    const Outcome outcome = run_shell("sleep 1000 & echo $! >" + note + "; exit 0");
    EXPECT_EQ(outcome.report.end, ChildEnd::exited);
    pid_t grandchild = 0;
    std::ifstream(note) >> grandchild;
    ASSERT_GT(grandchild, 0);
    EXPECT_TRUE(soon([&] { return !lives(grandchild); }));
}

TEST(Children, AreEndedWhenTheirListenerThrows) {
    pid_t child = 0;
    const auto listen = [&](std::string_view line) {
        child = static_cast<pid_t>(std::stol(std::string(line)));
        throw base::Error(base::ErrorCode::io, "", "enough");
    };
    EXPECT_THROW(run_child("/bin/sh", {"-c", "echo $$; exec sleep 1000"}, {}, listen, never), base::Error);
    EXPECT_TRUE(soon([&] { return !lives(child); }));
}

}  // namespace
}  // namespace shadowbench::service
