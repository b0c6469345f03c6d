#include "service/run_cli.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "service/tiny_scenario.h"
#include "temporary_folder.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;

std::string read(const fs::path& file) {
    std::ifstream stream(file);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

class Cli : public ::testing::Test {
protected:
    void SetUp() override { write("tiny.json", tiny); }

    std::string write(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name) << text;
        return path(name);
    }
    std::string path(const std::string& name) const { return (folder_ / name).string(); }

    // One line on standard error that says this, nothing on standard output.
    void fails(const std::vector<std::string>& arguments, int code, const std::string& says) const {
        const Outcome outcome = cli(arguments);
        EXPECT_EQ(outcome.code, code) << outcome.err;
        EXPECT_EQ(outcome.out, "");
        EXPECT_EQ(outcome.err.rfind("shadowbench: ", 0), 0u) << outcome.err;
        EXPECT_NE(outcome.err.find(says), std::string::npos) << outcome.err;
        EXPECT_EQ(outcome.err.find('\n'), outcome.err.size() - 1) << outcome.err;
    }
    // The tiny scenario with one value set does not pass.
    void fails_with(const std::string& assignment, int code, const std::string& says) const {
        fails({"validate", path("tiny.json"), "--set", assignment}, code, says);
    }

    const TemporaryFolder temporary_;
    const fs::path folder_ = temporary_.path();
};

TEST_F(Cli, helps) {
    for (const auto& arguments :
         std::vector<std::vector<std::string>>{{"--help"}, {"run", "--help"}, {"curve", "-h"}}) {
        const Outcome outcome = cli(arguments);
        EXPECT_EQ(outcome.code, 0);
        EXPECT_EQ(outcome.err, "");
        EXPECT_NE(outcome.out.find("Usage"), std::string::npos) << outcome.out;
    }
    EXPECT_NE(cli({"--version"}).out.find("shadowbench 0."), std::string::npos);
}

TEST_F(Cli, refuses_wrong_usage) {
    fails({}, 64, "subcommand");
    fails({"frobnicate"}, 64, "unknown command \"frobnicate\"");
    fails({"run"}, 64, "SCENARIO");
    fails({"reproduce", "reeves"}, 64, "unknown paper \"reeves\"; there are: all, reeves1987, lokovic2000");
    fails({"run", path("tiny.json"), "--frobnicate"}, 64, "--frobnicate");
    fails({"run", path("tiny.json"), "--threads", "many"}, 64, "--threads");
    fails({"run", path("tiny.json"), "--threads", "-1"}, 64, "--threads");
    for (const char* limit : {"nan", "-nan", "NAN", "inf", "0", "-1", "many"})
        fails({"run", path("tiny.json"), "--memory-limit", limit}, 64, "--memory-limit");
    fails({"list", "everything"}, 64, "techniques");
    fails({"run", path("tiny.json"), "--set", "rays.seed"}, 64, "--set rays.seed");
    fails({"run", path("tiny.json"), "--set", "rayz.seed=3"}, 64, "rayz.seed=3");
    fails({"run", path("tiny.json"), "--out", ""}, 64, "--out");
    fails({"run", path("tiny.json"), "--only", "pcf"}, 64, "deep uncompressed");
}

TEST_F(Cli, names_what_a_misspelt_word_may_mean) {
    fails({"rnu"}, 64, "unknown command \"rnu\", perhaps \"run\"; there are: ");
    fails({"run", path("tiny.json"), "--wdie"}, 64, "--wdie, perhaps \"--wide\" (see shadowbench run --help)");
    fails({"run", path("tiny.json"), "--memory-limits=3"}, 64, "perhaps \"--memory-limit\"");
    fails({"run", path("tiny.json"), "--only", "depp"}, 64, "perhaps \"deep\"; it has: deep uncompressed");
    fails({"list", "scenario"}, 64, "perhaps \"scenarios\"");
    fails({"recommend", path("tiny.json"), "--error", "0.1", "--measure", "rsm"}, 64, "perhaps \"rms\"");
    fails({"recommend", path("tiny.json"), "--error", "0.1", "--only", "depp"}, 64, "perhaps \"deep\"");
    fails({"reproduce", "reeves1978"}, 64, "perhaps \"reeves1987\"");
    fails_with("techniques.0.type=depe", 65, "unknown technique \"depe\", perhaps \"deep\"; there are: ");
    fails_with("techniques.0.tolerence=0.1", 65, "unknown parameter, perhaps \"tolerance\"");
    setenv("SHADOWBENCH_SCENARIOS", folder_.c_str(), 1);
    fails({"run", "tinny"}, 66, "no scenario of this name, perhaps \"tiny\", in ");
    unsetenv("SHADOWBENCH_SCENARIOS");
}

