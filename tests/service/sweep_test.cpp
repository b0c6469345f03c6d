// run --shard and merge, on a scenario of two variants with two lights each.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/read_text.h"
#include "results/merge_cells.h"
#include "results/report.h"
#include "results/sweep_cell.h"
#include "service/run_cli.h"
#include "temporary_folder.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const char* const swept = R"({
    "name": "swept",
    "scene": {"objects": [{"type": "sphere", "centre": [0, 0, 0], "radius": 1, "opacity": 0.5}]},
    "lights": [{"type": "directional", "name": "key", "direction": [0, -1, 0]},
               {"type": "directional", "name": "fill", "direction": [0.3, -1, 0]}],
    "rays": {"resolution": 8, "samples_per_pixel": 4},
    "receivers": {"type": "probes", "count": 200},
    "reference": {"samples_per_pixel": 16, "queries": 20, "spread_seeds": 2},
    "timing": {"repetitions": 1, "lookups": 64},
    "techniques": [{"type": "deep"}, {"type": "ray_traced"}],
    "sweeps": {"/rays/samples_per_pixel": [1, 4]}
})";

class Sweeps : public ::testing::Test {
protected:
    void SetUp() override { std::ofstream(scenario_) << swept; }

    std::string path(const std::string& name) const { return temporary_.path(name); }
    Outcome shard(const std::string& part, const std::string& folder = "sweep",
                  const std::vector<std::string>& more = {}) const {
        std::vector<std::string> arguments{"run", scenario_, "--shard", part, "--out", path(folder)};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return cli(arguments);
    }
    Outcome merged(const std::vector<std::string>& folders = {"sweep"}) const {
        std::vector<std::string> arguments{"merge"};
        for (const std::string& folder : folders) arguments.push_back(path(folder));
        arguments.insert(arguments.end(), {"--out", path("merged")});
        return cli(arguments);
    }
    std::vector<fs::path> files(const std::string& folder = "sweep") const {
        std::vector<fs::path> names;
        const fs::path cells = fs::path(path(folder)) / "cells";
        for (const auto& entry : fs::directory_iterator(cells)) names.push_back(entry.path());
        std::sort(names.begin(), names.end());
        return names;
    }
    nlohmann::ordered_json result(const std::string& folder) const {
        return nlohmann::ordered_json::parse(base::read_text(fs::path(path(folder)) / "result.json"));
    }
    // The file of this cell.
    fs::path file_of(std::size_t variant, std::size_t light) const {
        for (const fs::path& file : files())
            if (read(file).place == results::CellPlace{variant, light}) return file;
        ADD_FAILURE() << "no cell " << variant << ", " << light;
        return {};
    }
    static results::SweepCell read(const fs::path& file) {
        return results::cell_from_json(nlohmann::json::parse(base::read_text(file)), file.string());
    }
    // Writes a cell again as another machine or program would have measured it.
    static void change(const fs::path& from, const fs::path& to, const std::function<void(results::SweepCell&)>& how) {
        results::SweepCell cell = read(from);
        how(cell);
        std::ofstream(to) << results::to_json(cell).dump(1) << "\n";
    }

    const TemporaryFolder temporary_;
    const std::string scenario_ = path("swept.json");
};

TEST_F(Sweeps, ShardsMergedEqualTheRunInOnePiece) {
    ASSERT_EQ(cli({"run", scenario_, "--out", path("whole")}).code, 0);
    for (const char* part : {"2/3", "0/3", "1/3"}) {
        const Outcome outcome = shard(part);
        ASSERT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_EQ(outcome.err, "");
    }
    EXPECT_EQ(files().size(), 4u) << "and no temporary file";
    const Outcome outcome = merged();
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("light fill"));
    nlohmann::ordered_json whole = result("whole"), parts = result("merged");
    EXPECT_EQ(parts["times"]["cells"].size(), 4u);
    results::strip_times(whole);
    results::strip_times(parts);
    EXPECT_EQ(parts, whole);
    const auto head = [&](const std::string& name) {
        const std::string csv = base::read_text(path(name));
        return csv.substr(0, csv.find('\n'));
    };
    EXPECT_EQ(head("merged/result.csv"), head("whole/result.csv"));
}

