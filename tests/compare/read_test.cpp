#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include "base/error.h"
#include "base/random.h"
#include "compare/compare.h"
#include "compare/made.h"
#include "temporary_folder.h"

namespace shadowbench::compare {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class Read : public ::testing::Test {
protected:
    fs::path write(const std::string& name, const std::string& text) const {
        fs::create_directories((folder_ / name).parent_path());
        std::ofstream(folder_ / name, std::ios::binary) << text;
        return folder_ / name;
    }
    // Expects reading to fail with this message.
    void fails(const fs::path& path, base::ErrorCode code, const std::string& says) const {
        try {
            read(path);
            ADD_FAILURE() << path << " was read";
        } catch (const base::Error& error) {
            EXPECT_EQ(error.code(), code) << error.what();
            EXPECT_NE(std::string(error.what()).find(says), std::string::npos) << error.what();
        }
    }
    void fails_with(const json::json_pointer& place, const json& value, const std::string& says) const {
        json result = made_result();
        result[place] = value;
        fails(write("result.json", result.dump()), base::ErrorCode::bad_input, says);
    }

    const TemporaryFolder temporary_;
    const fs::path folder_ = temporary_.path();
};

using Pointer = json::json_pointer;
const char* const cell = "/variants/0/lights/0/cells/0";

TEST_F(Read, AResultIsCells) {
    const Measured measured = read(write("result.json", made_result().dump()));
    ASSERT_EQ(measured.suites.size(), 1u);
    const Suite& suite = measured.suites[0];
    EXPECT_EQ(suite.name, "made");
    EXPECT_EQ(suite.machine, "AMD EPYC, 2 cores");
    ASSERT_EQ(suite.cells.size(), 2u);
    EXPECT_EQ(suite.cells[0].group, "key");
    EXPECT_EQ(suite.cells[0].name, "deep tolerance=0.02");
    EXPECT_EQ(suite.cells[0].exact.size(), 12u);
    ASSERT_EQ(suite.cells[0].timed.size(), 3u);
    EXPECT_EQ(suite.cells[0].timed[2].name, "lookup_random");
    EXPECT_EQ(suite.cells[0].timed[2].processes[0].ratio.size(), 3u);
    EXPECT_EQ(command_of(suite.cells[0].rerun), "shadowbench run " + (folder_ / "result.json").string() +
                                                    " --set 'techniques=[{\"tolerance\":0.02,\"type\":\"deep\"}]'");
}

TEST_F(Read, ACellOfASweepRunsAlone) {
    json result = made_result();
    result["scenario"]["sweeps"] = {{"/rays/seed", {1, 2}}, {"/techniques/0/tolerance", {0.01, 0.02}}};
    result["variants"][0]["settings"] = {{"/rays/seed", 2}};
    Measured measured;
    ASSERT_TRUE(add(measured, result, ""));
    EXPECT_EQ(measured.suites[0].cells[0].group, "rays.seed=2 / key");
    EXPECT_EQ(command_of(measured.suites[0].cells[0].rerun),
              "shadowbench run made --set 'techniques=[{\"tolerance\":0.02,\"type\":\"deep\"}]' --set "
              "'sweeps={\"/rays/seed\":[2]}'");
    cell_of(result, 0)["where"] = "nowhere";
    Measured other;
    ASSERT_TRUE(add(other, result, ""));
    EXPECT_EQ(command_of(other.suites[0].cells[0].rerun), "shadowbench run made --only deep");
}

// "*" stands for techniques with their defaults, each of which can run alone.
TEST_F(Read, ACellOfTheStarRunsAlone) {
    json result = made_result();
    result["scenario"]["techniques"][0] = {{"type", "*"}};
    Measured measured;
    ASSERT_TRUE(add(measured, result, ""));
    EXPECT_EQ(command_of(measured.suites[0].cells[0].rerun),
              "shadowbench run made --set 'techniques=[{\"type\":\"deep\"}]'");
}

// Older programs left swept values equal to the default out of the label, and put the others in their own places.
TEST_F(Read, ACellHasOneNameWhicheverProgramLabelledIt) {
    json result = made_result();
    result["scenario"]["sweeps"] = {{"/techniques/0/tolerance", {"noise", 0.02}}, {"/techniques/0/search", {"binary"}}};
    json& first = cell_of(result, 0);
    const auto name = [&](const char* label, const json& tolerance) {
        first["label"] = label;
        first["parameters"] = {{"tolerance", tolerance}, {"search", "binary"}, {"kernel", "tent"}};
        Measured measured;
        EXPECT_TRUE(add(measured, result, ""));
        return measured.suites[0].cells[0].name;
    };
    EXPECT_EQ(name("kernel=tent", "noise"), "deep search=binary tolerance=noise kernel=tent");
    EXPECT_EQ(name("search=binary tolerance=noise kernel=tent", "noise"),
              "deep search=binary tolerance=noise kernel=tent");
    EXPECT_EQ(name("kernel=tent tolerance=0.02", 0.02), "deep search=binary tolerance=0.02 kernel=tent");
    result["scenario"]["sweeps"] = {{"/rays/seed", {1, 2}}};
    EXPECT_EQ(name("kernel=tent", "noise"), "deep kernel=tent");
}

// Older programs left the default out of the labels of rows that differ in a parameter and write it.
TEST_F(Read, CellsOfRowsThatDifferMatchThoseOfOlderPrograms) {
    json result = made_result();
    result["scenario"]["techniques"] = {{{"type", "deep"}, {"tolerance", "noise"}, {"kernel", "tent"}},
                                        {{"type", "deep"}, {"tolerance", 0.0200001}}};
    const auto names = [&](const char* first, const char* second) {
        json& one = cell_of(result, 0);
        json& two = cell_of(result, 1);
        two = one;
        one["label"] = first;
        one["parameters"] = {{"tolerance", "noise"}, {"kernel", "tent"}, {"search", "binary"}};
        two["label"] = second;
        two["parameters"] = {{"tolerance", 0.0200001}, {"kernel", "box"}, {"search", "binary"}};
        two["where"] = "/techniques/1";
        Measured measured;
        EXPECT_TRUE(add(measured, result, ""));
        return std::vector{measured.suites[0].cells[0].name, measured.suites[0].cells[1].name};
    };
    const std::vector<std::string> expected{"deep kernel=tent tolerance=noise", "deep tolerance=0.0200001"};
    EXPECT_EQ(names("kernel=tent", "tolerance=0.02"), expected);
    EXPECT_EQ(names("tolerance=noise kernel=tent", "tolerance=0.0200001"), expected);
}

TEST_F(Read, KernelsAreCells) {
    const Measured measured = read(write("kernels.json", made_kernels().dump()));
    ASSERT_EQ(measured.suites.size(), 1u);
    ASSERT_EQ(measured.suites[0].cells.size(), 2u);
    const Cell& kernel = measured.suites[0].cells[1];
    EXPECT_EQ(kernel.name, "sweep(x)/8");
    ASSERT_EQ(kernel.timed.size(), 1u);
    EXPECT_EQ(kernel.timed[0].processes[0].raw, (std::vector<double>{50, 51, 52}));
    EXPECT_EQ(kernel.timed[0].processes[0].ratio.size(), 3u);
    EXPECT_EQ(kernel.exact.size(), 3u);  // neither rates, nor the aggregate, nor plain counters
    EXPECT_EQ(measured.suites[0].cells[0].exact[0].value, 512.0);
    EXPECT_EQ(command_of(kernel.rerun), "build/kernels '--benchmark_filter=^(sweep\\(x\\)/8)$'");
}

// Real time includes the time that other programs took of the processor. It is used only if a name asks for it, or if
// threads share the work.
TEST_F(Read, KernelsUseProcessorTimeUnlessTheyAskForRealTime) {
    const auto time_of = [](json run) {
        json kernels = made_kernels();
        for (const auto& [key, value] : kernels["benchmarks"][0].items())
            if (!run.contains(key)) run[key] = value;
        run["real_time"] = 70.0;
        run["cpu_time"] = 60.0;
        kernels["benchmarks"] = {run};
        return side({kernels}).suites.at(0).cells.at(0).timed.at(0).processes.at(0).raw.at(0);
    };
    EXPECT_EQ(time_of({{"run_name", "a/64"}}), 60.0);
    EXPECT_EQ(time_of({{"run_name", "a/64/real_time"}}), 70.0);
    EXPECT_EQ(time_of({{"run_name", "a/64/manual_time"}}), 70.0);
    EXPECT_EQ(time_of({{"run_name", "a/64/threads:2"}, {"threads", 2}}), 70.0);
}

TEST_F(Read, AKernelThatReportsAnErrorFailed) {
    json kernels = made_kernels();
    kernels["benchmarks"][0]["error_occurred"] = true;
    kernels["benchmarks"][0]["error_message"] = "wrong answer";
    Measured measured;
    ASSERT_TRUE(add(measured, kernels, ""));
    EXPECT_TRUE(measured.suites[0].cells[0].failed);
    EXPECT_EQ(exit_code(compare(side({made_kernels()}), measured, {})), 2);
}

TEST_F(Read, ResultsOfOneScenarioAreItsProcesses) {
    json other = made_result();
    cell_of(other, 0)["bytes"] = 1001;
    write("1/result.json", made_result().dump());
    write("2/result.json", other.dump());
    write("2/.hidden.json", "{");
    write("2/images.json", "{\"images\": []}");
    write("kernels.json", made_kernels().dump());
    const Measured measured = read(folder_);
    ASSERT_EQ(measured.suites.size(), 2u);
    EXPECT_EQ(measured.suites[0].results, 2u);
    EXPECT_EQ(measured.suites[0].cells[0].timed[0].processes.size(), 2u);
    // The same program gives the same numbers; if not, a note says so, and the worst counts.
    EXPECT_EQ(measured.suites[0].cells[0].exact[0].value, 1001.0);
    ASSERT_EQ(measured.notes.size(), 1u);
    EXPECT_NE(measured.notes[0].find("deep tolerance=0.02: bytes"), std::string::npos) << measured.notes[0];
}

TEST_F(Read, TimesOfAnotherMachineAreNotMixed) {
    json other = made_result();
    other["machine"]["cpu"] = "another";
    const Measured measured = side({made_result(), other});
    EXPECT_EQ(measured.suites[0].cells[0].timed[0].processes.size(), 1u);
    EXPECT_EQ(measured.notes.size(), 1u);
}

TEST_F(Read, EqualTechniquesAreNumbered) {
    json result = made_result();
    cell_of(result, 1) = cell_of(result, 0);
    const Measured measured = side({result});
    EXPECT_EQ(measured.suites[0].cells[1].name, "deep tolerance=0.02 #2");
}

TEST_F(Read, SaysWhatIsMissing) {
    fails(folder_ / "nowhere", base::ErrorCode::no_such_file, "nowhere");
    fails(folder_, base::ErrorCode::bad_input, "no result.json");
    write("images.json", "{}");
    fails(folder_, base::ErrorCode::bad_input, "holds no result");
    fails(folder_ / "images.json", base::ErrorCode::bad_input, "holds no result");
    json empty = made_result();
    empty["variants"] = json::array();
    fails(write("empty/result.json", empty.dump()), base::ErrorCode::bad_input, "holds no result");
}

TEST_F(Read, SaysWhereJsonIsBroken) {
    const std::string text = made_result().dump(1);
    fails(write("cut/result.json", text.substr(0, text.size() / 2)), base::ErrorCode::bad_input,
          "it was not written completely");
    fails(write("nan/result.json", "{\n \"schema_version\": NaN}"), base::ErrorCode::bad_input, "result.json:2:");
    fails(write("huge/result.json", "{\"a\": 1e999}"), base::ErrorCode::bad_input, "result.json");
    fails(write("none/result.json", ""), base::ErrorCode::bad_input, "result.json:1:1");
    fails(write("deep/result.json", std::string(100000, '[')), base::ErrorCode::bad_input, "nested deeper");
}

TEST_F(Read, SaysWhichValueIsWrong) {
    fails_with(Pointer("/schema_version"), 2, "result.json: /schema_version: schema version 2 is not known");
    fails_with(Pointer("/schema_version"), "1", "/schema_version: schema version of another type");
    fails_with(Pointer("/variants"), 3, "/variants: must be an array, not number");
    fails_with(Pointer("/name"), nullptr, "/name: must be a text, not null");
    const std::string at = cell;
    fails_with(Pointer(at + "/bytes"), "many", at + "/bytes: must be a number");
    fails_with(Pointer(at + "/bytes"), -1, at + "/bytes: must not be negative");
    fails_with(Pointer(at + "/times/build_ms/raw/1"), nullptr,
               at + "/times/build_ms/raw/1: must be a number, not null");
    fails_with(Pointer(at + "/times/build_ms/raw/1"), -2, at + "/times/build_ms/raw/1: must not be negative");
    fails_with(Pointer(at + "/times/build_ms/raw"), json::array(), "must hold at least one time");
    fails_with(Pointer(at + "/nodes"), json::array(), at + "/nodes: must be an object");
}

// --- damaged input -------------------------------------------------------------------------------------------------

// One cell with one sample of each kind, so that every place occurs once.
json small_result() {
    json result = made_result();
    result["variants"][0]["lights"][0]["cells"].erase(1);
    json& times = cell_of(result, 0)["times"];
    times["build_ms"]["raw"] = {3.0};
    for (const char* order : {"lookup_image_order", "lookup_random_order"})
        for (const char* what : {"ns", "floor_ns", "ratio_to_floor"}) times[order][what]["raw"] = {6.0};
    return result;
}

// A damaged result is refused or judged; nothing else may happen.
void judge_or_refuse(const std::string& text) {
    try {
        Measured measured;
        if (!add(measured, parse(text, "result.json"), "result.json")) return;
        ASSERT_EQ(exit_code(compare(measured, measured, {})), 0) << text;
    } catch (const base::Error& error) {
        ASSERT_EQ(error.where().rfind("result.json", 0), 0u) << error.what();
    }
}

TEST_F(Read, ATruncationAnywhereIsRefused) {
    const std::string text = small_result().dump();
    for (std::size_t length = 0; length < text.size(); ++length)
        EXPECT_THROW(parse(text.substr(0, length), "result.json"), base::Error) << length;
}

TEST_F(Read, AMutationAnywhereIsRefusedOrJudged) {
    const std::string text = small_result().dump();
    for (std::size_t at = 0; at < text.size(); ++at)
        for (const char other : {'0', '-', '"', '}'}) {
            std::string mutated = text;
            mutated[at] = other;
            judge_or_refuse(mutated);
        }
}

TEST_F(Read, AnyValueOfAnotherTypeIsRefusedOrJudged) {
    const json flat = small_result().flatten();
    for (const auto& [pointer, value] : flat.items())
        for (const json& other : {json(nullptr), json(true), json(0), json(-1), json(1e300), json("text"),
                                  json::array(), json::object(), json::array({nullptr})}) {
            json result = small_result();
            // Replaces the value, its parent, and so on up.
            for (Pointer place(pointer); !place.empty(); place.pop_back()) {
                result[place] = other;
                judge_or_refuse(result.dump());
                result = small_result();
            }
        }
}

TEST_F(Read, AnyKeyMayBeMissing) {
    const json flat = small_result().flatten();
    for (const auto& [pointer, value] : flat.items())
        for (Pointer place(pointer); !place.empty(); place.pop_back()) {
            json result = small_result();
            json& parent = result[place.parent_pointer()];
            if (!parent.is_object()) continue;
            parent.erase(place.back());
            judge_or_refuse(result.dump());
        }
}

TEST_F(Read, KernelsOfAnyKindAreRefusedOrJudged) {
    const json flat = made_kernels().flatten();
    for (const auto& [pointer, value] : flat.items())
        for (const json& other : {json(nullptr), json(-1), json(1e300), json("text"), json::array(), json::object()})
            for (Pointer place(pointer); !place.empty(); place.pop_back()) {
                json kernels = made_kernels();
                kernels[place] = other;
                judge_or_refuse(kernels.dump());
            }
}

}  // namespace
}  // namespace shadowbench::compare
