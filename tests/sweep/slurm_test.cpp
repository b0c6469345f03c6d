// sweep on a Slurm cluster of four nodes, faked on this machine, while its daemons and the tasks are killed.
#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <functional>
#include <future>
#include <iostream>
#include <string>

#include "processes.h"
#include "sweep/swept.h"

namespace shadowbench {
namespace {

constexpr int all_cells = 64;

class OnSlurm : public Swept {
protected:
    OnSlurm() : Swept(all_cells) {}

    void SetUp() override {
        if (shell("PATH=\"$PATH:/usr/sbin:/sbin\"; for program in slurmctld slurmd munged sbatch squeue; do "
                  "command -v $program >/dev/null || exit 1; done") != 0) {
            std::cerr << "skipped: Slurm is missing; install slurm-wlm, slurm-client and munge\n";
            GTEST_SKIP() << "Slurm is missing";
        }
        ::setenv("SLURM_CONF", path("cluster/slurm.conf").c_str(), 1);
        started_ = true;
        ASSERT_EQ(cluster("start"), 0) << text("cluster.log");
    }
    void TearDown() override {
        if (!started_) return;
        EXPECT_EQ(cluster("stop"), 0);
        ::unsetenv("SLURM_CONF");
    }

    int cluster(const std::string& action, const std::string& of = "") const {
        return shell(std::string(SHADOWBENCH_SOURCE_DIR "/tests/sweep/cluster ") + action + " " + path("cluster") +
                     " " + of + " >>" + path("cluster.log") + " 2>&1");
    }

    void send(int signal) const {
        for (const pid_t task : tasks()) ::kill(task, signal);
    }

    // Lets the tasks run until there are so many cells, and holds them while `then` kills something: else a fast
    // machine would be through before.
    void at_cells(std::size_t count, const std::function<void()>& then) const {
        send(SIGCONT);
        ASSERT_TRUE(soon([&] { return cells() >= count; }));
        send(SIGSTOP);
        ASSERT_LT(cells(), all_cells) << "too late to kill anything";
        then();
        send(SIGCONT);
    }

    bool started_ = false;
};

// Without the array's --requeue, the loop around a part, afterany, or cells that appear whole, cells would be lost, or
// the merge would wait for ever; without the look at the folder before each cell, they would be measured again.
TEST_F(OnSlurm, KillsLoseNoCellAndDoubleNone) {
    std::future<int> sweep = std::async(
        std::launch::async, [&] { return shell(program("sweep swept.json --out sweep --wait", "sweep.log")); });
    int killed_tasks = 0;
    at_cells(4, [&] {
        for (const pid_t task : tasks("0/4")) killed_tasks += ::kill(task, SIGKILL) == 0 ? 1 : 0;
        EXPECT_EQ(killed_tasks, 1);
        // It saves new jobs within seconds.
        EXPECT_TRUE(soon([&] { return text("cluster/state/job_state").find("merge-") != std::string::npos; }));
    });
    at_cells(12, [&] { EXPECT_EQ(cluster("kill", "slurmctld"), 0); });
    at_cells(16, [&] { EXPECT_EQ(cluster("daemon", "slurmctld"), 0) << text("cluster.log"); });
    at_cells(22, [&] {
        EXPECT_EQ(cluster("crash", "n2"), 0) << text("cluster.log");
        ++killed_tasks;
    });
    at_cells(28, [&] { EXPECT_EQ(cluster("resume", "n2"), 0) << text("cluster.log"); });
    at_cells(34, [&] {
        EXPECT_EQ(cluster("kill", "n3"), 0);
        EXPECT_EQ(cluster("daemon", "n3"), 0) << text("cluster.log");
    });
    EXPECT_EQ(sweep.get(), 0) << text("sweep.log") << text("cluster.log");

    EXPECT_EQ(cells(), all_cells);
    const std::map<std::string, int> written = lines("written: "), measured = lines("measuring: ");
    EXPECT_GE(written.size() + 2, all_cells) << "a kill may come between the file and the line";
    for (const auto& [line, count] : written) EXPECT_EQ(count, 1) << line;
    EXPECT_EQ(measured.size(), all_cells);
    int repeated = 0;
    for (const auto& [line, count] : measured) repeated += count - 1;
    EXPECT_LE(repeated, killed_tasks);
    EXPECT_EQ(text("sweep.log").find("part "), std::string::npos) << "no part has failed in the end";
    expect_result_of_one_machine();
}

}  // namespace
}  // namespace shadowbench
