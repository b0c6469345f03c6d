// Every --help and the examples in it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/read_text.h"
#include "document/document.h"
#include "document/technique_choice.h"
#include "service/cli/scenario_files.h"
#include "service/run_cli.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

// As the message about an unknown command lists them.
Words command_names() {
    const std::string text = cli({"frobnicate"}).err, start = "there are: ";
    const std::size_t first = text.find(start) + start.size();
    std::istringstream list(text.substr(first, text.find(" (", first) - first));
    Words names;
    for (std::string name; list >> name;) names.push_back(name.substr(0, name.find(',')));
    return names;
}

std::string help_of(const std::string& command) {
    const Outcome outcome = cli({command, "--help"});
    EXPECT_EQ(outcome.code, 0) << command;
    EXPECT_EQ(outcome.err, "") << command;
    return outcome.out;
}

// The words after "shadowbench" of each example in a help.
std::vector<Words> examples_in(const std::string& help) {
    std::vector<Words> examples;
    std::istringstream text(help.substr(std::min(help.find("\nExample"), help.size())));
    const std::string start = "  shadowbench ";
    for (std::string line; std::getline(text, line);) {
        if (line.rfind(start, 0) != 0) continue;
        std::istringstream words(line.substr(start.size()));
        examples.emplace_back();
        for (std::string word; words >> word;) examples.back().push_back(word);
    }
    return examples;
}

std::string fault_of(const Words& words) {
    std::vector<const char*> argv{"shadowbench"};
    for (const std::string& word : words) argv.push_back(word.c_str());
    return usage_fault(static_cast<int>(argv.size()), argv.data());
}

std::string text_of(const Words& words) {
    std::string text = "shadowbench";
    for (const std::string& word : words) text += " " + word;
    return text;
}

// The values of an option in an example.
Words values_of(const Words& words, const std::string& option) {
    Words values;
    for (std::size_t i = 0; i + 1 < words.size(); ++i)
        if (words[i] == option) values.push_back(words[i + 1]);
    return values;
}

// The scenarios that an example names: of commands that take them first, the words before the first option.
Words scenarios_of(const Words& words) {
    const std::set<std::string> takes_scenarios{"run",    "recommend", "render", "validate",
                                                "export", "baseline",  "submit", "sweep"};
    if (takes_scenarios.count(words[0]) == 0) return {};
    const auto option =
        std::find_if(words.begin(), words.end(), [](const std::string& word) { return word[0] == '-'; });
    return {words.begin() + 1, option};
}

class Help : public ::testing::Test {
protected:
    Help() { fs::current_path(SHADOWBENCH_SOURCE_DIR); }  // where examples are run
    ~Help() override { fs::current_path(before_); }

    // Names in an example that must stay true: scenarios, what --set sets in them, techniques and their parameters.
    void check_names(const Words& words) const {
        for (const std::string& value : values_of(words, "--technique"))
            EXPECT_NO_THROW(document::read_any_technique(value)) << value;
        for (const std::string& value : values_of(words, "--only"))
            EXPECT_NO_THROW(document::read_any_technique(value)) << value;
        for (const std::string& name : scenarios_of(words)) {
            FoundScenarios found;
            ASSERT_NO_THROW(found = find_scenarios(name)) << name;
            for (const std::string& assignment : values_of(words, "--set")) {
                nlohmann::json scenario = nlohmann::json::parse(base::read_text(found.files.at(0)));
                ASSERT_NO_THROW(document::set_value(scenario, assignment)) << assignment;
                EXPECT_NO_THROW(document::check_document(scenario)) << assignment;
            }
        }
    }

private:
    const fs::path before_ = fs::current_path();
};

TEST_F(Help, OfEveryCommandHasOneToThreeExamplesOfItsOwn) {
    ASSERT_GE(command_names().size(), 15u);
    for (const std::string& name : command_names()) {
        const std::vector<Words> examples = examples_in(help_of(name));
        EXPECT_GE(examples.size(), 1u) << name;
        EXPECT_LE(examples.size(), 3u) << name;
        for (const Words& words : examples) EXPECT_EQ(words.at(0), name) << text_of(words);
    }
}

TEST_F(Help, ExamplesOfEveryCommandCanBeRun) {
    for (const std::string& name : command_names())
        for (const Words& words : examples_in(help_of(name))) {
            SCOPED_TRACE(text_of(words));
            EXPECT_EQ(fault_of(words), "");
            check_names(words);
        }
}

// Otherwise a terminal breaks words anywhere, and texts begin at its left edge.
TEST_F(Help, HasLinesOfTheTerminalsWidthButForExamples) {
    const char* const before = std::getenv("COLUMNS");
    const std::string kept = before ? before : "";
    ::setenv("COLUMNS", "80", 1);
    for (const std::string& name : command_names()) {
        std::istringstream lines(help_of(name));
        for (std::string line; std::getline(lines, line);)
            EXPECT_LE(line.starts_with("  shadowbench ") ? 0 : line.size(), 80u) << name << ": " << line;
    }
    EXPECT_NE(help_of("recommend").find("against the truth (rms, max\n                                or p99), or "),
              std::string::npos);
    before ? ::setenv("COLUMNS", kept.c_str(), 1) : ::unsetenv("COLUMNS");
}

TEST_F(Help, OfTheProgramListsTheCommandsAndAFewExamples) {
    const std::string help = cli({"--help"}).out;
    for (const std::string& name : command_names())
        EXPECT_NE(help.find("\n  " + name + " "), std::string::npos) << name;
    const std::vector<Words> examples = examples_in(help);
    EXPECT_GE(examples.size(), 1u);
    EXPECT_LE(examples.size(), 4u);
    for (const Words& words : examples) {
        SCOPED_TRACE(text_of(words));
        EXPECT_EQ(fault_of(words), "");
        check_names(words);
    }
}

// So that the tests above see a broken example.
TEST_F(Help, UsageFaultsAreFoundWithoutRunning) {
    EXPECT_NE(fault_of({"run"}), "");
    EXPECT_NE(fault_of({"run", "quickstart", "--no-such-option"}), "");
    EXPECT_NE(fault_of({"list", "everything"}), "");
    EXPECT_NE(fault_of({"frobnicate"}), "");
    EXPECT_EQ(fault_of({"run", "no_such_scenario"}), "") << "only the arguments are parsed";
}

}  // namespace
}  // namespace shadowbench::service
