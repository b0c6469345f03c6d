#include "service/cli/job_process_command.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include <nlohmann/json.hpp>

#include "base/read_text.h"
#include "service/cli/cli.h"
#include "temporary_folder.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class JobCommand : public ::testing::Test {
protected:
    json scenario = json::parse(R"({
        "name": "tiny",
        "scene": {"objects": [{"type": "sphere", "centre": [0, 0, 0], "radius": 1, "opacity": 0.5}]},
        "lights": [{"type": "directional", "name": "sun", "direction": [0, -1, 0]},
                   {"type": "directional", "name": "sky", "direction": [0, -1, 0.1]}],
        "rays": {"resolution": 8, "samples_per_pixel": 4},
        "receivers": {"type": "probes", "count": 200},
        "reference": {"samples_per_pixel": 16, "queries": 20, "spread_seeds": 2},
        "timing": {"repetitions": 1, "lookups": 64},
        "techniques": [{"type": "uncompressed"}]})");

    // Runs it, and reads what it says.
    int run(std::vector<std::string> more = {}) {
        std::ofstream(folder.path() / "scenario.json") << scenario;
        return run_in(folder.path(), std::move(more));
    }
    int run_in(const fs::path& place, std::vector<std::string> more = {}) {
        std::vector<std::string> arguments{"shadowbench", "job", place.string()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        std::vector<const char*> pointers;
        for (const std::string& argument : arguments) pointers.push_back(argument.c_str());
        std::ostringstream out, err;
        const int code = cli_main(static_cast<int>(pointers.size()), pointers.data(), out, err);
        std::istringstream text(out.str());
        lines.clear();
        for (std::string line; std::getline(text, line);) lines.push_back(json::parse(line));
        return code;
    }
    bool exists(const char* name) const { return fs::exists(folder.path() / name); }

    const TemporaryFolder folder;
    std::vector<json> lines;
};

// A full disk is a fault of the storage; a name that is too long would fail on any disk.
TEST_F(JobCommand, DistinguishesFaultsOfItsStorageFromItsOwn) {
    fs::create_directory(folder.path() / "result.json");
    EXPECT_EQ(run(), 74);
    EXPECT_EQ(lines.back()["error"]["code"], 74);
    fs::remove(folder.path() / "result.json");
    const fs::path full = folder.path() / (".result.json." + std::to_string(::getpid()) + ".tmp");
    fs::create_symlink("/dev/full", full);
    EXPECT_EQ(run(), 74);
    ASSERT_TRUE(lines.back().contains("storage")) << lines.back();
    EXPECT_GT(lines.back()["storage"]["bytes"], 4096);
    EXPECT_NE(lines.back()["storage"]["message"].get<std::string>().find("No space left"), std::string::npos);
    EXPECT_EQ(run_in(folder.path() / "nowhere"), 66);
    EXPECT_TRUE(lines.back().contains("storage")) << "the server put its scenario there";
}

// Else a full /tmp would fail the jobs of a server whose own disk has room.
TEST_F(JobCommand, KeepsInItsFolderWhatItWritesForAWhile) {
    scenario["techniques"] = json::parse(R"([{"type": "deep", "storage": "tiled"}])");
    const char* const set = std::getenv("TMPDIR");
    const std::string before = set ? set : "";
    ::setenv("TMPDIR", "/nowhere", 1);
    EXPECT_EQ(run(), 0);
    EXPECT_STREQ(std::getenv("TMPDIR"), "/nowhere") << "as it was";
    if (before.empty())
        ::unsetenv("TMPDIR");
    else
        ::setenv("TMPDIR", before.c_str(), 1);
    for (const auto& entry : fs::directory_iterator(folder.path()))
        EXPECT_FALSE(entry.path().filename().string().starts_with("shadowbench-")) << entry.path().string();
}

TEST_F(JobCommand, ReportsItsProgress) {
    EXPECT_EQ(run(), 0);
    ASSERT_GT(lines.size(), 10u);
    double last = 0.0;
    for (const json& line : lines) {
        for (const char* key : {"stage", "place", "done", "total", "fraction"}) EXPECT_TRUE(line.contains(key)) << line;
        EXPECT_GE(line["fraction"], last);
        last = line["fraction"];
    }
    EXPECT_EQ(lines[0]["stage"], "load");
    const auto measured =
        std::find_if(lines.begin(), lines.end(), [](const json& line) { return line["stage"] != "load"; });
    ASSERT_NE(measured, lines.end());
    EXPECT_EQ((*measured)["stage"], "reference");
    EXPECT_EQ((*measured)["place"], "sun");
    EXPECT_GT(last, 0.9);
    EXPECT_LE(last, 1.0);
    EXPECT_EQ(json::parse(base::read_text(folder.path() / "result.json"))["name"], "tiny");
    EXPECT_TRUE(exists("result.csv"));
    EXPECT_TRUE(exists("images/images.json"));
    EXPECT_TRUE(exists("images/uncompressed.shaded.png"));
}

