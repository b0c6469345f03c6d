// Techniques from shared libraries on the command line. The program runs as a process, since the rows that it loads
// stay for as long as it runs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/read_text.h"
#include "service/cli/child.h"
#include "temporary_folder.h"

namespace shadowbench::service {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;

class Libraries : public ::testing::Test {
protected:
    // The exit code; the output is in out_.
    int run(const std::vector<std::string>& arguments) {
        const std::string log = temporary_.path("log");
        const int code = run_child(SHADOWBENCH_PROGRAM, arguments, log);
        out_ = base::read_text(log);
        return code;
    }
    std::string scenario(const json& techniques) const {
        const json document = {
            {"name", "small"},
            {"scene", {{"objects", {{{"type", "sphere"}, {"centre", {0, 0, 0}}, {"radius", 1}, {"opacity", 0.5}}}}}},
            {"lights", {{{"type", "directional"}, {"name", "key"}, {"direction", {0, -1, 0}}}}},
            {"rays", {{"resolution", 8}, {"samples_per_pixel", 4}}},
            {"receivers", {{"type", "probes"}, {"count", 200}}},
            {"reference", {{"samples_per_pixel", 16}, {"queries", 20}, {"spread_seeds", 0}}},
            {"timing", {{"repetitions", 1}, {"lookups", 64}}},
            {"techniques", techniques}};
        const std::string file = temporary_.path("small.json");
        std::ofstream(file) << document;
        return file;
    }
    json cells() const {
        return json::parse(base::read_text(temporary_.path("out/result.json")))["variants"][0]["lights"][0]["cells"];
    }