TEST_F(Sweeps, TheSameCommandAgainContinues) {
    ASSERT_EQ(shard("0/2").code, 0);
    const std::vector<fs::path> first = files();
    ASSERT_EQ(first.size(), 2u);
    const std::string before = base::read_text(first[0]);
    const Outcome rest = shard("0/1");  // with another number of shards
    EXPECT_EQ(rest.code, 0) << rest.err;
    EXPECT_THAT(rest.out, HasSubstr("skipped: swept /rays/samples_per_pixel=1 light key: "));
    EXPECT_THAT(rest.out, HasSubstr("shard 0/1 has 4 of 4 cells: 2 measured, 2 skipped, 0 not measured\n"));
    EXPECT_EQ(base::read_text(first[0]), before);
    EXPECT_THAT(shard("1/2").out, HasSubstr("0 measured, 2 skipped"));
    EXPECT_THAT(shard("3/18446744073709551615").out, HasSubstr("has 1 of 4 cells"))
        << "the number of shards is 2^64 - 1";
    EXPECT_EQ(files().size(), 4u);
}

TEST_F(Sweeps, MergeNamesWhatIsMissingAndWhatToRun) {
    ASSERT_EQ(shard("0/2", "sweep", {"--set", "rays.seed=9"}).code, 0);
    const Outcome outcome = merged();
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.out, HasSubstr("missing: swept /rays/samples_per_pixel=1 light fill\n"
                                       "missing: swept /rays/samples_per_pixel=4 light fill\n"
                                       "2 of 4 cells are missing."));
    EXPECT_THAT(outcome.out, HasSubstr(": shadowbench run " + scenario_ + " --set rays.seed=9 --shard 0/1 --out " +
                                       path("sweep") + "\n"));
    EXPECT_FALSE(fs::exists(path("merged"))) << "half a result is none";
    ASSERT_EQ(cli({"run", scenario_, "--set", "rays.seed=9", "--shard", "0/1", "--out", path("sweep")}).code, 0);
    EXPECT_EQ(merged().code, 0);
}

TEST_F(Sweeps, MergeNamesWhatIsDoubledAndTakesTheFirst) {
    ASSERT_EQ(shard("0/1").code, 0);
    ASSERT_EQ(shard("0/2", "other").code, 0);
    const Outcome outcome = merged({"sweep", "other"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.out.rfind("doubled: swept /rays/samples_per_pixel=1 light key: ", 0), 0u) << outcome.out;
    const results::SweepCell first = read(file_of(0, 0));
    EXPECT_EQ(result("merged")["variants"][0]["lights"][0]["cells"][0]["times"]["build_ms"]["raw"],
              first.result.variants[0].lights[0].cells[0].times->build_ms.raw);
}

TEST_F(Sweeps, ACellOfTwoMachinesMustAgree) {
    ASSERT_EQ(shard("0/1").code, 0);
    const fs::path file = file_of(1, 0), copy = file.parent_path() / "copy.json";
    change(file, copy, [](results::SweepCell& cell) { cell.node = "n2"; });
    EXPECT_EQ(merged().code, 0);
    change(file, copy, [](results::SweepCell& cell) {
        cell.node = "n2";
        cell.result.variants[0].lights[0].cells[0].bytes += 1;
    });
    const Outcome outcome = merged();
    EXPECT_EQ(outcome.code, 65);
    EXPECT_THAT(outcome.err, HasSubstr(path("sweep/cells/")));
    EXPECT_THAT(outcome.err, HasSubstr("swept /rays/samples_per_pixel=4 light key: its measurements disagree in deep"));
    EXPECT_THAT(outcome.err, HasSubstr(": /bytes: "));
    EXPECT_THAT(outcome.err, HasSubstr("on n2, "));
}

TEST_F(Sweeps, TimesOfTwoMachinesAreNotRanked) {
    ASSERT_EQ(shard("0/1").code, 0);
    for (const std::size_t light : {0u, 1u}) {
        const fs::path file = file_of(1, light);
        change(file, file, [](results::SweepCell& cell) {
            cell.node = "n2";
            cell.result.machine.cpu = "another";
        });
    }
    const Outcome outcome = merged();
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("measured on 2 machines"));
    EXPECT_THAT(outcome.out, HasSubstr("  n2, another, "));
    const nlohmann::ordered_json json = result("merged");
    EXPECT_EQ(json["machine"]["cpu"], results::several_machines);
    EXPECT_EQ(json["times"]["cells"][2]["machine"]["cpu"], "another");
    const std::vector<std::string> ask{"recommend", "--from", path("merged"), "--light", "key", "--error", "0.9"};
    const Outcome ranked = cli(ask);
    EXPECT_EQ(ranked.code, 65);
    EXPECT_THAT(ranked.err, HasSubstr("measured on 2 machines"));
    std::vector<std::string> bytes = ask;
    bytes.insert(bytes.end(), {"--cheapest", "bytes"});
    EXPECT_NE(cli(bytes).code, 65) << "bytes do not depend on the machine";
}