TEST_F(Cli, says_what_is_wrong_with_an_error_to_reach) {
    fails({"recommend", path("tiny.json"), "--eror", "0.02"}, 64, "there is no --eror, perhaps \"--error\" (see");
    for (const char* text : {"2%", "0,02", "nan"})
        fails({"recommend", path("tiny.json"), "--error", text}, 64, "is not a number; write one as 0.02");
    fails({"recommend", path("tiny.json"), "--error", "2"}, 64, "--error: 2 is not from 1e-06 to 1 ");
    fails({"submit", path("tiny.json"), "--recommend", "2%"}, 64, "\"2%\" is not a number");
    fails({"submit", path("tiny.json"), "--budget", "2min"}, 64, "--recommend");
    fails({"submit", path("tiny.json"), "--recommend", "0.1", "--budget", "2"}, 64, "--budget");
}

TEST_F(Cli, says_which_file_is_missing) {
    fails({"run", "no_such_scenario"}, 66, "no_such_scenario");
    fails({"validate", path("missing.json")}, 66, "missing.json");
    fails({"validate", folder_.string()}, 66, folder_.string() + ": this is a folder; name one of the scenarios");
    fs::create_directories(folder_ / "hollow");
    fails({"validate", path("hollow")}, 66, path("hollow") + ": this is a folder without scenarios");
    fails({"validate", path("tiny.json"), "--data", path("nowhere")}, 66, "--data " + path("nowhere"));
    fails({"curve", path("missing.txt")}, 66, "missing.txt");
    write("hair.json", R"({"name": "h", "scene": {"objects": [{"type": "hair", "file": "gone.tfx", "radius": 0.1}]},
        "lights": [{"type": "directional", "direction": [0, -1, 0]}], "techniques": [{"type": "deep"}]})");
    fails({"validate", path("hair.json")}, 66, "/scene/objects/0/file: there is no file \"gone.tfx\"");
}

TEST_F(Cli, says_where_json_is_broken) {
    fails({"run", write("broken.json", "{\n  \"name\": tiny\n}")}, 65, "broken.json:2:");
    fails({"run", write("empty.json", "")}, 65, "empty.json:1:1");
    fails({"run", write("list.json", "[1, 2]")}, 65, "shadowbench: ");
    fails({"run", write("null.json", "null")}, 65, "shadowbench: ");
    fails({"run", write("nan.json", R"({"name": NaN})")}, 65, "nan.json:1:");
    fails({"run", write("overflow.json", R"({"name": "x", "rays": {"seed": 1e999}})")}, 65, "overflow.json");
}

TEST_F(Cli, says_which_value_is_wrong) {
    fails_with("rays.sampels=3", 65, "/rays/sampels");
    fails_with("rays.samples_per_pixel=0", 65, "/rays/samples_per_pixel");
    fails_with("rays.samples_per_pixel=2.5", 65, "/rays/samples_per_pixel");
    fails_with("rays.samples_per_pixel=four", 65, "/rays/samples_per_pixel");
    fails_with("rays.resolution=NaN", 65, "/rays/resolution");
    fails_with("rays.resolution=1e9", 65, "/rays/resolution");
    fails_with("techniques.0.type=shallow", 65, "/techniques/0/type: unknown technique \"shallow\"; there are: ");
    fails_with("techniques.0.tolerance=7", 65, "/techniques/0/tolerance");
    fails_with("techniques.0.tolerence=0.1", 65, "/techniques/0/tolerence");
    fails_with("techniques=[]", 65, "/techniques");
    fails_with("scene.objects=[]", 65, "/scene/objects");
    fails_with("scene.objects.0.casts_shadow=false", 65, "/scene/objects");
    fails_with("sweeps={\"/rays/sed\":[1]}", 65, "/rays/sed");
}

// Whether the bounds of the scene show it, or only the light rays.
TEST_F(Cli, says_that_a_light_sees_nothing) {
    const std::vector<std::string> aside{"--set", "lights.0.extent=[1,1]", "--set", "lights.0.target=[100,0,0]"};
    const std::vector<std::string> beside_the_ball{"--set", "lights.0.extent=[0.1,0.1]", "--set",
                                                   "lights.0.target=[0.9,0,0.9]"};  // but inside its bounds
    const auto with = [](std::vector<std::string> arguments, const std::vector<std::string>& more) {
        arguments.insert(arguments.end(), more.begin(), more.end());
        return arguments;
    };
    for (const auto& light : {aside, beside_the_ball}) {
        const Outcome empty = cli(with({"run", path("tiny.json"), "--out", path("out")}, light));
        EXPECT_EQ(empty.code, 0) << empty.err;
        EXPECT_NE(empty.out.find("note: the light sees nothing that casts a shadow"), std::string::npos) << empty.out;
        EXPECT_TRUE(nlohmann::json::parse(read(path("out/result.json")))["variants"][0]["lights"][0]["sees_nothing"]);
        fails(with({"export", path("tiny.json"), "--out", path("map.exr")}, light), 65, "/lights/0");
    }
    EXPECT_EQ(cli(with({"validate", path("tiny.json"), "--set", "sweeps={\"/rays/seed\":[1,2]}"}, aside)).out,
              "OK tiny: 2 variants of 1 light and 2 techniques\n"
              "note: light directional_0 sees nothing that casts a shadow: no caster is inside its map and behind its "
              "near plane\n");
}

