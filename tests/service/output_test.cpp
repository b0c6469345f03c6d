// What run and merge print: tables that fit, data alone, or nothing.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <pty.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>
#include <sstream>
#include <string>

#include <nlohmann/json.hpp>

#include "base/read_text.h"
#include "service/cli/terminal.h"
#include "service/run_cli.h"
#include "temporary_folder.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

// An environment variable for the length of a test.
class Variable {
public:
    Variable(const char* name, const char* value) : name_(name) {
        if (const char* before = std::getenv(name)) before_ = before;
        value ? setenv(name, value, 1) : unsetenv(name);
    }
    ~Variable() { before_ ? setenv(name_, before_->c_str(), 1) : unsetenv(name_); }
    Variable(const Variable&) = delete;
    Variable& operator=(const Variable&) = delete;

private:
    const char* name_;
    std::optional<std::string> before_;
};

class RunOutput : public ::testing::Test {
protected:
    RunOutput() {
        for (const char* name : {"one", "two"})
            std::ofstream(folder_ / (std::string(name) + ".json")) << "{\"name\": \"" << name << "\", "
                                                                   << R"(
                "scene": {"objects": [{"type": "sphere", "centre": [0, 0, 0], "radius": 1, "opacity": 0.5}]},
                "lights": [{"type": "directional", "direction": [0, -1, 0]}],
                "rays": {"resolution": 8, "samples_per_pixel": 4},
                "receivers": {"type": "probes", "count": 200},
                "reference": {"samples_per_pixel": 16, "queries": 20, "spread_seeds": 2},
                "timing": {"repetitions": 1, "lookups": 64},
                "techniques": [{"type": "deep", "tolerance": 0.02}, {"type": "uncompressed"}]})";
    }
    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    std::string text_of(const std::string& name) const { return base::read_text(folder_ / name); }

    const TemporaryFolder temporary_;
    const fs::path folder_ = temporary_.path();
    const Variable no_columns_{"COLUMNS", nullptr};
};

TEST_F(RunOutput, table_fits_the_columns_that_are_asked_for) {
    const Outcome standard = cli({"run", path("one.json"), "--out", path("out")});
    ASSERT_EQ(standard.code, 0) << standard.err;
    EXPECT_THAT(standard.out, HasSubstr("technique"));
    std::size_t longest = 0;
    std::istringstream lines(standard.out.substr(0, standard.out.find("written: ")));
    for (std::string line; std::getline(lines, line);) longest = std::max(longest, line.size());
    EXPECT_LE(longest, 100u) << standard.out;
    EXPECT_THAT(standard.out, Not(HasSubstr("\x1b"))) << "no colour outside of a terminal";
    const Outcome wide = cli({"run", path("one.json"), "--out", path("out"), "--wide"});
    EXPECT_THAT(wide.out, HasSubstr("nodes mean")) << "--wide has all columns";
    EXPECT_THAT(standard.out, Not(HasSubstr("nodes mean")));
}

TEST_F(RunOutput, run_ends_with_what_it_means_its_files_and_how_to_draw_its_pictures) {
    const std::vector<std::string> words{"run",    path("one.json"), "--set", "purpose=half a ball",
                                         "--only", "deep",           "--out", path("out")};
    const Outcome run = cli(words);
    EXPECT_THAT(run.out, HasSubstr("light directional_0: "));
    EXPECT_THAT(run.out,
                testing::EndsWith("\nwritten: " + path("out/result.json") + ", " + path("out/result.csv") +
                                  "\npictures: none yet; this draws them: shadowbench render " + path("one.json") +
                                  " --set 'purpose=half a ball' --only deep --out " + path("out/images") + "\n"));
    ASSERT_EQ(cli({"render", path("one.json"), words[2], words[3], "--size", "8x8", "--out", path("out/images")}).code,
              0);
    EXPECT_THAT(cli(words).out, testing::EndsWith("\npictures: " + path("out/images") + "\n"));
    EXPECT_THAT(cli({"run", path("one.json"), "--set", "rays.seed=9", "--out", path("out")}).out,
                HasSubstr("\npictures: none yet; "))
        << "these pictures show another scenario";
}