TEST_F(Sweeps, ADamagedOrForeignFileIsAnErrorThatNamesIt) {
    ASSERT_EQ(shard("0/1").code, 0);
    const fs::path file = file_of(0, 1), other = file_of(0, 0);
    const std::string good = base::read_text(file);
    const auto refused = [&](const std::string& says) {
        for (const Outcome& outcome : {shard("0/1"), merged()}) {
            EXPECT_EQ(outcome.code, 65);
            EXPECT_EQ(outcome.out, "") << "before anything is measured";
            EXPECT_THAT(outcome.err, HasSubstr(file.string()));
            EXPECT_THAT(outcome.err, HasSubstr(says));
        }
    };
    std::ofstream(file) << good.substr(0, good.size() / 2);
    refused("damaged: remove it");
    std::ofstream(file) << "";
    refused("damaged: remove it");
    std::string changed = good;
    const std::size_t digit = changed.find("\"bytes\": ") + 9;
    changed[digit] = changed[digit] == '9' ? '8' : '9';
    std::ofstream(file) << changed;
    refused("checksum");
    // Under the name of another cell it is not measured again, since nobody knows what the name stood for.
    std::ofstream(file) << base::read_text(other);
    const Outcome misplaced = shard("0/1");
    EXPECT_EQ(misplaced.code, 65);
    EXPECT_THAT(misplaced.err, HasSubstr(file.string() + ": holds another cell"));
    ASSERT_EQ(shard("0/1", "foreign", {"--set", "rays.seed=9"}).code, 0);
    fs::copy_file(files("foreign")[0], file, fs::copy_options::overwrite_existing);
    EXPECT_THAT(merged().err, HasSubstr(file.string() + ": is no cell of this sweep"));
}

TEST_F(Sweeps, ACellOfAnotherVersionIsMeasuredAgain) {
    ASSERT_EQ(shard("0/1").code, 0);
    const fs::path file = file_of(0, 1);
    change(file, file, [](results::SweepCell& cell) { cell.result.program.commit = "earlier"; });
    const Outcome mixed = merged();
    EXPECT_EQ(mixed.code, 65) << "one result is of one program";
    EXPECT_THAT(mixed.err, HasSubstr("was measured by program"));
    const Outcome again = shard("0/1");
    EXPECT_EQ(again.code, 0) << again.err;
    EXPECT_THAT(again.out, HasSubstr("measured again: swept /rays/samples_per_pixel=1 light fill: "));
    EXPECT_THAT(again.out, HasSubstr("1 measured, 3 skipped"));
    EXPECT_EQ(merged().code, 0);
}

// Otherwise one row of a result would hold the measures of two programs.
TEST_F(Sweeps, CellsOfDifferentLibrariesAreNotMerged) {
    ASSERT_EQ(shard("0/1").code, 0);
    const std::vector<fs::path> all = files();
    const auto from = [&](const fs::path& file, const results::TechniqueLibrary& library) {
        change(file, file, [&](results::SweepCell& cell) {
            for (results::Cell& row : cell.result.variants[0].lights[0].cells)
                if (row.technique == "deep") row.library = library;
        });
    };
    const results::TechniqueLibrary one{"libdeep.so", "0123456789abcdef", false};
    for (const fs::path& file : all) from(file, one);
    ASSERT_EQ(merged().code, 0) << "all are of one";
    from(all.back(), {"libdeep.so", "fedcba9876543210", false});
    const Outcome other = merged();
    EXPECT_EQ(other.code, 65);
    EXPECT_THAT(other.err,
                HasSubstr(all.back().string() + ": its technique deep is from libdeep.so (fedcba9876543210)"));
    EXPECT_THAT(other.err, HasSubstr("libdeep.so (0123456789abcdef)"));
    from(all.back(), {"libdeep.so", "0123456789abcdef", true});
    EXPECT_THAT(merged().err, HasSubstr("(0123456789abcdef, isolated)")) << "whose times hold the way there and back";
    change(all.back(), all.back(), [](results::SweepCell& cell) {
        for (results::Cell& row : cell.result.variants[0].lights[0].cells) row.library.reset();
    });
    EXPECT_THAT(merged().err, HasSubstr("is from the program itself"));
}