TEST_F(Cli, refuses_what_exceeds_the_memory_limit_before_it_works) {
    fails({"run", path("tiny.json"), "--set", "rays.resolution=8192", "--set", "rays.samples_per_pixel=64",
           "--memory-limit", "1", "--out", path("out")},
          65, "GiB");
    EXPECT_FALSE(fs::exists(path("out")));
}

TEST_F(Cli, validate_reports_all_faults_one_per_line) {
    const Outcome outcome = cli({"validate", path("tiny.json"), "--set", "rays.resolution=0", "--set",
                                 "timing.lookups=many", "--set", "/techniques/0/tolerance=2"});
    EXPECT_EQ(outcome.code, 65);
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 3) << outcome.err;
    for (const char* place : {"/rays/resolution", "/timing/lookups", "/techniques/0/tolerance"})
        EXPECT_NE(outcome.err.find(std::string("shadowbench: ") + place), std::string::npos) << outcome.err;
}

TEST_F(Cli, validates_without_running) {
    const Outcome outcome = cli({"validate", path("tiny.json")});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.out, "OK tiny: 1 variant of 1 light and 2 techniques\n");
}

TEST_F(Cli, validate_reports_what_readers_skipped) {
    fs::copy_file(fs::path(SHADOWBENCH_SOURCE_DIR) / "tests/cases/zback0.exr", folder_ / "zback0.exr");
    write("deep.json", R"({"name": "deep", "scene": {"deep_image": {"file": "zback0.exr"}},
        "receivers": {"type": "probes", "count": 20}, "techniques": [{"type": "deep"}]})");
    const Outcome outcome = cli({"validate", path("deep.json")});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.out,
              "OK deep: 1 variant of 1 light and 1 technique\n"
              "file: /scene/deep_image/file: zback0.exr: 8 x 8 pixels, 64 samples, Z 3\n"
              "note: /scene/deep_image: 64 of 64 samples have their ZBack before Z: taken as surfaces\n");
}

// A coloured map leaves the program and comes back as a scene of its own, in colour.
TEST_F(Cli, a_coloured_map_comes_back_in_colour) {
    ASSERT_EQ(cli({"export", path("tiny.json"), "--set", "scene.objects.0.opacity=[0.2,0.5,0.8]", "--technique",
                   "uncompressed", "--out", path("map.exr")})
                  .code,
              0);
    write("again.json", R"({"name": "again", "scene": {"deep_image": {"file": "map.exr"}},
        "receivers": {"type": "probes", "count": 20}, "techniques": [{"type": "deep"}]})");
    const Outcome again = cli({"export", path("again.json"), "--rays", "--out", path("again.exr")});
    ASSERT_EQ(again.code, 0) << again.err;
    EXPECT_NE(again.out.find("3 channels"), std::string::npos) << again.out;
    EXPECT_EQ(cli({"run", path("again.json"), "--out", path("results")}).code, 0);
}

