// compare, ab and history as commands, with this very program's `run` behind them where a child is needed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/read_text.h"
#include "service/cli/child.h"
#include "service/run_cli.h"
#include "temporary_folder.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;

json read_json(const fs::path& file) {
    std::ifstream stream(file);
    return json::parse(stream);
}

const char* const tiny = R"({
    "name": "tiny",
    "scene": {"objects": [{"type": "sphere", "centre": [0, 0, 0], "radius": 1, "opacity": 0.5}]},
    "lights": [{"type": "directional", "direction": [0, -1, 0]}],
    "rays": {"resolution": 8, "samples_per_pixel": 4},
    "receivers": {"type": "probes", "count": 200},
    "reference": {"samples_per_pixel": 16, "queries": 20, "spread_seeds": 2},
    "timing": {"repetitions": 1, "lookups": 64},
    "techniques": [{"type": "deep", "tolerance": 0.02}, {"type": "avsm"}],
    "sweeps": {"/rays/samples_per_pixel": [1, 4]}
})";

class Gate : public ::testing::Test {
protected:
    void SetUp() override {
        write("tiny.json", tiny);
        ASSERT_EQ(cli({"run", path("tiny.json"), "--out", path("base")}).code, 0);
    }

    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    std::string write(const std::string& name, const std::string& text) const {
        fs::create_directories((folder_ / name).parent_path());
        std::ofstream(folder_ / name) << text;
        return path(name);
    }
    json base() const { return read_json(folder_ / "base/result.json"); }
    // A stand-in for a build: a script that hands out results, whose build times are this many milliseconds.
    std::string program(const std::string& name, double build_ms, const std::string& more = "") const {
        json result = base();
        for (json& variant : result["variants"])
            for (json& cell : variant["lights"][0]["cells"]) cell["times"]["build_ms"]["raw"] = {build_ms};
        write(name + "_result.json", result.dump());
        const std::string script = "#!/bin/sh\necho \"$@\" >> " + path(name + ".log") + "\n" + more +
                                   "for last; do :; done\nmkdir -p \"$last\"\ncp " + path(name + "_result.json") +
                                   " \"$last/result.json\"\n";
        write(name, script);
        chmod(path(name).c_str(), 0755);
        return path(name);
    }
    void fails(const std::vector<std::string>& arguments, int code, const std::string& says) const {
        const Outcome outcome = cli(arguments);
        EXPECT_EQ(outcome.code, code) << outcome.err;
        EXPECT_EQ(outcome.out, "");
        EXPECT_THAT(outcome.err, HasSubstr(says));
        EXPECT_EQ(outcome.err.find('\n'), outcome.err.size() - 1) << outcome.err;
    }

    const TemporaryFolder temporary_;
    const fs::path folder_ = temporary_.path();
};

TEST_F(Gate, CompareTellsByItsExitCode) {
    EXPECT_EQ(cli({"compare", path("base"), path("base/result.json")}).code, 0);
    json larger = base();
    json& bytes = larger["variants"][1]["lights"][0]["cells"][0]["bytes"];
    bytes = bytes.get<int>() + 1;
    write("larger/result.json", larger.dump());
    const Outcome outcome = cli({"compare", path("base"), path("larger"), "--markdown", path("out/verdict.md"),
                                 "--junit", path("out/verdict.xml"), "--json", path("out/verdict.json")});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_EQ(outcome.err, "");
    EXPECT_THAT(outcome.out,
                HasSubstr("tiny / rays.samples_per_pixel=4 / directional_0 / deep tolerance=0.02\n  larger"));
    EXPECT_TRUE(fs::exists(folder_ / "out/verdict.md"));
    EXPECT_TRUE(fs::exists(folder_ / "out/verdict.xml"));
    EXPECT_EQ(read_json(folder_ / "out/verdict.json")["exit_code"], 2);
    const Outcome as_json = cli({"compare", path("base"), path("larger"), "--json", "-"});
    EXPECT_EQ(json::parse(as_json.out).at("exit_code"), 2);
    fails({"compare", path("base"), path("larger"), "--json", "-", "--markdown", "-"}, 64, "only one of");
    EXPECT_EQ(cli({"compare", path("base"), path("larger"), "--tolerance", "bytes=1"}).code, 0);
}