    TemporaryFolder temporary_;
    std::string out_;
};

TEST_F(Libraries, AreListedValidatedRunAndNamedInTheResult) {
    EXPECT_EQ(run({"list", "techniques", "--technique-library", SHADOWBENCH_STAIRS}), 0);
    EXPECT_THAT(
        out_, AllOf(HasSubstr("stairs        stairs of equal height (version 1; an example)"), HasSubstr("external: "),
                    HasSubstr("recommend tries: resolution, samples_per_pixel, stairs")));
    const std::string file = scenario({{{"type", "*"}}, {{"type", "stairs"}, {"stairs", 32}}});
    EXPECT_EQ(run({"validate", file}), 65) << "not without the library";
    EXPECT_THAT(out_, HasSubstr("unknown technique \"stairs\""));
    EXPECT_EQ(run({"validate", file, "--technique-library", SHADOWBENCH_STAIRS}), 0) << out_;
    EXPECT_EQ(run({"run", file, "--only", "stairs", "--only", "deep", "--technique-library", SHADOWBENCH_STAIRS,
                   "--out", temporary_.path("out")}),
              0)
        << out_;
    EXPECT_THAT(out_, HasSubstr("external: stairs from "));
    const json measured = cells();
    ASSERT_EQ(measured.size(), 2u);
    EXPECT_FALSE(measured[0].contains("library"));
    EXPECT_EQ(measured[1]["technique"], "stairs");
    EXPECT_EQ(measured[1]["status"], "ok") << measured[1]["reason"];
    EXPECT_EQ(measured[1]["library"]["hash"].get<std::string>().size(), 16u);
    EXPECT_LE(measured[1]["curve_error"]["max"].get<double>(), 0.5 / 32 + 1e-6);
    EXPECT_GT(measured[1]["times"]["lookup_random_order"]["ratio_to_floor"]["median"].get<double>(), 0.0);
}

// A merge without them would refuse the scenario, after hours of measurements.
TEST_F(Libraries, GoToTheMergeOfASweepToo) {
    const std::string file = scenario({{{"type", "stairs"}}});
    EXPECT_EQ(run({"sweep", file, "--technique-library", SHADOWBENCH_STAIRS, "--isolate", "--call-seconds", "7",
                   "--out", temporary_.path("sweep"), "--engine", "parallel", "--print"}),
              0)
        << out_;
    EXPECT_THAT(out_,
                HasSubstr("/sweep/result --technique-library " SHADOWBENCH_STAIRS " --isolate --call-seconds 7\n"));
}

// Each of these would end the run, or pass as an answer, if a fault were not that of its row.
TEST_F(Libraries, FailOnlyTheirOwnRows) {
    json techniques = {{{"type", "deep"}}};
    const std::vector<std::string> faults{"none",  "create",   "throw",  "nan",   "few",
                                          "rises", "vertices", "second", "finish"};
    for (const std::string& fault : faults) techniques.push_back({{"type", "faulty"}, {"fault", fault}});
    EXPECT_EQ(
        run({"run", scenario(techniques), "--technique-library", SHADOWBENCH_FAULTY, "--out", temporary_.path("out")}),
        2)
        << out_;
    const json measured = cells();
    ASSERT_EQ(measured.size(), faults.size() + 1);
    EXPECT_EQ(measured[0]["status"], "ok");
    EXPECT_GT(measured[0]["times"]["build_ms"]["median"].get<double>(), 0.0) << "the others are timed";
    const auto reason = [&](std::size_t cell) { return measured[cell]["reason"].get<std::string>(); };
    EXPECT_EQ(measured[1]["status"], "ok") << reason(1);
    EXPECT_THAT(reason(2), HasSubstr("create() failed"));
    EXPECT_THAT(reason(3), HasSubstr("add() threw an exception: over the border"));
    EXPECT_THAT(reason(4), HasSubstr("nan"));
    EXPECT_THAT(reason(5), HasSubstr("nan"));
    EXPECT_THAT(reason(6), HasSubstr("rises from 0.5 to 1"));
    EXPECT_THAT(reason(7), HasSubstr("stored() returned"));
    EXPECT_THAT(reason(8), HasSubstr("only one map is made")) << "a map that is built again";
    EXPECT_THAT(reason(9), HasSubstr("finish() failed"));
}

TEST_F(Libraries, InProcessesOfTheirOwnMayCrash) {
    const std::string file = scenario(
        {{{"type", "deep"}}, {{"type", "faulty"}, {"fault", "crash"}}, {{"type", "faulty"}, {"fault", "none"}}});
    EXPECT_EQ(
        run({"run", file, "--technique-library", SHADOWBENCH_FAULTY, "--isolate", "--out", temporary_.path("out")}), 2)
        << out_;
    const json measured = cells();
    EXPECT_EQ(measured[0]["status"], "ok");
    EXPECT_THAT(measured[1]["reason"].get<std::string>(), HasSubstr("lookup() ended its process"));
    EXPECT_EQ(measured[2]["status"], "ok") << measured[2]["reason"];
    EXPECT_EQ(measured[2]["library"]["isolated"], true);
}

TEST_F(Libraries, ThatCannotBeUsedFailARowOfTheirName) {
    const std::string file = scenario({{{"type", "*"}}});
    EXPECT_EQ(run({"list", "techniques", "--technique-library", temporary_.path("missing.so")}), 66) << out_;
    EXPECT_EQ(run({"serve", "--technique-libraries", temporary_.path("missing"), "--state", temporary_.path("state")}),
              66)
        << out_;
    EXPECT_EQ(run({"validate", file, "--technique-library", SHADOWBENCH_NOTHING}), 0) << out_;
    EXPECT_THAT(
        out_, HasSubstr("note: technique outside_nothing, from liboutside_nothing.so, will fail: it does not export"));
    EXPECT_EQ(run({"run", file, "--only", "deep", "--only", "outside_nothing", "--technique-library",
                   SHADOWBENCH_NOTHING, "--out", temporary_.path("out")}),
              2)
        << out_;
    const json measured = cells();
    ASSERT_EQ(measured.size(), 2u);
    EXPECT_EQ(measured[0]["status"], "ok");
    EXPECT_THAT(measured[1]["reason"].get<std::string>(), HasSubstr("does not export shadowbench_techniques()"));
}

}  // namespace
}  // namespace shadowbench::service