TEST_F(Cli, validate_describes_each_file_and_what_is_skipped_of_it) {
    write("edge.obj", "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\nf 1 2\nl 1 2\nl 3 4\n");
    const Outcome outcome = cli({"validate", path("tiny.json"), "--set",
                                 R"(scene.objects=[{"type": "mesh", "name": "edge", "file": "edge.obj"}])"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("file: /scene/objects/0/file: edge.obj: 4 vertices, 2 triangles; box [-1, -1, 0] to [1, "
                               "1, 0]\n"),
              std::string::npos)
        << outcome.out;
    EXPECT_NE(outcome.out.find("note: /scene/objects/0: passed over: faces of fewer than 3 corners (1), lines (2)\n"),
              std::string::npos)
        << outcome.out;
}

TEST_F(Cli, everything_that_measures_or_draws_shows_what_readers_skipped) {
    write("edge.obj", "V 0 0 0\nv -1 0 -1\nv -1 0 1\nv 1 0 1\nv 1 0 -1\nf 1 2 3 4\n");
    const std::string mesh = R"(scene.objects=[{"type": "mesh", "file": "edge.obj"}])";
    const std::string note = "note: /scene/objects/0: passed over: lines of the unknown keyword \"V\" (1)\n";
    const Outcome run = cli({"run", path("tiny.json"), "--set", mesh, "--out", path("measured")});
    EXPECT_NE(run.out.find("\n  " + note), std::string::npos) << run.out << run.err;
    EXPECT_EQ(nlohmann::json::parse(read(path("measured/result.json"))).at("notes").size(), 1u);
    const Outcome render =
        cli({"render", path("tiny.json"), "--set", mesh, "--size", "8x8", "--out", path("pictures")});
    EXPECT_NE(render.err.find(note), std::string::npos) << render.out << render.err;
    const Outcome out = cli({"export", path("tiny.json"), "--set", mesh, "--rays", "--out", path("rays.exr")});
    EXPECT_NE(out.err.find(note), std::string::npos) << out.out << out.err;
    ASSERT_EQ(cli({"run", path("tiny.json"), "--set", mesh, "--out", path("again"), "--verdicts", path("v.md")}).code,
              0);
    EXPECT_NE(read(path("v.md")).find("- note: /scene/objects/0: passed over"), std::string::npos);
}

// As Windows' editor writes it.
TEST_F(Cli, takes_a_scenario_with_a_byte_order_mark) {
    write("marked.json", "\xef\xbb\xbf" + read(path("tiny.json")));
    EXPECT_EQ(cli({"validate", path("marked.json")}).out, cli({"validate", path("tiny.json")}).out);
    write("wide.json", std::string("\xff\xfe{\0}\0", 6));
    const Outcome outcome = cli({"validate", path("wide.json")});
    EXPECT_EQ(outcome.code, 65);
    EXPECT_NE(outcome.err.find("save it as UTF-8"), std::string::npos) << outcome.err;
}

TEST_F(Cli, counts_what_each_variant_has) {
    const Outcome outcome = cli({"validate", path("tiny.json"), "--set", "sweeps={\"/rays/seed\":[1,2,3]}"});
    EXPECT_EQ(outcome.out, "OK tiny: 3 variants of 1 light and 2 techniques\n") << outcome.err;
}

TEST_F(Cli, runs_and_writes_json_and_csv) {
    const Outcome outcome = cli({"run", "--set", "rays.seed=9", "--out", path("out/deep"), path("tiny.json"), "--only",
                                 "uncompressed", "--threads", "1"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "") << "no progress bar outside of a terminal";
    EXPECT_NE(outcome.out.find("uncompressed"), std::string::npos);
    const nlohmann::json result = nlohmann::json::parse(read(path("out/deep/result.json")));
    EXPECT_EQ(result["scenario"]["rays"]["seed"], 9);
    EXPECT_EQ(result["only"], std::vector<std::string>{"uncompressed"});
    EXPECT_EQ(result["variants"][0]["lights"][0]["cells"].size(), 1u);
    EXPECT_EQ(result["variants"][0]["lights"][0]["cells"][0]["status"], "ok");
    EXPECT_EQ(read(path("out/deep/result.csv")).rfind("scenario,", 0), 0u);
    EXPECT_EQ(std::distance(fs::directory_iterator(path("out/deep")), {}), 2) << "no temporary file stays";
}

// The tiny scenario under other names, in a folder.
class CliOfMany : public Cli {
protected:
    void SetUp() override {
        Cli::SetUp();
        fs::create_directories(folder_ / "set" / "below");
        for (const char* name : {"b", "a"}) scenario(name);
        scenario("below/c");
        write("set/notes.txt", "not a scenario");
    }
    // One value set, or none.
    std::string scenario(const std::string& name, const std::string& pointer = "", const std::string& value = "") {
        nlohmann::json document = nlohmann::json::parse(tiny);
        document["name"] = fs::path(name).filename().string();
        if (!pointer.empty()) document[nlohmann::json::json_pointer(pointer)] = nlohmann::json::parse(value);
        return write("set/" + name + ".json", document.dump());
    }
    // What a folder of results holds.
    std::vector<std::string> names_in(const std::string& name) const {
        std::vector<std::string> names;
        for (const auto& entry : fs::directory_iterator(folder_ / name))
            names.push_back(entry.path().filename().string());
        std::sort(names.begin(), names.end());
        return names;
    }
    using Names = std::vector<std::string>;
};

TEST_F(CliOfMany, runs_every_scenario_directly_in_a_folder_by_name) {
    const Outcome outcome = cli({"run", path("set"), "--out", path("out")});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(names_in("out"), (Names{"a", "b", "verdicts.md"}));
    EXPECT_EQ(names_in("out/a"), (Names{"result.csv", "result.json"}));
    EXPECT_EQ(nlohmann::json::parse(read(path("out/b/result.json")))["name"], "b");
    EXPECT_EQ(outcome.out.rfind("a\n", 0), 0u) << "the first table is that of a\n" << outcome.out;
    EXPECT_LT(outcome.out.find("\nb\n"), outcome.out.find("verdicts (K kept")) << "verdicts come last";
    EXPECT_NE(outcome.out.find("2 scenarios: 4 verdicts kept, 0 degraded, 0 failed."), std::string::npos);
    const std::string verdicts = read(path("out/verdicts.md"));
    EXPECT_NE(verdicts.find("| a | K | K |\n| b | K | K |\n"), std::string::npos) << verdicts;
}

TEST_F(CliOfMany, writes_the_same_verdicts_on_any_number_of_threads) {
    ASSERT_EQ(cli({"run", path("set"), "--out", path("one"), "--threads", "1"}).code, 0);
    ASSERT_EQ(cli({"run", path("set"), "--out", path("two"), "--threads", "2"}).code, 0);
    EXPECT_EQ(read(path("one/verdicts.md")), read(path("two/verdicts.md")));
}

TEST_F(CliOfMany, runs_scenarios_that_are_named_one_by_one) {
    const Outcome outcome = cli({"run", path("set/b.json"), "--set", "rays.seed=5", path("tiny.json"), "--out",
                                 path("out"), "--verdicts", path("named/here.md")});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(names_in("out"), (Names{"b", "tiny"}));
    EXPECT_EQ(nlohmann::json::parse(read(path("out/tiny/result.json")))["scenario"]["rays"]["seed"], 5);
    EXPECT_NE(read(path("named/here.md")).find("## tiny\n"), std::string::npos);
}

TEST_F(CliOfMany, writes_verdicts_of_one_scenario_only_with_verdicts_given) {
    ASSERT_EQ(cli({"run", path("tiny.json"), "--out", path("out")}).code, 0);
    EXPECT_EQ(names_in("out"), (Names{"result.csv", "result.json"}));
    ASSERT_EQ(cli({"run", path("tiny.json"), "--out", path("out"), "--verdicts", path("v.md")}).code, 0);
    EXPECT_EQ(names_in("out"), (Names{"result.csv", "result.json"}));
    EXPECT_NE(read(path("v.md")).find("| tiny | K | K |"), std::string::npos);
    fails({"run", path("tiny.json"), "--out", path("out"), "--verdicts", path("set")}, 74, path("set"));
    fails({"run", path("tiny.json"), "--verdicts", ""}, 64, "--verdicts");
}

TEST_F(CliOfMany, checks_all_before_it_runs_the_first) {
    scenario("z", "/rays/samples_per_pixel", "0");
    fails({"run", path("set"), "--out", path("out")}, 65, path("set/z.json") + ": /rays/samples_per_pixel: ");
    write("set/z.json", "{\n  \"name\": z\n}");
    fails({"run", path("set"), "--out", path("out")}, 65, "shadowbench: " + path("set/z.json") + ":2:");
    scenario("z", "/name", "\"b\"");
    fails({"run", path("set"), "--out", path("out")}, 65, path("set/z.json") + ": /name: " + path("set/b.json"));
    fails({"run", path("set"), "--out", path("out"), "--only", "avsm"}, 64, path("set/a.json"));
    EXPECT_FALSE(fs::exists(path("out")));
}

// None of its receivers is inside the map: known only once it runs.
TEST_F(CliOfMany, runs_the_other_scenarios_when_one_cannot_be_run) {
    scenario("aa", "/receivers", R"({"type": "points", "positions": [[50, 0, 0]]})");
    const Outcome outcome = cli({"run", path("set"), "--out", path("out")});
    EXPECT_EQ(outcome.code, 65);
    EXPECT_EQ(outcome.err.rfind("shadowbench: " + path("set/aa.json") + ": /receivers: none of", 0), 0u) << outcome.err;
    EXPECT_EQ(names_in("out"), (Names{"a", "b", "verdicts.md"})) << "no folder for what has no result";
    EXPECT_NE(read(path("out/verdicts.md")).find("Could not be run: /receivers: none of"), std::string::npos);
    EXPECT_NE(outcome.out.find("could not be run: aa: /receivers"), std::string::npos) << outcome.out;
}

TEST_F(CliOfMany, exit_code_shows_a_broken_promise_in_any_scenario) {
    // 512,000 segments are more than the memory limit, and no estimate can know it.
    scenario("aa", "/scene/objects/0", R"({"type": "layers", "corner": [-1, 0, -1], "edge_u": [2, 0, 0],
        "edge_v": [0, 0, 2], "offset": [0, -0.001, 0], "count": 2000, "opacity": 0.001})");
    const Outcome outcome = cli({"run", path("set"), "--out", path("out"), "--memory-limit", "0.001"});
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_EQ(names_in("out"), (Names{"a", "aa", "b", "verdicts.md"}));
    EXPECT_THAT(outcome.out, testing::ContainsRegex("\nfailed: aa, uncompressed: with the rays of seed [0-9]+: "
                                                    "the map grew beyond the memory limit"));
    EXPECT_NE(read(path("out/verdicts.md")).find("| b | K | K |"), std::string::npos);
}

TEST_F(CliOfMany, finds_folders_by_name) {
    setenv("SHADOWBENCH_SCENARIOS", folder_.c_str(), 1);
    const Outcome found = cli({"run", "set", "--out", path("out")});
    unsetenv("SHADOWBENCH_SCENARIOS");
    EXPECT_EQ(found.code, 0) << found.err;
    EXPECT_EQ(names_in("out"), (Names{"a", "b", "verdicts.md"}));
    fs::create_directories(folder_ / "hollow");
    fails({"run", path("hollow")}, 66, path("hollow") + ": this is a folder without scenarios");
    fails({"run", path("tiny.json"), path("gone")}, 66, "gone");
}

TEST_F(Cli, says_at_once_that_results_cannot_be_written) {
    fails({"run", path("tiny.json"), "--out", path("tiny.json/below")}, 74, "tiny.json/below");
}

TEST_F(Cli, finds_scenarios_by_name) {
    setenv("SHADOWBENCH_SCENARIOS", folder_.c_str(), 1);
    EXPECT_EQ(cli({"validate", "tiny"}).code, 0);
    write("broken.json", "{");
    const Outcome listed = cli({"list", "scenarios"});
    unsetenv("SHADOWBENCH_SCENARIOS");
    EXPECT_EQ(listed.code, 0);
    EXPECT_NE(listed.out.find("tiny.json"), std::string::npos);
    EXPECT_NE(listed.out.find("broken.json"), std::string::npos) << "one broken file does not hide the others";
}

TEST_F(Cli, looks_for_data_in_no_folder_outside_unless_it_is_named) {
    fs::create_directories(folder_ / "project");
    fs::create_directories(folder_ / "shared/data");
    write("shared/data/quad.obj", "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n");
    write("project/quad.json", R"({"name": "q", "scene": {"objects": [{"type": "mesh", "file": "quad.obj"}]},
        "lights": [{"type": "directional", "direction": [0, -1, 0]}], "techniques": [{"type": "deep"}]})");
    const fs::path before = fs::current_path();
    fs::current_path(folder_ / "project");
    const char* data = std::getenv("SHADOWBENCH_DATA");
    const std::string kept = data ? data : "";
    unsetenv("SHADOWBENCH_DATA");
    const Outcome without = cli({"validate", "quad.json"});
    const Outcome named = cli({"validate", "quad.json", "--data", "../shared/data"});
    fs::current_path(before);
    if (data) setenv("SHADOWBENCH_DATA", kept.c_str(), 1);
    EXPECT_EQ(without.code, 66) << without.out;
    EXPECT_EQ(without.err.find("shared"), std::string::npos) << without.err;
    EXPECT_EQ(named.code, 0) << named.err;
}