// The command beside a line runs only that cell, and gives the same numbers.
TEST_F(Gate, TheCommandOfACellRunsItAlone) {
    const Outcome report = cli({"compare", path("base"), path("base"), "--json", "-"});
    ASSERT_EQ(report.code, 0);
    const json verdict = json::parse(report.out);
    json wanted;
    for (const json& line : verdict["lines"])
        if (line["measure"] == "bytes" && line["group"].get<std::string>().rfind("rays.samples_per_pixel=4", 0) == 0 &&
            line["cell"] == "avsm")
            wanted = line;
    ASSERT_FALSE(wanted.is_null());
    std::vector<std::string> words;  // as a shell would split them: here are no escaped quotes
    std::string word;
    bool inside = false;
    for (const char c : wanted["command"].get<std::string>() + " ")
        if (c == '\'')
            inside = !inside;
        else if (c == ' ' && !inside)
            words.push_back(std::exchange(word, ""));
        else
            word += c;
    ASSERT_EQ(words[0], "shadowbench");
    words.erase(words.begin());
    words.insert(words.end(), {"--out", path("alone")});
    const Outcome alone = cli(words);
    ASSERT_EQ(alone.code, 0) << alone.err;
    const json result = read_json(folder_ / "alone/result.json");
    ASSERT_EQ(result["variants"].size(), 1u);
    EXPECT_EQ(result["variants"][0]["settings"]["/rays/samples_per_pixel"], 4);
    ASSERT_EQ(result["variants"][0]["lights"][0]["cells"].size(), 1u);
    EXPECT_EQ(result["variants"][0]["lights"][0]["cells"][0]["technique"], "avsm");
    EXPECT_EQ(result["variants"][0]["lights"][0]["cells"][0]["bytes"], wanted["current"]);
}

TEST_F(Gate, WrongUsageIsToldInOneLine) {
    fails({"compare", path("base")}, 64, "CURRENT");
    fails({"compare", path("base"), path("nowhere")}, 66, path("nowhere"));
    fails({"compare", path("base"), path("tiny.json")}, 65, "holds no result");
    fails({"compare", path("base"), path("base"), "--tolerance", "bytes"}, 64, "--tolerance bytes");
    fails({"compare", path("base"), path("base"), "--tolerance", "bytes=-1"}, 64, "--tolerance bytes=-1");
    fails({"compare", path("base"), path("base"), "--tolerance", "bites=1"}, 64, "there are: bytes, curve_error.max");
    fails({"compare", path("base"), path("base"), "--effect", "-1"}, 64, "--effect");
    fails({"compare", path("base"), path("base"), "--confirm"}, 64, "--binary-a");
    fails({"ab", path("nowhere"), path("nowhere"), path("tiny.json")}, 66, path("nowhere"));
    fails({"ab", path("tiny.json"), path("tiny.json"), path("tiny.json")}, 64, "cannot be executed");
    fails({"ab", program("a", 3.0), program("b", 3.0)}, 64, "SCENARIO");
    fails({"ab", program("a", 3.0), program("b", 3.0), "x", "--pairs", "0"}, 64, "--pairs");
    fails({"history", path("nowhere")}, 66, path("nowhere"));
    write("cut/result.json", "{\"schema_version\": 1,");
    fails({"compare", path("base"), path("cut")}, 65, "cut/result.json:1:");
}

