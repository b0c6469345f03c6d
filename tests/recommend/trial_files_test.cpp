// An exploration that goes on with the trials of an earlier one.
#include "recommend/trial_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/read_text.h"
#include "recommend/trials.h"
#include "recommend/two_layers.h"
#include "results/report.h"
#include "temporary_folder.h"

namespace shadowbench::recommend {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class KeptTrials : public ::testing::Test {
protected:
    std::unique_ptr<Trials> trials(Measure measure = Measure::rms, const json& document = two_layers(),
                                   int threads = 2, bench::MemoryLimits limits = {}) const {
        bench::RunOptions options;
        options.limits = limits;
        options.only = {"deep", "pcf"};
        options.threads = threads;
        auto made = std::make_unique<Trials>(document, options, "", measure, bench::ProgressCallback{});
        made->keep_in(folder());
        return made;
    }
    fs::path folder() const { return temporary_.path() / "trials"; }
    std::vector<fs::path> files() const { return {fs::directory_iterator(folder()), fs::directory_iterator()}; }
    // The cheapest point of a family, or one of a finer map.
    static Point point(const Lab& lab, std::size_t family, int finer = 0) {
        Point made{family, std::vector<int>(lab.families()[family].axes.size(), 0)};
        made.step[0] = finer;
        return made;
    }

    const TemporaryFolder temporary_;
};

// Two measurements never take the same time to the last digit, so equal times are those of the file.
TEST_F(KeptTrials, AreNotMeasuredAgain) {
    std::vector<Trial> before;
    json written;
    {
        const auto first = trials();
        for (const int finer : {0, 2}) before.push_back(first->measure(point(*first, 0, finer)));
        before.push_back(first->measure(point(*first, first->families().size() - 1)));
        written = json::parse(results::to_json(first->result()).dump());
    }
    EXPECT_EQ(files().size(), 3u);
    std::ofstream(folder() / ".half-written.json") << "{";  // what a kill leaves of a fourth

    const auto second = trials();
    EXPECT_EQ(second->measure(point(*second, 0, 0)).cost, before[0].cost);
    EXPECT_EQ(second->measure(point(*second, 0, 2)).cost, before[1].cost);
    EXPECT_EQ(second->measure(point(*second, second->families().size() - 1)).error, before[2].error);
    EXPECT_EQ(second->taken(), 3u);
    EXPECT_EQ(json::parse(results::to_json(second->result()).dump()).at("variants"), written.at("variants"));
    // What is new joins them, and what is confirmed is measured now.
    EXPECT_EQ(second->measure(point(*second, 0, 4)).failed, "");
    EXPECT_EQ(second->taken(), 3u);
    EXPECT_EQ(files().size(), 5u) << "the hidden one too";
    const Confirmed confirmed = second->confirm(std::vector{point(*second, 0, 2)}, {0.05, true, 20.0})[0];
    EXPECT_EQ(confirmed.failed, "");
    EXPECT_GE(confirmed.lookup_rounds.size(), 7u);
    EXPECT_TRUE(second->time_again(std::vector{point(*second, 0, 0)})[0].has_value());
}

// Otherwise times of another machine would rank settings beside those of this one.
TEST_F(KeptTrials, OfAnotherMachineOrQuestionDoNotCount) {
    const Trial here = [&] {
        const auto first = trials();
        return first->measure(point(*first, 0));
    }();
    ::setenv("SLURMD_NODENAME", "another-node", 1);
    {
        const auto there = trials();
        EXPECT_EQ(there->others(), 1u);
        const Trial again = there->measure(point(*there, 0));
        EXPECT_EQ(there->taken(), 0u);
        EXPECT_EQ(again.error, here.error) << "the exact measures agree";
    }
    ::unsetenv("SLURMD_NODENAME");
    EXPECT_EQ(files().size(), 2u) << "each machine keeps its own";
    json other_scenario = two_layers();
    other_scenario["rays"]["seed"] = 7;
    EXPECT_EQ(trials(Measure::p99)->others(), 2u);
    EXPECT_EQ(trials(Measure::rms, other_scenario)->others(), 2u);
    EXPECT_EQ(trials(Measure::rms, two_layers(), 1)->others(), 2u) << "threads share caches";
    const bench::MemoryLimits less{std::size_t{1} << 30, std::size_t{1} << 29};
    EXPECT_EQ(trials(Measure::rms, two_layers(), 2, less)->others(), 2u) << "it decides which maps fail";
    const auto back = trials();
    EXPECT_EQ(back->measure(point(*back, 0)).cost, here.cost);
}

// It would be a wrong time, or an answer that nobody measured.
TEST_F(KeptTrials, ThatAreDamagedAreNamed) {
    {
        const auto first = trials();
        first->measure(point(*first, 0));
    }
    const fs::path file = files().at(0);
    const std::string text = base::read_text(file.string());
    json changed = json::parse(text);
    changed["trial"]["cost"][0] = 0.001;
    for (const std::string& damaged : {changed.dump(), text.substr(0, text.size() / 2), std::string("[]")}) {
        std::ofstream(file) << damaged;
        try {
            trials();
            ADD_FAILURE() << damaged.substr(0, 20);
        } catch (const base::Error& error) {
            EXPECT_EQ(error.code(), base::ErrorCode::bad_input);
            EXPECT_THAT(error.where(), ::testing::HasSubstr(file.filename().string()));
            EXPECT_THAT(error.message(), ::testing::HasSubstr("remove it"));
        }
    }
}

}  // namespace
}  // namespace shadowbench::recommend