TEST_F(Cli, lists_the_scenario_that_a_name_finds) {
    for (const char* one : {"first", "second"}) {
        fs::create_directories(folder_ / one);
        write(std::string(one) + "/same.json", std::string(R"({"name": "same", "purpose": ")") + one + "\"}");
    }
    setenv("SHADOWBENCH_SCENARIOS", (path("first") + ":" + path("second")).c_str(), 1);
    const Outcome listed = cli({"list", "scenarios"});
    unsetenv("SHADOWBENCH_SCENARIOS");
    EXPECT_NE(listed.out.find("first/same.json"), std::string::npos) << listed.out;
    EXPECT_EQ(listed.out.find("second/same.json"), std::string::npos) << listed.out;
}

TEST_F(Cli, finds_every_scenario_that_it_lists) {
    nlohmann::json document = nlohmann::json::parse(read(path("tiny.json")));
    document["name"] = "its_own_name";
    fs::create_directories(folder_ / "all/below");
    write("all/below/file.json", document.dump());
    document["name"] = "other";
    write("all/first.json", document.dump());
    write("all/second.json", document.dump());
    setenv("SHADOWBENCH_SCENARIOS", path("all").c_str(), 1);
    const Outcome listed = cli({"list", "scenarios"});
    for (const char* name : {"its_own_name", "other", "second"}) {
        EXPECT_NE(("\n" + listed.out).find(std::string("\n") + name + "  "), std::string::npos) << listed.out;
        const Outcome found = cli({"validate", name});
        EXPECT_EQ(found.code, 0) << found.err;
    }
    const Outcome run = cli({"run", "its_own_name", "--out", path("out")});
    const Outcome rendered = cli({"render", "its_own_name", "--size", "16x12", "--out", path("pictures")});
    unsetenv("SHADOWBENCH_SCENARIOS");
    EXPECT_EQ(run.code, 0) << run.err;
    EXPECT_EQ(nlohmann::json::parse(read(path("out/result.json")))["name"], "its_own_name");
    EXPECT_EQ(rendered.code, 0) << rendered.err;
}