TEST_F(Gate, AbRunsInTurnsAndJudgesThePairs) {
    const Outcome outcome = cli({"ab", program("a", 3.0), program("b", 3.6), path("tiny.json"), "--pairs", "12",
                                 "--set", "rays.seed=1", "--out", path("kept"), "--json", path("verdict.json")});
    EXPECT_EQ(outcome.code, 1) << outcome.err << outcome.out;
    EXPECT_THAT(outcome.out, HasSubstr("slower"));
    EXPECT_THAT(outcome.out, HasSubstr("smallest slowdown detected"));
    const json verdict = read_json(folder_ / "verdict.json");
    EXPECT_EQ(verdict["interleaved"], true);
    EXPECT_EQ(verdict["lines"][0]["verdict"], "slower");
    EXPECT_EQ(verdict["lines"][0]["measure"], "build");
    EXPECT_NEAR(verdict["lines"][0]["time"]["ratio"].get<double>(), 1.2, 1e-9);
    EXPECT_THAT(verdict["lines"][0]["command"].get<std::string>(),
                HasSubstr(path("b") + " run " + path("tiny.json") + " --set rays.seed=1 --set 'techniques=["));
    // What is kept compares in the same way.
    EXPECT_EQ(cli({"compare", path("kept/a"), path("kept/b")}).code, 1);
    fails({"ab", path("a"), path("b"), path("tiny.json"), "--out", path("kept")}, 64, "already exists");
}

// A B, B A, A B: neither always runs on what the other left behind.
TEST_F(Gate, AbAlternatesWhoGoesFirst) {
    const std::string log = "echo $0 >> " + path("order.log") + "\n";
    ASSERT_EQ(cli({"ab", program("a", 3.0, log), program("b", 3.0, log), path("tiny.json"), "--pairs", "4"}).code, 0);
    std::ifstream stream(folder_ / "order.log");
    std::string order;
    for (std::string line; std::getline(stream, line);) order += line.back();
    EXPECT_EQ(order, "abbaabba");
}

TEST_F(Gate, AbPassesAFailureOn) {
    const std::string failing = "echo 'shadowbench: /lights/0: is wrong' >&2\nexit 65\n";
    fails({"ab", program("a", 3.0), program("b", 3.0, failing), path("tiny.json"), "--pairs", "2"}, 65,
          "(B), exit code 65: /lights/0: is wrong");
    fails({"ab", program("a", 3.0), program("b", 3.0, "kill -9 $$\n"), path("tiny.json")}, 70, "signal 9");
    fails({"ab", program("a", 3.0), program("b", 3.0, "exit 0\n"), path("tiny.json")}, 70, "wrote no result");
    fails({"ab", program("a", 3.0), program("b", 3.0, "exit 3\n"), path("tiny.json")}, 70, "exit code 3");
}

// B looks slower at first only: its log grows with each run.
TEST_F(Gate, ConfirmRunsSuspiciousCellsAgain) {
    const std::string a = program("a", 3.0), fast = program("fast", 3.0);
    const std::string once = "if [ $(wc -l < " + path("b.log") + ") -gt 12 ]; then exec " + fast + " \"$@\"; fi\n";
    const Outcome outcome = cli({"ab", a, program("b", 3.6, once), path("tiny.json"), "--pairs", "12", "--confirm"});
    EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("looked slower, not confirmed by 24 fresh pairs"));
    std::ifstream stream(folder_ / "b.log");
    std::string line;
    while (std::getline(stream, line) && line.find("techniques=") == std::string::npos) {
    }
    EXPECT_THAT(line, HasSubstr("run " + path("tiny.json") + " --set techniques=["));
    EXPECT_EQ(cli({"ab", a, program("c", 3.6), path("tiny.json"), "--pairs", "12", "--confirm"}).code, 1);
}

