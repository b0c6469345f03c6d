// Results of other machines: what keeps one from being added, and that those which are there may be.
#include "results/contribution.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "results/portable.h"

namespace shadowbench::results {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const fs::path source = SHADOWBENCH_SOURCE_DIR;

json read(const fs::path& file) {
    std::ifstream stream(file);
    return json::parse(stream);
}

// A result that a person may send, and the baseline of its scenario.
struct Sent {
    json result = read(source / "tests/released/0.2.0/result.json"), baseline;
    std::string date;
    Sent() {
        nlohmann::ordered_json portable = nlohmann::ordered_json::parse(result.dump());
        make_portable_result(portable);
        baseline = json::parse(portable.dump());
        make_portable_document(baseline["scenario"]);
        result["program"]["build_type"] = "Release";
        const std::string started = result["times"]["started"];
        date = started.substr(0, started.find('T'));
    }
    std::vector<std::string> faults(const std::string& name = "epyc-two-cores") const {
        return contribution_faults(result, baseline, name, date, "sent.json");
    }
};

TEST(Contribution, of_a_whole_run_that_agrees_has_no_fault) {
    EXPECT_THAT(Sent().faults(), IsEmpty());
}

TEST(Contribution, is_refused_for_what_it_lacks) {
    const auto faults_after = [](const std::function<void(Sent&)>& change) {
        Sent sent;
        change(sent);
        return sent.faults();
    };
    EXPECT_THAT(faults_after([](Sent& s) { s.result["only"] = {"deep"}; }), ElementsAre(HasSubstr("--only")));
    EXPECT_THAT(faults_after([](Sent& s) { s.result["machine"]["cpu"] = ""; }), ElementsAre(HasSubstr("machine")));
    EXPECT_THAT(faults_after([](Sent& s) { s.result["program"]["build_type"] = "Debug"; }),
                ElementsAre(HasSubstr("Debug")));
    EXPECT_THAT(faults_after([](Sent& s) { s.date = "2001-01-01"; }), ElementsAre(HasSubstr("day of the run")));
    EXPECT_THAT(faults_after([](Sent& s) { s.result["scenario"]["rays"]["samples_per_pixel"] = 16; }),
                ElementsAre(HasSubstr("not that of the baseline")));
    EXPECT_THAT(faults_after([](Sent& s) {
                    s.result["variants"][0]["lights"][0]["cells"][0]["times"] = nullptr;
                }),
                ElementsAre(HasSubstr("deep tolerance=0.01: it has fewer than 5 times")));
    EXPECT_THAT(Sent().faults("My Machine"), ElementsAre(HasSubstr("small letters")));
}

TEST(Contribution, must_agree_in_every_exact_measure) {
    Sent sent;
    json& cell = sent.result["variants"][0]["lights"][0]["cells"][0];
    cell["bytes"] = cell["bytes"].get<int>() + 1;
    EXPECT_THAT(sent.faults(), ElementsAre(HasSubstr("deep tolerance=0.01: /bytes is ")));
    sent = Sent();
    json& error = sent.result["variants"][0]["lights"][0]["cells"][2]["lookup_error"]["rms"];
    error = error.get<double>() * (1.0 + 1e-7);
    EXPECT_THAT(sent.faults(), IsEmpty()) << "another C library";
    error = error.get<double>() * 1.001;
    EXPECT_THAT(sent.faults(), ElementsAre(HasSubstr("/lookup_error/rms")));
    sent = Sent();
    sent.result["variants"][0]["lights"][0]["cells"].erase(1);
    EXPECT_THAT(sent.faults(), ElementsAre(HasSubstr("/cells"))) << "a technique is missing";
}

TEST(Contribution, those_that_are_there_have_no_fault) {
    const fs::path machines = source / "results/machines";
    if (!fs::exists(machines)) GTEST_SKIP() << "nobody has sent a result yet";
    for (const auto& entry : fs::recursive_directory_iterator(machines)) {
        if (entry.path().extension() != ".json") continue;
        const json result = read(entry.path());
        const fs::path baseline = source / "results/baseline" / (result.at("name").get<std::string>() + ".json");
        ASSERT_TRUE(fs::exists(baseline)) << entry.path() << " is of a scenario without a baseline";
        EXPECT_THAT(contribution_faults(result, read(baseline), entry.path().parent_path().filename().string(),
                                        entry.path().stem().string(), entry.path().string()),
                    IsEmpty())
            << entry.path();
    }
}

}  // namespace
}  // namespace shadowbench::results
