// The command recommend, on a scene of two quads.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include <nlohmann/json.hpp>

#include "base/read_text.h"
#include "processes.h"
#include "results/report.h"
#include "service/run_cli.h"
#include "temporary_folder.h"

namespace shadowbench::service {
namespace {

constexpr const char* two_quads = R"({
    "name": "two_quads",
    "scene": {"objects": [
        {"type": "quad", "corner": [-1, 1, -1], "edge_u": [1.3, 0, 0.2], "edge_v": [0.1, 0, 1.1], "opacity": 0.6},
        {"type": "quad", "corner": [-1, 0, -1], "edge_u": [2, 0, 0], "edge_v": [0, 0, 2], "opacity": 0.5}]},
    "lights": [{"type": "directional", "name": "sun", "direction": [0, -1, 0]}],
    "rays": {"resolution": 16, "samples_per_pixel": 4},
    "receivers": {"type": "probes", "count": 500},
    "reference": {"samples_per_pixel": 64, "queries": 100, "spread_seeds": 0},
    "timing": {"repetitions": 2, "lookups": 128},
    "techniques": [{"type": "variance"}]
})";

TEST(Recommend, AnswersWritesWhatItMeasuredAndAnswersFromThat) {
    const TemporaryFolder folder;
    const std::string scenario = (folder.path() / "two_quads.json").string(), out = (folder.path() / "found").string();
    std::ofstream(scenario) << two_quads;
    const Outcome found = cli({"recommend", scenario, "--error", "0.3", "--only", "variance", "--budget", "20s",
                               "--at-most", "bytes=1GiB", "--out", out});
    EXPECT_EQ(found.code, 0) << found.err;
    EXPECT_THAT(found.out, ::testing::HasSubstr("two_quads, light sun"));
    EXPECT_THAT(found.out, ::testing::HasSubstr(R"("type":"variance")"));

    const auto written = nlohmann::json::parse(base::read_text(out + "/result.json"));
    const results::Result result = results::from_json(written, "result.json");
    std::size_t cells = 0;
    for (const results::VariantResult& variant : result.variants) cells += variant.lights.at(0).cells.size();
    EXPECT_EQ(cells, written.at("recommendation").at("measured").size());

    const Outcome again = cli({"recommend", "--from", out, "--error", "0.3"});
    EXPECT_EQ(again.code, 0) << again.err;
    EXPECT_EQ(cli({"recommend", "--from", out, "--error", "0.000001"}).code, 2);
    // An exploration answers only what it measured; what says how to measure is refused.
    for (const std::vector<std::string>& more : std::vector<std::vector<std::string>>{{"--measure", "p99"},
                                                                                      {"--light", "none"},
                                                                                      {"--only", "deep"},
                                                                                      {"--budget", "5s"},
                                                                                      {"--set", "rays.seed=2"}}) {
        std::vector<std::string> asked{"recommend", "--from", out, "--error", "0.3"};
        asked.insert(asked.end(), more.begin(), more.end());
        const Outcome refused = cli(asked);
        EXPECT_EQ(refused.code, 64) << more[0];
        EXPECT_NE(refused.err.find(more[0]), std::string::npos) << refused.err;
        EXPECT_EQ(refused.out, "");
    }
}

// Without a measurement, that nothing reaches the error would be false.
TEST(Recommend, RefusesABudgetThatTheTruthTakesWhole) {
    const TemporaryFolder folder;
    const std::string scenario = (folder.path() / "two_quads.json").string(), out = (folder.path() / "found").string();
    std::ofstream(scenario) << two_quads;
    const Outcome found =
        cli({"recommend", scenario, "--error", "0.3", "--only", "variance", "--budget", "0.000001s", "--out", out});
    EXPECT_EQ(found.code, 64) << found.out;
    EXPECT_THAT(found.err,
                ::testing::HasSubstr("--budget: 1e-06s ended before anything was measured: reading the scene "
                                     "and computing the truth took "));
    EXPECT_THAT(found.err, ::testing::HasSubstr("Give 5min or more"));
    EXPECT_FALSE(std::filesystem::exists(out)) << "nothing is left of it";
}