// Without it, the first run of a scenario has numbers only.
TEST_F(RunOutput, pictures_are_drawn_as_jobs_draw_them) {
    const Outcome run =
        cli({"run", path("one.json"), path("two.json"), "--set", "sweeps={\"/rays/seed\": [5, 6]}", "--set",
             R"(receivers={"type": "camera", "position": [0, 3, 1], "target": [0, 0, 0], "resolution": [8, 8]})",
             "--pictures", "--out", path("out")});
    EXPECT_EQ(run.code, 0) << run.err;
    for (const std::string name : {"one", "two"}) {
        EXPECT_THAT(run.out, HasSubstr("\npictures: " + path("out/" + name + "/images") + "\n"));
        EXPECT_TRUE(fs::exists(folder_ / "out" / name / "images/uncompressed.shaded.png"));
        const nlohmann::json images = nlohmann::json::parse(text_of("out/" + name + "/images/images.json"));
        EXPECT_EQ(images.at("settings"), (nlohmann::json{{"/rays/seed", 5}})) << "of the first variant";
    }
    EXPECT_EQ(cli({"run", path("one.json"), "--pictures", "--shard", "0/1", "--out", path("sweep")}).code, 64);
}

// The probes fit into the memory limit, and what all pixels see does not.
TEST_F(RunOutput, pictures_that_cannot_be_drawn_cost_no_result) {
    const Outcome run =
        cli({"run", path("one.json"), "--pictures", "--memory-limit", "0.001", "--out", path("out"), "--json"});
    EXPECT_EQ(run.code, 65);
    EXPECT_EQ(run.out, text_of("out/result.json")) << "all of it is printed too";
    EXPECT_THAT(run.err, HasSubstr("one.json: /receivers/resolution: "));
    EXPECT_FALSE(fs::exists(folder_ / "out/images"));
    const Outcome both =
        cli({"run", path("one.json"), path("two.json"), "--pictures", "--memory-limit", "0.001", "--out", path("out")});
    EXPECT_EQ(both.code, 65);
    EXPECT_THAT(both.out, HasSubstr("\npictures: none: /receivers/resolution: "));
    EXPECT_TRUE(fs::exists(folder_ / "out/two/result.json")) << "the second runs too";
}

TEST_F(RunOutput, json_and_csv_are_those_of_the_files_and_nothing_else) {
    const Outcome json = cli({"run", path("one.json"), "--out", path("out"), "--json"});
    EXPECT_EQ(json.code, 0) << json.err;
    EXPECT_EQ(json.out, text_of("out/result.json"));
    const Outcome csv = cli({"run", path("one.json"), "--out", path("out"), "--csv"});
    EXPECT_EQ(csv.out, text_of("out/result.csv"));
    EXPECT_EQ(cli({"run", path("one.json"), "--json", "--csv"}).code, 64);
    EXPECT_EQ(cli({"run", path("one.json"), "--json", "--wide"}).code, 64);
    EXPECT_EQ(cli({"run", path("one.json"), "--json", "--shard", "0/1", "--out", path("sweep")}).code, 64);
}

TEST_F(RunOutput, json_and_csv_of_several_scenarios_are_one_document) {
    const Outcome json = cli({"run", path("one.json"), path("two.json"), "--out", path("out"), "--json"});
    const nlohmann::json all = nlohmann::json::parse(json.out);
    ASSERT_EQ(all.size(), 2u);
    EXPECT_EQ(all[0].at("name"), "one");
    EXPECT_EQ(all[1], nlohmann::json::parse(text_of("out/two/result.json")));
    const Outcome csv = cli({"run", path("one.json"), path("two.json"), "--out", path("out"), "--csv"});
    const std::string two = text_of("out/two/result.csv");
    EXPECT_EQ(csv.out, text_of("out/one/result.csv") + two.substr(two.find('\n') + 1)) << "one header";
}

TEST_F(RunOutput, quiet_prints_nothing_but_writes_the_files) {
    const Outcome quiet = cli({"run", path("one.json"), "--out", path("out"), "--quiet"});
    EXPECT_EQ(quiet.code, 0);
    EXPECT_EQ(quiet.out + quiet.err, "");
    EXPECT_TRUE(fs::exists(folder_ / "out/result.json"));
    EXPECT_THAT(cli({"run", path("gone.json"), "--quiet"}).err, HasSubstr("gone.json")) << "errors are said";
    ASSERT_EQ(cli({"run", path("one.json"), "--shard", "0/1", "--out", path("sweep"), "--quiet"}).out, "");
    const Outcome merged = cli({"merge", path("sweep"), "--out", path("merged"), "--json"});
    EXPECT_EQ(merged.out, text_of("merged/result.json")) << merged.err;
    EXPECT_EQ(cli({"merge", path("sweep"), "--out", path("merged"), "--quiet"}).out, "");
    EXPECT_THAT(cli({"merge", path("sweep"), "--out", path("merged")}).out, HasSubstr("\nwritten: "));
}

