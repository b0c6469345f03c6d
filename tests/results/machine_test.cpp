#include "results/machine.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <nlohmann/json.hpp>

#include "results/report.h"
#include "temporary_folder.h"

namespace shadowbench::results {
namespace {

namespace fs = std::filesystem;

class MachineFiles : public ::testing::Test {
protected:
    void write(const std::string& name, const std::string& text) const {
        const fs::path file = root / name;
        fs::create_directories(file.parent_path());
        std::ofstream(file) << text;
    }

    const TemporaryFolder temporary_;
    const fs::path root = temporary_.path();
};

Result result_on(const Machine& machine, const RunTimes& times) {
    Result result;
    result.name = "made";
    result.document = R"({"name": "made"})";
    result.machine = machine;
    result.times = times;
    return result;
}

TEST_F(MachineFiles, SayWhatTheMachineIs) {
    write(
        "proc/cpuinfo",
        "processor\t: 0\nmodel\t\t: 17\nmodel name\t: AMD EPYC 9R14\nmicrocode\t: 0xa101148\n\nmodel name\t: other\n");
    write("proc/meminfo", "MemTotal:       16303428 kB\nMemFree:         1 kB\n");
    write("proc/sys/kernel/ostype", "Linux\n");
    write("proc/sys/kernel/osrelease", "6.1.0-18-amd64\n");
    write("sys/devices/system/cpu/smt/control", "off\n");
    for (const char* cpu : {"cpu0", "cpu1", "cpu10"})
        write(std::string("sys/devices/system/cpu/") + cpu + "/cpufreq/scaling_governor",
              cpu == std::string("cpu10") ? "powersave\n" : "performance\n");
    write("sys/devices/system/cpu/cpufreq/scaling_governor", "is of no processor\n");
    for (const char* node : {"node0", "node1", "nodes"})
        fs::create_directories(root / "sys/devices/system/node" / node);
    write(".dockerenv", "");
    const Machine machine = this_machine(root);
    EXPECT_EQ(machine.cpu, "AMD EPYC 9R14") << "and not the number of the model";
    EXPECT_EQ(machine.microcode, "0xa101148");
    EXPECT_EQ(machine.kernel, "Linux 6.1.0-18-amd64");
    EXPECT_EQ(machine.governor, "performance, powersave");
    EXPECT_EQ(machine.smt, "off");
    EXPECT_EQ(machine.memory, 16694710272u);
    EXPECT_EQ(machine.numa_nodes, 2);
    EXPECT_EQ(machine.container, "docker");
    write("run/systemd/container", "lxc\n");
    EXPECT_EQ(this_machine(root).container, "lxc");
    write("run/systemd/container", "l\xff" + std::string(300, 'x') + "\n");
    EXPECT_EQ(this_machine(root).container, "l?" + std::string(198, 'x')) << "else the result could not be written";
}

TEST_F(MachineFiles, AreWrittenAndReadAndMayBeMissing) {
    ::unsetenv("container");
    const nlohmann::ordered_json bare = to_json(result_on(this_machine(root), {}));
    EXPECT_EQ(bare.at("machine").size(), 2u) << "no key without a value: " << bare.at("machine");
    EXPECT_FALSE(bare.at("times").contains("load"));
    EXPECT_EQ(to_json(from_json(bare, "")), bare) << "as results of earlier versions are";
    RunTimes times;
    times.load = 0.25;
    times.slurm_job = "12_3";
    times.slurm_node = "n1";
    const nlohmann::ordered_json whole =
        to_json(result_on({"A", 4, "0x1", "Linux 6", "performance", "on", 1024, 2, "podman"}, times));
    EXPECT_EQ(whole.at("machine").dump(),
              R"({"cpu":"A","logical_cores":4,"microcode":"0x1","kernel":"Linux 6","governor":"performance",)"
              R"("smt":"on","memory":1024,"numa_nodes":2,"container":"podman"})");
    EXPECT_EQ(whole.at("times").at("slurm_job"), "12_3");
    EXPECT_EQ(to_json(from_json(whole, "")), whole);
    nlohmann::ordered_json wrong = whole;
    wrong["machine"]["memory"] = -1;
    EXPECT_ANY_THROW(from_json(wrong, "")) << "no memory is negative";
}

// What changes from run to run is among the times: else no two results were equal without them.
TEST_F(MachineFiles, SayTheStateAtTheStart) {
    write("proc/loadavg", "1.50 0.75 0.30 2/345 6789\n");
    for (const char* name : {"SLURM_ARRAY_JOB_ID", "SLURM_ARRAY_TASK_ID", "SLURM_JOB_ID"}) ::unsetenv(name);
    ::setenv("SLURMD_NODENAME", "n7", 1);
    RunTimes times;
    add_state(times, root);
    EXPECT_EQ(times.load, 1.5);
    EXPECT_EQ(times.slurm_job + times.slurm_node, "") << "no job";
    ::setenv("SLURM_JOB_ID", "14", 1);
    add_state(times, root);
    EXPECT_EQ(times.slurm_job, "14");
    EXPECT_EQ(times.slurm_node, "n7");
    ::setenv("SLURM_ARRAY_JOB_ID", "12", 1);
    ::setenv("SLURM_ARRAY_TASK_ID", "2", 1);
    add_state(times, root);
    EXPECT_EQ(times.slurm_job, "12_2") << "as squeue names it";
    for (const char* name : {"SLURM_ARRAY_JOB_ID", "SLURM_ARRAY_TASK_ID", "SLURM_JOB_ID", "SLURMD_NODENAME"})
        ::unsetenv(name);
    write("proc/loadavg", "none\n");
    RunTimes unknown;
    add_state(unknown, root);
    EXPECT_FALSE(unknown.load);
}

}  // namespace
}  // namespace shadowbench::results