TEST_F(Cli, lists_every_technique_with_its_parameters) {
    const Outcome outcome = cli({"list", "techniques"});
    EXPECT_EQ(outcome.code, 0);
    for (const char* text :
         {"shadow_map", "pcf", "deep", "avsm", "uncompressed", "ray_traced", "tolerance=", "nodes=8"})
        EXPECT_NE(outcome.out.find(text), std::string::npos) << text;
}

class CurveCli : public Cli {
protected:
    const std::string functions_ = write_functions();
    std::string write_functions() const {
        fs::create_directories(folder_);
        return write("functions.txt", "# a ramp, and a step\n3\n0 1\n1 0.5\n2 0\n\n4\n0 1\n1 1\n1 0.25\n3 0.2\n");
    }
};

TEST_F(CurveCli, reports_how_given_functions_are_stored) {
    const Outcome outcome = cli({"curve", functions_, "--json"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const nlohmann::json techniques = nlohmann::json::parse(outcome.out)["techniques"];
    ASSERT_EQ(techniques.size(), 2u);
    EXPECT_EQ(techniques[0]["technique"], "deep");
    EXPECT_EQ(techniques[0]["parameters"]["tolerance"], 0.02);
    EXPECT_EQ(techniques[0]["functions"], 2);
    EXPECT_EQ(techniques[0]["vertices_in"], 7);
    EXPECT_LE(techniques[0]["curve_error"]["max"].get<double>(), 0.02 + 1e-6);
    EXPECT_EQ(techniques[0]["over_tolerance"], 0);
    EXPECT_EQ(techniques[0]["broken"], 0);
    EXPECT_EQ(techniques[1]["technique"], "avsm");
    EXPECT_NEAR(techniques[1]["curve_error"]["max"].get<double>(), 0.0, 1e-6) << "8 nodes hold these functions";
}

TEST_F(CurveCli, writes_the_stored_functions_in_the_same_format) {
    ASSERT_EQ(cli({"curve", functions_, "--technique", "deep:tolerance=0.001", "--dump", path("stored.txt")}).code, 0);
    EXPECT_EQ(read(path("stored.txt")), "2\n0 1\n2 0\n3\n1 1\n1 0.25\n3 0.2\n");
    ASSERT_EQ(cli({"curve", functions_, "--technique", "deep", "--technique", "avsm", "--dump", path("two")}).code, 0);
    EXPECT_TRUE(fs::exists(path("two.1-deep")));
    EXPECT_TRUE(fs::exists(path("two.2-avsm")));
    EXPECT_EQ(cli({"curve", path("two.1-deep")}).code, 0) << "what was dumped can be read";
}

TEST_F(CurveCli, refuses_wrong_techniques_and_files) {
    fails({"curve", functions_, "--technique", "shallow"}, 64, "unknown technique \"shallow\"");
    fails({"curve", functions_, "--technique", "deep:tolerance=seven"}, 64, "tolerance");
    fails({"curve", functions_, "--technique", "ray_traced"}, 64, "ray_traced");
    fails({"curve", write("rising.txt", "2\n0 0.5\n1 0.75\n")}, 65, "rising.txt:3");
    fails({"curve", write("short.txt", "3\n0 1\n1 0.5\n")}, 65, "short.txt");
    fails({"curve", write("nan.txt", "1\nnan 1\n")}, 65, "nan.txt:2");
    fails({"curve", write("none.txt", "# nothing\n")}, 65, "none.txt");
    fails({"curve", functions_, "--technique", "deep", "--dump", path("functions.txt/below")}, 74, "below");
}

TEST_F(Cli, RenderWritesPicturesOfTheSizeAskedFor) {
    const Outcome done = cli({"render", write("tiny.json", tiny), "--size", "24x16", "--out", path("pictures")});
    ASSERT_EQ(done.code, 0) << done.err;
    EXPECT_NE(done.out.find("24 x 16"), std::string::npos) << done.out;
    const nlohmann::json images = nlohmann::json::parse(read(folder_ / "pictures/images.json"));
    EXPECT_EQ(images["resolution"], nlohmann::json({24, 16}));
    EXPECT_TRUE(fs::exists(folder_ / "pictures/uncompressed.shadow.exr"));
    EXPECT_EQ(read(folder_ / "pictures/deep.shaded.png").substr(1, 3), "PNG");
}

TEST_F(Cli, RenderRefusesAWrongSize) {
    for (const char* size : {"24", "24x", "x16", "0x4", "24x16x2", "-4x4", "70000x1"}) {
        const Outcome done = cli({"render", path("tiny.json"), "--size", size, "--out", path("none")});
        EXPECT_EQ(done.code, 64) << size;
        EXPECT_NE(done.err.find("WIDTHxHEIGHT"), std::string::npos) << done.err;
        EXPECT_FALSE(fs::exists(folder_ / "none"));
    }
}

TEST_F(Cli, writes_a_map_as_a_tiled_file_and_describes_it) {
    const Outcome written =
        cli({"export", path("tiny.json"), "--technique", "deep:tolerance=0.01", "--tile", "4", "--out", path("a.dsm")});
    ASSERT_EQ(written.code, 0) << written.err;
    for (const char* text : {"all checksums right", "tiny, light", "tolerance=0.01", "4 rays a pixel", "1 channel",
                             "1 level, 4 tiles of 4 x 4", "8 x 8 pixels"})
        EXPECT_NE(written.out.find(text), std::string::npos) << text << " in\n" << written.out;
    const Outcome inspected = cli({"inspect", path("a.dsm")});
    EXPECT_EQ(inspected.code, 0);
    EXPECT_EQ(inspected.out, written.out);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 2) << "nothing else is left";

    std::string bytes = read(path("a.dsm"));
    EXPECT_EQ(cli({"inspect", write("A.DSM", bytes)}).code, 0);
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 4);
    fails({"inspect", write("b.dsm", bytes)}, 65, "damaged");
    fails({"inspect", path("c.dsm")}, 66, "c.dsm");
    fails({"inspect", write("d.dsm", tiny)}, 65, "not a deep shadow map");
    fails({"inspect", folder_.string()}, 74, "regular file");
}