TEST(Recommend, AnswersFromARun) {
    const TemporaryFolder folder;
    const std::string scenario = (folder.path() / "two_quads.json").string(), out = (folder.path() / "run").string();
    std::ofstream(scenario) << two_quads;
    const Outcome ran =
        cli({"run", scenario, "--out", out, "--set", "reference.spread_seeds=2", "--set",
             "receivers.footprint={\"share\": 0.06}", "--set", "sweeps={\"/rays/resolution\": [16, 32]}"});
    ASSERT_EQ(ran.code, 0) << ran.err;
    const Outcome found = cli({"recommend", "--from", out, "--error", "0.5"});
    EXPECT_EQ(found.code, 0) << found.err;
    EXPECT_THAT(found.out, ::testing::HasSubstr("2 settings measured, 2 confirmed"));
    EXPECT_THAT(found.out, ::testing::HasSubstr("variance, resolution=16"));
    EXPECT_EQ(cli({"recommend", "--from", out, "--error", "0.5", "--measure", "curve"}).code, 65);
}

// Otherwise a night of exploring would be lost with the machine.
TEST(Recommend, GoesOnAfterAKill) {
    const TemporaryFolder folder;
    const std::string scenario = folder.path("two_quads.json"), out = folder.path("found");
    std::ofstream(scenario) << two_quads;
    const std::vector<std::string> words{"recommend", scenario,   "--error",  "0.2", "--cheapest", "bytes",
                                         "--only",    "variance", "--budget", "20s", "--out",      out};
    const auto kept = [&] {
        std::error_code none_yet;
        const std::filesystem::directory_iterator trials(out + "/trials", none_yet);
        return std::count_if(begin(trials), end(trials),
                             [](const auto& file) { return file.path().filename().string().front() != '.'; });
    };
    const pid_t killed = ::fork();
    if (killed == 0) {
        std::vector<char*> arguments{const_cast<char*>("shadowbench")};
        for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
        arguments.push_back(nullptr);
        ::execv(SHADOWBENCH_PROGRAM, arguments.data());
        ::_exit(127);
    }
    ASSERT_TRUE(soon([&] { return kept() >= 2; }));
    ::kill(killed, SIGKILL);
    ASSERT_EQ(::waitpid(killed, nullptr, 0), killed);
    const auto before = kept();
    const Outcome found = cli(words);
    EXPECT_EQ(found.code, 2) << "nothing reaches the error: " << found.err;
    EXPECT_THAT(found.out, ::testing::HasSubstr("settings were measured before"));
    const auto written = nlohmann::json::parse(base::read_text(out + "/result.json"));
    EXPECT_GE(written.at("recommendation").at("measured_before"), 2u);
    EXPECT_LE(written.at("recommendation").at("measured_before"), before);
    EXPECT_GE(kept(), written.at("recommendation").at("measured").size());
}

TEST(Recommend, RefusesWhatItCannotRead) {
    const TemporaryFolder folder;
    const std::string here = folder.path().string();
    EXPECT_EQ(cli({"recommend", "quickstart"}).code, 64);  // no error
    EXPECT_EQ(cli({"recommend", "--error", "0.1"}).code, 64);
    EXPECT_EQ(cli({"recommend", "quickstart", "--error", "0.1", "--from", here}).code, 64);
    EXPECT_EQ(cli({"recommend", "quickstart", "--error", "0.1", "--budget", "5"}).code, 64);
    EXPECT_EQ(cli({"recommend", "quickstart", "--error", "0.1", "--at-most", "nodes=5"}).code, 64);
    EXPECT_EQ(cli({"recommend", "--from", here, "--error", "0.1"}).code, 66);
    std::ofstream(folder.path() / "result.json") << "{}";
    const Outcome outcome = cli({"recommend", "--from", here, "--error", "0.1"});
    EXPECT_EQ(outcome.code, 65);
    EXPECT_THAT(outcome.err, ::testing::HasSubstr("result.json"));
}

}  // namespace
}  // namespace shadowbench::service
