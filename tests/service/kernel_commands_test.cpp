// The commands around the kernels: instruction counts, and the baseline that holds on any machine.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>

#include <nlohmann/json.hpp>

#include "service/run_cli.h"
#include "temporary_folder.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

std::string read(const fs::path& file) {
    std::ifstream stream(file);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

// An environment variable for the length of a test.
class Variable {
public:
    Variable(const char* name, const std::string& value) : name_(name) {
        const char* before = std::getenv(name);
        before_ = before ? before : "";
        setenv(name, value.c_str(), 1);
    }
    ~Variable() { setenv(name_, before_.c_str(), 1); }
    Variable(const Variable&) = delete;
    Variable& operator=(const Variable&) = delete;

private:
    const char* name_;
    std::string before_;
};

class KernelCommands : public ::testing::Test {
protected:
    std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
    std::string write(const std::string& name, const std::string& text) const {
        std::ofstream(path(name)) << text;
        return path(name);
    }
    // A program in the place of the kernels.
    std::string program(const std::string& commands) const {
        const std::string file = write("program", "#!/bin/sh\n" + commands + "\n");
        fs::permissions(file, fs::perms::owner_all);
        return file;
    }

    const TemporaryFolder folder_;
};

TEST_F(KernelCommands, WithoutValgrindNothingIsCountedAndTheRemedyIsNamed) {
    const Variable nowhere("PATH", folder_.path().string());
    const Outcome outcome = cli({"instructions", "--kernels", SHADOWBENCH_KERNELS, "--out", path("counts.json")});
    EXPECT_EQ(outcome.code, 66);
    EXPECT_EQ(outcome.err,
              "shadowbench: valgrind: the program is not in $PATH; install the package valgrind\n");
    EXPECT_FALSE(fs::exists(path("counts.json")));
}

// As version 3.19 does on some processors.
TEST_F(KernelCommands, AValgrindThatDiesOfAnInstructionIsNamedWithTheRemedy) {
    const std::string valgrind = write("valgrind", "#!/bin/sh\nkill -ILL $$\n");
    fs::permissions(valgrind, fs::perms::owner_all);
    const Variable first("PATH", folder_.path().string() + ":/usr/bin:/bin");
    const Outcome outcome = cli({"instructions", "--kernels", SHADOWBENCH_KERNELS, "--out", path("counts.json")});
    EXPECT_EQ(outcome.code, 70);
    EXPECT_NE(outcome.err.find(valgrind), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("install a newer valgrind"), std::string::npos) << outcome.err;
    EXPECT_FALSE(fs::exists(path("counts.json")));
}

TEST_F(KernelCommands, AProgramThatIsNotThereIsNamed) {
    for (const char* command : {"instructions", "baseline"}) {
        const Outcome outcome = cli({command, "--kernels", path("none"), "--out", path("counts.json")});
        EXPECT_EQ(outcome.code, 66);
        EXPECT_NE(outcome.err.find(path("none")), std::string::npos) << outcome.err;
    }
}

// Instructions of the only kernel that this names.
double instructions_of(const std::string& filter, const std::string& argument, const std::string& file) {
    std::vector<std::string> arguments{"instructions", "--kernels", SHADOWBENCH_KERNELS, "--filter", filter,
                                       "--out",        file};
    if (!argument.empty()) arguments.insert(arguments.end(), {"--argument", argument});
    const Outcome outcome = cli(arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    if (outcome.code != 0) return 0.0;
    const json kernels = json::parse(read(file)).at("benchmarks");
    EXPECT_EQ(kernels.size(), 1u);
    EXPECT_FALSE(kernels[0].contains("real_time")) << "a time under callgrind says nothing";
    return kernels[0].at("instructions").get<double>();
}

TEST_F(KernelCommands, InstructionsRepeatAndATenthMoreWorkIsATenthMore) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "callgrind and sanitizers exclude each other";
#endif
    if (std::system("valgrind --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "valgrind is not installed";
    // Version 3.19 does not know all instructions that libraries choose on some processors, such as rdtscp.
    if (std::system("valgrind --tool=none " SHADOWBENCH_KERNELS " --benchmark_list_tests >/dev/null 2>&1") != 0)
        GTEST_SKIP() << "valgrind cannot run the kernels on this processor";
    const std::string kernel = "^compress/hair/tolerance:0.1$";
    const double once = instructions_of(kernel, "", path("a.json"));
    const double again = instructions_of(kernel, "", path("b.json"));
    const double slow = instructions_of(kernel, "--inject=slow:compress:0.1", path("c.json"));
    ASSERT_GT(once, 1e5);
    EXPECT_NEAR(again / once, 1.0, 1e-5);
    EXPECT_NEAR(slow / once, 1.1, 1e-3);
    EXPECT_EQ(cli({"compare", path("a.json"), path("b.json")}).code, 0);
    const Outcome verdict = cli({"compare", path("a.json"), path("c.json")});
    EXPECT_EQ(verdict.code, 1);
    EXPECT_NE(verdict.out.find("kernels / compress/hair/tolerance:0.1\n  slower          instructions"),
              std::string::npos)
        << verdict.out;
}

// Both builds as real processes: what is put into B stands under its name, and the rest of B is as A.
TEST_F(KernelCommands, AbNamesWhatIsPutIn) {
    const std::string kernels = SHADOWBENCH_KERNELS;
    const auto ab = [&](const std::string& injection) {
        return cli({"ab", kernels, program("exec " + kernels + " '--inject=" + injection + "' \"$@\""), "--kernels",
                    "^compress/hair/tolerance:0.(02|1)$", "--min-time", "0.001", "--pairs", "4"});
    };
    const std::string name = "kernels / compress/hair/tolerance:0.02\n  ";
    for (const auto& [fault, says] :
         std::vector<std::pair<std::string, std::string>>{{"node:tolerance:0.02:1", "larger          nodes"},
                                                          {"byte:tolerance:0.02:1", "larger          bytes"},
                                                          {"error:tolerance:0.02:1e-3", "less accurate   error"}}) {
        const Outcome outcome = ab(fault);
        EXPECT_EQ(outcome.code, 2) << outcome.err;
        EXPECT_NE(outcome.out.find(name + says), std::string::npos) << outcome.out;
        // What the clock says of the other kernel is the machine's matter.
        std::size_t exact = 0;
        for (const char* verdict : {"\n  larger ", "\n  smaller ", "\n  less accurate ", "\n  more accurate "})
            for (std::size_t at = 0; (at = outcome.out.find(verdict, at)) != std::string::npos; ++at) ++exact;
        EXPECT_EQ(exact, 1u) << "nothing else has changed\n" << outcome.out;
        EXPECT_NE(outcome.out.find("2 times judged"), std::string::npos) << outcome.out;
    }
    EXPECT_EQ(ab("node:tolerance:0.02:0").code, 0);
}

const char* const tiny = R"({
    "name": "tiny",
    "scene": {"objects": [{"type": "sphere", "centre": [0, 0, 0], "radius": 1, "opacity": 0.5}]},
    "lights": [{"type": "directional", "direction": [0, -1, 0]}],
    "rays": {"resolution": 8, "samples_per_pixel": 4},
    "receivers": {"type": "camera", "position": [0, 3, 5], "target": [0, 0, 0], "resolution": [16, 12]},
    "reference": {"samples_per_pixel": 16, "queries": 20, "spread_seeds": 2},
    "techniques": [{"type": "deep"}, {"type": "ray_traced"}]
})";
const char* const no_kernels = R"(echo '{"context":{},"benchmarks":[]}' >"${1#--exact=}")";

TEST_F(KernelCommands, TheBaselineIsTheSameOnAnyNumberOfThreads) {
    const std::string scenario = write("tiny.json", tiny), kernels = program(no_kernels);
    for (const char* threads : {"1", "3"}) {
        const Outcome outcome =
            cli({"baseline", scenario, "--kernels", kernels, "--threads", threads, "--out", path(threads)});
        ASSERT_EQ(outcome.code, 0) << outcome.err;
    }
    EXPECT_EQ(read(path("1/tiny.json")), read(path("3/tiny.json")));
    EXPECT_EQ(json::parse(read(path("1/kernels.json"))).at("benchmarks"), json::array());

    const json result = json::parse(read(path("1/tiny.json")));
    EXPECT_EQ(result.at("scenario").at("receivers").at("type"), "probes") << "what a camera sees is Embree's to say";
    const json& cells = result.at("variants").at(0).at("lights").at(0).at("cells");
    ASSERT_EQ(cells.size(), 1u) << "without ray_traced";
    EXPECT_EQ(cells[0].at("technique"), "deep");
    EXPECT_TRUE(cells[0].at("times").is_null());
}

TEST_F(KernelCommands, ABaselineOfBrokenKernelsIsWrittenAndSaysSo) {
    const Outcome wrong =
        cli({"baseline", "--kernels", program(std::string(no_kernels) + "; exit 2"), "--out", path("wrong")});
    EXPECT_EQ(wrong.code, 2);
    EXPECT_NE(wrong.out.find("broke its promise"), std::string::npos);
    EXPECT_TRUE(fs::exists(path("wrong/kernels.json")));

    const Outcome failed = cli({"baseline", "--kernels", program("echo oh; exit 70"), "--out", path("failed")});
    EXPECT_EQ(failed.code, 70);
    EXPECT_NE(failed.err.find("exit code 70: oh"), std::string::npos) << failed.err;
    EXPECT_FALSE(fs::exists(path("failed")));
}

TEST_F(KernelCommands, OneScenarioDoesNotHideAnother) {
    const Outcome outcome = cli({"baseline", write("a.json", tiny), write("b.json", tiny), "--kernels",
                                 program(no_kernels), "--out", path("out")});
    EXPECT_EQ(outcome.code, 65);
    EXPECT_NE(outcome.err.find("b.json: /name"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace shadowbench::service