TEST_F(Cli, writes_maps_and_light_rays_as_deep_images) {
    for (const char* technique : {"deep", "avsm:nodes=4", "uncompressed", "shadow_map"}) {
        const Outcome written =
            cli({"export", path("tiny.json"), "--technique", technique, "--light", "0", "--out", path("map.exr")});
        EXPECT_EQ(written.code, 0) << written.err;
        EXPECT_NE(written.out.find("1 channel"), std::string::npos) << written.out;
    }
    ASSERT_EQ(
        cli({"export", path("tiny.json"), "--rays", "--set", "rays.samples_per_pixel=1", "--out", path("rays.exr")})
            .code,
        0);
    // What was written is a scene of its own, with the same rays.
    write("again.json", R"({"name": "again", "scene": {"deep_image": {"file": "rays.exr"}},
        "receivers": {"type": "probes", "count": 20}, "techniques": [{"type": "deep"}]})");
    const Outcome again = cli({"export", path("again.json"), "--rays", "--out", path("again.exr")});
    ASSERT_EQ(again.code, 0) << again.err;
    EXPECT_NE(again.out.find("8 x 8 pixels"), std::string::npos);
    const auto samples = [](const std::string& text) { return text.substr(text.rfind(", ")); };
    EXPECT_EQ(
        samples(again.out),
        samples(cli({"export", path("again.json"), "--technique", "uncompressed", "--out", path("map.exr")}).out));
}