TEST_F(Gate, CompareConfirmsWithBothBuilds) {
    ASSERT_EQ(
        cli({"ab", program("a", 3.0), program("b", 3.6), path("tiny.json"), "--pairs", "10", "--out", path("kept")})
            .code,
        1);
    EXPECT_EQ(cli({"compare", path("kept/a"), path("kept/b"), "--confirm", "--binary-a", path("a"), "--binary-b",
                   path("a"), "--pairs", "10"})
                  .code,
              0);
    const Outcome outcome = cli({"compare", path("kept/a"), path("kept/b"), "--confirm", "--binary-a", path("a"),
                                 "--binary-b", path("b"), "--pairs", "10"});
    EXPECT_EQ(outcome.code, 1);
    EXPECT_THAT(outcome.out, HasSubstr("confirmed by 10 fresh pairs"));
    // Another scenario of this name stands beside it: then both are told apart by their hashes, but not in the rerun.
    json other = base();
    other["scenario_hash"] = "ffffffffffffffff";
    write("kept/a/other.json", other.dump());
    write("kept/b/other.json", other.dump());
    const Outcome both = cli({"compare", path("kept/a"), path("kept/b"), "--confirm", "--binary-a", path("a"),
                              "--binary-b", path("b"), "--pairs", "10"});
    EXPECT_THAT(both.out, HasSubstr("tiny ["));
    EXPECT_THAT(both.out, HasSubstr("confirmed by 10 fresh pairs"));
    EXPECT_THAT(both.out, ::testing::Not(HasSubstr("not run again")));
}

TEST_F(Gate, AbTakesKernels) {
    const auto kernels = [&](const std::string& name, double time) {
        json file{{"context", {{"num_cpus", 2}, {"host_name", "h"}, {"executable", name}}},
                  {"benchmarks",
                   {{{"name", "compress/64"},
                     {"run_name", "compress/64"},
                     {"run_type", "iteration"},
                     {"real_time", time},
                     {"time_unit", "us"}}}}};
        write(name + "_out.json", file.dump());
        write(name, "#!/bin/sh\necho \"$@\" >> " + path(name + ".log") +
                        "\nfor word; do case \"$word\" in --benchmark_out=*) cp " + path(name + "_out.json") +
                        " \"${word#*=}\";; esac; done\n");
        chmod(path(name).c_str(), 0755);
        return path(name);
    };
    const Outcome outcome =
        cli({"ab", kernels("k1", 50.0), kernels("k2", 60.0), "--kernels", "compress", "--pairs", "8", "--confirm"});
    EXPECT_EQ(outcome.code, 1) << outcome.out << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("confirmed by 16 fresh pairs"));
    EXPECT_THAT(outcome.out, HasSubstr(path("k2") + " '--benchmark_filter=^(compress/64)$' --benchmark_min_time=0.05"));
    std::istringstream runs(base::read_text(folder_ / "k2.log"));
    int count = 0;
    for (std::string line; std::getline(runs, line); ++count)
        EXPECT_THAT(line, HasSubstr("--benchmark_min_time=0.05")) << "confirming too";
    EXPECT_EQ(count, 8 + 16);
    fails({"ab", path("k1"), path("k2"), "--kernels", "compress", "--only", "deep"}, 64, "--only");
    write("none",
          "#!/bin/sh\nfor word; do case \"$word\" in --benchmark_out=*) : > \"${word#*=}\";; esac; done\n"
          "echo 'Failed to match any benchmarks against regex: x' >&2\n");
    chmod(path("none").c_str(), 0755);
    fails({"ab", path("none"), path("none"), "--kernels", "x"}, 64, "Failed to match any benchmarks");
    fails({"ab", path("k1"), path("k2"), path("tiny.json"), "--min-time", "1"}, 64, "--kernels");
}

TEST_F(Gate, HistoryWritesItsJson) {
    const Outcome outcome = cli({"history", path("base"), "--out", path("history")});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("1 result, 4 cells"));
    EXPECT_EQ(read_json(folder_ / "history/history.json")["runs"].size(), 1u);
    EXPECT_THAT(base::read_text(folder_ / "history/history.html"), ::testing::HasSubstr("<html"));
}

TEST(Child, HasNoInputAndLeavesItsOutput) {
    const TemporaryFolder folder;
    EXPECT_EQ(run_child("/bin/sh", {"-c", "cat; echo said; echo complained >&2; exit 7"}, folder.path() / "log"), 7);
    std::ifstream stream(folder.path() / "log");
    std::string first, second;
    std::getline(stream, first);
    std::getline(stream, second);
    EXPECT_EQ(first, "said");
    EXPECT_EQ(second, "complained");
}

}  // namespace
}  // namespace shadowbench::service