TEST_F(JobCommand, DrawsNothingWithNoPictures) {
    EXPECT_EQ(run({"--no-pictures"}), 0);
    EXPECT_TRUE(exists("result.json"));
    EXPECT_FALSE(exists("images"));
    EXPECT_GT(lines.back()["fraction"], 0.9);
}

// The probes fit into the memory limit, and what all pixels see does not.
TEST_F(JobCommand, KeepsTheResultOfWhatCannotBeDrawn) {
    EXPECT_EQ(run({"--memory-limit", "0.001"}), 0);
    EXPECT_TRUE(exists("result.json"));
    EXPECT_FALSE(exists("images/images.json"));
    const json why = json::parse(base::read_text(folder.path() / "images" / "error.json"));
    EXPECT_EQ(why["error"]["where"], "/receivers/resolution");
}

TEST_F(JobCommand, FindsTheAnswerToARequest) {
    const auto ask = [&](const json& request) {
        std::ofstream(folder.path() / "recommend.json") << request;
        return run();
    };
    json request = {{"error", 0.5}, {"only", {"variance"}}, {"light", "sun"}, {"budget", 5}};
    ASSERT_EQ(ask(request), 0) << lines.back();
    const json result = json::parse(base::read_text(folder.path() / "result.json"));
    EXPECT_EQ(result.at("recommendation").at("request"), request);
    EXPECT_EQ(result.at("recommendation").at("light"), "sun");
    EXPECT_GT(result.at("recommendation").at("confirmed").size(), 0u);
    EXPECT_TRUE(exists("result.csv"));
    EXPECT_FALSE(exists("images"));
    const std::string answer = base::read_text(folder.path() / "table.txt");
    EXPECT_EQ(answer.substr(0, answer.find('\n')), "tiny, light sun");
    EXPECT_NE(answer.find(R"("type":"variance")"), std::string::npos) << answer;
    std::vector<std::string> stages;
    double last = 0.0;
    for (const json& line : lines) {
        if (stages.empty() || stages.back() != line.at("stage")) stages.push_back(line.at("stage"));
        EXPECT_GE(line.at("fraction"), last);
        last = line.at("fraction");
        EXPECT_LE(last, 1.0);
        if (line.at("stage") != "reference") {
            EXPECT_EQ(line.at("total"), 5);
        }
    }
    ASSERT_GE(stages.size(), 3u);
    EXPECT_EQ(stages[0], "reference");
    EXPECT_EQ(stages[1], "exploring");
    EXPECT_EQ(stages[2], "confirming");

    request["error"] = 1e-6;
    EXPECT_EQ(ask(request), 2) << "variance does not reach it";
    EXPECT_NE(base::read_text(folder.path() / "table.txt").find("no setting reaches it"), std::string::npos);
    request["error"] = 7;
    EXPECT_EQ(ask(request), 65);
    EXPECT_EQ(lines.back()["error"]["where"], "/recommend/error");
}

TEST_F(JobCommand, SaysWhatIsWrongInALine) {
    scenario["lights"][1]["direction"] = "down";
    EXPECT_EQ(run(), 65);
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_EQ(lines[0]["error"]["code"], 65);
    EXPECT_EQ(lines[0]["error"]["where"], "/lights/1/direction");
    EXPECT_FALSE(exists("result.json"));
}

TEST_F(JobCommand, LooksForDataOnlyInTheGivenFolders) {
    scenario["scene"]["objects"][0] = {{"type", "mesh"}, {"file", "one.obj"}};
    std::ofstream(folder.path() / "one.obj") << "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n";
    EXPECT_EQ(run(), 66) << "the job's own folder is not one of them";
    EXPECT_EQ(lines.back()["error"]["where"], "/scene/objects/0/file");
    EXPECT_EQ(run({"--no-pictures", "--data", folder.path().string()}), 0);
}

TEST_F(JobCommand, RefusesWhatNeedsMoreMemoryThanItMayTake) {
    scenario["rays"]["resolution"] = 4096;
    scenario["rays"]["samples_per_pixel"] = 256;
    EXPECT_EQ(run({"--memory-limit", "0.01"}), 65);
    EXPECT_EQ(lines.back()["error"]["where"], "/rays");
}

}  // namespace
}  // namespace shadowbench::service