TEST_F(Sweeps, OneFolderTakesOneSweep) {
    ASSERT_EQ(shard("0/4").code, 0);
    for (const std::vector<std::string>& other :
         {std::vector<std::string>{"--set", "rays.seed=9"}, std::vector<std::string>{"--only", "deep"}}) {
        const Outcome outcome = shard("1/4", "sweep", other);
        EXPECT_EQ(outcome.code, 65);
        EXPECT_THAT(outcome.err, HasSubstr(path("sweep/sweep.json") + ": is of another sweep"));
    }
    EXPECT_EQ(files().size(), 1u);
    const Outcome outcome = merged({"merged"});
    EXPECT_EQ(outcome.code, 66);
    EXPECT_THAT(outcome.err, HasSubstr("run --shard"));
}

// Otherwise the results of both would go to one folder.
TEST_F(Sweeps, ASweepThatHoldsAScenarioTwiceIsRefused) {
    ASSERT_EQ(shard("0/4").code, 0);
    const std::string file = path("sweep/sweep.json");
    nlohmann::json sweep = nlohmann::json::parse(base::read_text(file));
    const nlohmann::json scenario = sweep["scenarios"][0];
    sweep["scenarios"].push_back(scenario);
    std::ofstream(file) << sweep.dump();
    const Outcome outcome = merged();
    EXPECT_EQ(outcome.code, 65);
    EXPECT_THAT(outcome.err, HasSubstr(file + ": /scenarios: must hold scenarios, each name once"));
}

TEST_F(Sweeps, ACellThatCannotBeMeasuredStopsNoOther) {
    const std::vector<std::string> set{"--set", R"(sweeps={"/receivers": [{"type": "points", "positions": [[50, 0, 0]]},
                                                                          {"type": "probes", "count": 200}]})"};
    const Outcome outcome = shard("0/1", "sweep", set);
    EXPECT_EQ(outcome.code, 65);
    EXPECT_THAT(outcome.err, HasSubstr("swept.json: /receivers: none of"));
    EXPECT_THAT(outcome.out, HasSubstr("2 measured, 0 skipped, 2 not measured"));
    EXPECT_EQ(files().size(), 2u);
    EXPECT_EQ(merged().code, 2);
}

TEST_F(Sweeps, ScenariosAreMergedEachIntoItsFolder) {
    nlohmann::json second = nlohmann::json::parse(swept);
    second["name"] = "second";
    second.erase("sweeps");
    std::ofstream(path("second.json")) << second.dump();
    const auto both = [&](const std::string& part) {
        return cli({"run", scenario_, path("second.json"), "--shard", part, "--out", path("sweep")});
    };
    ASSERT_EQ(both("0/2").code, 0);
    EXPECT_EQ(files().size(), 3u) << "of six cells";
    ASSERT_EQ(both("1/2").code, 0);
    const Outcome outcome = merged();
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(result("merged/second")["variants"].size(), 1u);
    EXPECT_EQ(result("merged/swept")["variants"].size(), 2u);
    EXPECT_THAT(base::read_text(path("merged/verdicts.md")), HasSubstr("| second |"));
    EXPECT_THAT(cli({"run", scenario_, scenario_, "--shard", "0/2", "--out", path("twice")}).err,
                HasSubstr("has the same name"));
}

TEST_F(Sweeps, WrongShardsAreRefused) {
    for (const char* part : {"2/2", "1", "a/b", "0/0", "-1/2", "0/2x", "", "/"}) {
        const Outcome outcome = shard(part);
        EXPECT_EQ(outcome.code, 64) << part;
        EXPECT_THAT(outcome.err, HasSubstr("--shard")) << part;
    }
    EXPECT_EQ(cli({"run", scenario_, "--shard", "0/2"}).code, 64) << "without a folder";
    EXPECT_EQ(shard("0/2", "sweep", {"--verdicts", path("v.md")}).code, 64);
    EXPECT_EQ(cli({"merge"}).code, 64);
    EXPECT_FALSE(fs::exists(path("sweep/cells")));
}

}  // namespace
}  // namespace shadowbench::service
