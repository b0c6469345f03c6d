// Jobs behind a launcher that starts them where no signal of this process reaches: in a session of their own, as on
// another machine. Only its streams are passed on.
#include "service/jobs/launched.h"

#include <gtest/gtest.h>
#include <signal.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "base/read_text.h"
#include "processes.h"
#include "temporary_folder.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;

const auto never = [] { return false; };

class Launched : public ::testing::Test {
protected:
    Launched() {
        std::ofstream(path("far")) << "#!/bin/sh\ntrap '' TERM\nexec 3<&0\nsetsid \"$@\" <&3 3<&- &\necho $$ >" +
                                          path("launcher") + "\nwait $!\n";
        fs::permissions(path("far"), fs::perms::owner_all);
    }

    std::string path(const std::string& name) const { return temporary_.path(name); }
    pid_t pid(const std::string& name) const {
        pid_t id = 0;
        std::ifstream(path(name)) >> id;
        return id;
    }
    ChildReport run(const std::string& script, const ChildLimits& limits = {},
                    const std::function<bool()>& should_end = never, const std::string& launcher = "") {
        lines.clear();
        return run_launched(
            launcher.empty() ? path("far") + " env 'A=b c'" : launcher, SHADOWBENCH_PROGRAM, "/bin/sh",
            {"-c", "echo $$ >" + path("job") + "; " + script}, limits,
            [&](std::string_view line) { lines.emplace_back(line); }, should_end);
    }

    std::vector<std::string> lines;

private:
    const TemporaryFolder temporary_;
};

TEST_F(Launched, JobsReportAsIfTheyRanHere) {
    const ChildReport exited = run("echo one; echo \"$A\"; echo wrong >&2; exit 2");
    EXPECT_EQ(exited.end, ChildEnd::exited);
    EXPECT_EQ(exited.code, 2);
    EXPECT_EQ(lines, (std::vector<std::string>{"one", "b c"})) << "without those of the guard";
    EXPECT_EQ(exited.errors, "wrong\n");
    const ChildReport signalled = run("kill -SEGV $$");
    EXPECT_EQ(signalled.end, ChildEnd::signalled);
    EXPECT_EQ(signalled.code, SIGSEGV);
}

// The launcher itself takes no memory and waits as long as it likes for a machine.
TEST_F(Launched, LimitsHoldWhereTheJobRuns) {
    ChildLimits little;
    little.memory = std::size_t{64} << 20;
    EXPECT_EQ(run("exec tail -n 1 </dev/zero", little).end, ChildEnd::out_of_memory);
    ChildLimits quick;
    quick.seconds = 0.5;
    EXPECT_EQ(run("sleep 100", quick).end, ChildEnd::out_of_time);
    EXPECT_EQ(run("exit 0", quick, never, "sh -c 'sleep 1; exec \"$@\"' launcher").end, ChildEnd::exited);
}

TEST_F(Launched, WhatIsCancelledEndsThere) {
    const auto runs = [&] { return pid("job") != 0 && lives(pid("job")); };
    EXPECT_EQ(run("sleep 100; echo late", {}, runs).end, ChildEnd::stopped);
    EXPECT_TRUE(soon([&] { return !lives(pid("job")); })) << "no signal of ours reaches it";
    EXPECT_TRUE(lines.empty());
}

TEST_F(Launched, AJobEndsWithItsLauncher) {
    const auto kill_launcher = [&] {
        if (pid("job") != 0 && pid("launcher") != 0) ::kill(pid("launcher"), SIGKILL);
        return false;
    };
    const ChildReport report = run("sleep 100", {}, kill_launcher);
    EXPECT_EQ(report.end, ChildEnd::lost) << "and may be run again";
    EXPECT_EQ(report.code, 128 + SIGKILL);
    EXPECT_TRUE(soon([&] { return !lives(pid("job")); }));
}

// Where the machine of the server is gone, nobody closes the streams.
TEST_F(Launched, AJobEndsIfTheServerGivesNoSignOfLife) {
    const std::string guard = std::string(SHADOWBENCH_PROGRAM) + " guard --seconds 100 --memory 1000000000 --silence ";
    const std::string silent = "mkfifo " + path("fifo") + "; exec " + guard + "0.3 -- /bin/sh -c 'sleep 90' <>" +
                               path("fifo") + " >" + path("out");
    EXPECT_EQ(std::system(silent.c_str()), 0);
    const std::string heard =
        "exec " + guard + "10 -- /bin/sh -c 'sleep 0.2; exit 3' <>" + path("fifo") + " >>" + path("out");
    EXPECT_EQ(std::system(heard.c_str()), 0);
    EXPECT_EQ(base::read_text(path("out")), "guard started\nguard started\nguard exited 3\n");
}

TEST_F(Launched, ALauncherThatCannotStartAJobSaysWhy) {
    const ChildReport report = run("true", {}, never, "sh -c 'echo no such partition >&2; exit 1' launcher");
    EXPECT_EQ(report.end, ChildEnd::lost);
    EXPECT_EQ(report.code, 1);
    EXPECT_EQ(report.errors, "no such partition\n");
    EXPECT_EQ(run("true", {}, never, "no-such-launcher").code, 127);
}

}  // namespace
}  // namespace shadowbench::service