TEST_F(Cli, refuses_what_cannot_be_exported) {
    const std::string tiny_file = path("tiny.json"), image = path("a.exr"), tiled = path("a.dsm");
    fails({"export", tiny_file}, 64, "--out");
    fails({"export", tiny_file, "--out", path("a.png")}, 64, ".dsm");
    fails({"export", tiny_file, "--out", tiled, "--technique", "avsm"}, 64, "only technique deep");
    fails({"export", tiny_file, "--out", tiled, "--rays"}, 64, "--rays");
    fails({"export", tiny_file, "--out", image, "--rays", "--technique", "deep"}, 64, "--rays");
    fails({"export", tiny_file, "--out", image, "--technique", "ray_traced"}, 64, "stores no functions");
    fails({"export", tiny_file, "--out", image, "--technique", "shallow"}, 64, "shallow");
    fails({"export", tiny_file, "--out", image, "--light", "moon"}, 64, "the scenario has: 0 ");
    fails({"export", tiny_file, "--out", image, "--light", "1"}, 64, "the scenario has: 0 ");
    fails({"export", tiny_file, "--out", tiled, "--tile", "0"}, 64, "--tile");
    fails({"export", tiny_file, "--out", image, "--set", "sweeps={\"/rays/resolution\":[4,8]}"}, 64,
          "--set /rays/resolution=");
    fails({"export", path("gone.json"), "--out", image}, 66, "gone.json");
    fails({"export", tiny_file, "--out", path("no/folder/a.exr")}, 74, "a.exr");
    fails({"export", tiny_file, "--out", image, "--memory-limit", "0.001", "--set", "rays.resolution=4096"}, 65,
          "memory");
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1) << "nothing is left";
}

}  // namespace
}  // namespace shadowbench::service