// Standard output is a terminal of this many columns while it lives.
class Terminal {
public:
    explicit Terminal(unsigned short columns) : before_(dup(STDOUT_FILENO)) {
        winsize size{};
        size.ws_col = columns;
        if (openpty(&front_, &back_, nullptr, nullptr, &size) == 0) dup2(back_, STDOUT_FILENO);
    }
    ~Terminal() {
        dup2(before_, STDOUT_FILENO);
        for (const int file : {before_, front_, back_})
            if (file >= 0) close(file);
    }
    bool open() const { return front_ >= 0; }
    // What was printed, a few kilobytes at most.
    std::string shown() const {
        std::string text(1 << 13, '\0');
        const ssize_t size = read(front_, text.data(), text.size());
        text.resize(size > 0 ? static_cast<std::size_t>(size) : 0);
        return text;
    }
    Terminal(const Terminal&) = delete;
    Terminal& operator=(const Terminal&) = delete;

private:
    int before_, front_ = -1, back_ = -1;
};

TEST(TerminalStyle, is_that_of_the_terminal_or_of_the_environment) {
    const Variable no_columns("COLUMNS", nullptr), colour("NO_COLOR", nullptr), kind("TERM", "xterm");
    std::ostringstream file;
    EXPECT_EQ(line_width(file), 100u);
    EXPECT_FALSE(shows_colour(file));
    const Variable columns("COLUMNS", "72");
    EXPECT_EQ(line_width(file), 72u);
    for (const char* wrong : {"", "0", "-5", "many", "80x", "99999999999999999999"}) {
        const Variable odd("COLUMNS", wrong);
        EXPECT_EQ(line_width(file), 100u) << wrong;
    }
}

TEST(TerminalStyle, has_colour_on_a_terminal_that_wants_it) {
    const Variable no_columns("COLUMNS", nullptr), colour("NO_COLOR", nullptr), kind("TERM", "xterm");
    std::cout << std::flush;
    std::size_t width = 0;
    bool open = false, plain = true, refused = true, dumb = true;
    {
        const Terminal terminal(87);
        open = terminal.open();
        width = line_width(std::cout);
        plain = !shows_colour(std::cout);
        const Variable set("NO_COLOR", "1");
        refused = shows_colour(std::cout);
        const Variable unset("NO_COLOR", ""), no_colours("TERM", "dumb");
        dumb = shows_colour(std::cout);
    }
    if (!open) GTEST_SKIP() << "no pseudo terminal can be opened here";
    EXPECT_EQ(width, 87u);
    EXPECT_FALSE(plain);
    EXPECT_FALSE(refused) << "NO_COLOR";
    EXPECT_FALSE(dumb);
}

// Otherwise a terminal breaks them inside of words, below the names.
TEST_F(RunOutput, lists_break_long_lines_on_a_terminal_only) {
    std::ofstream(folder_ / "long.json") << R"({"name": "long", "purpose": "twelve words that are too many for a line )"
                                            R"(of so narrow a terminal", "scene": {"objects": []}})";
    const std::string folder = folder_.string();
    const Variable scenarios("SHADOWBENCH_SCENARIOS", folder.c_str());
    const fs::path before = fs::current_path();
    fs::current_path(folder_);
    const std::string plain = cli({"list", "scenarios"}).out;
    std::string shown;
    bool opened = false;
    std::cout << std::flush;
    {
        const Terminal terminal(40);
        const char* const words[] = {"shadowbench", "list", "scenarios"};
        opened = terminal.open();
        if (opened) {
            cli_main(3, words, std::cout, std::cerr);
            shown = terminal.shown();
        }
    }
    fs::current_path(before);
    EXPECT_THAT(plain, HasSubstr("long  twelve words that are too many for a line of so narrow a terminal\n"));
    if (!opened) GTEST_SKIP() << "no pseudo terminal can be opened here";
    EXPECT_THAT(shown,
                HasSubstr("long  twelve words that are too many for\r\n        a line of so narrow a terminal\r\n"));
    EXPECT_THAT(shown, HasSubstr("      " + path("long.json") + "\r\n")) << "whole, to be copied";
}

}  // namespace
}  // namespace shadowbench::service
