#include "compare/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "compare/made.h"

namespace shadowbench::compare {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

// One byte more, one technique slower in 20 pairs, one missing.
Comparison changed() {
    json gone = made_result();
    json third = cell_of(gone, 1);
    third["label"] = "filter=<none> | \"b\" & c";
    gone["variants"][0]["lights"][0]["cells"].push_back(third);
    std::vector<json> a(20, gone), b(20, made_result());
    Noise noise(1);
    for (std::size_t i = 0; i < a.size(); ++i) {
        make_times(a[i], noise);
        make_times(b[i], noise, 1, 1.3);
        cell_of(b[i], 0)["bytes"] = 1001;
    }
    Comparison comparison = compare(side(a, "ab"), side(b, "ab"), {});
    comparison.baseline = "old";
    comparison.current = "new";
    comparison.notes.push_back("a note");
    return comparison;
}

TEST(Report, TextListsWhatIsNotTheSameWithItsCommand) {
    const std::string text = to_text(changed(), false);
    EXPECT_THAT(text, HasSubstr("old -> new\n"));
    EXPECT_THAT(text, HasSubstr("made / key / deep tolerance=0.02\n  larger          bytes  1000 -> 1001  +1 (+0.1 %)\n"
                                "  rerun: shadowbench run file.json --set 'techniques="));
    EXPECT_THAT(text, HasSubstr("slower          build"));
    EXPECT_THAT(text, HasSubstr("missing"));
    EXPECT_THAT(text, HasSubstr("note: a note\n"));
    EXPECT_THAT(text, HasSubstr("exit code 2: larger or less accurate"));
    EXPECT_THAT(text, HasSubstr("Holm"));
    EXPECT_THAT(text, HasSubstr("smallest slowdown detected"));
    EXPECT_THAT(text, Not(HasSubstr("nodes.total")));
    EXPECT_THAT(to_text(changed(), true), HasSubstr("nodes.total"));
}

TEST(Report, TextCountsInconclusiveTimesInsteadOfListingThem) {
    const Comparison comparison = compare(side({made_result()}), side({made_result()}), {});
    EXPECT_THAT(to_text(comparison, false), HasSubstr("inconclusive: 6 times: fewer than 4 processes a side"));
    EXPECT_THAT(to_text(comparison, false), Not(HasSubstr("lookup_image")));
    EXPECT_THAT(to_text(comparison, true), HasSubstr("lookup_image"));
}

// Otherwise a narrow terminal breaks the columns of the verdicts.
TEST(Report, TextHasLinesOfTheWidthAskedForButForCommands) {
    std::istringstream lines(to_text(changed(), true, 60));
    int commands = 0;
    for (std::string line; std::getline(lines, line);) {
        const bool command = line.starts_with("  rerun: shadowbench run");
        commands += command;
        EXPECT_LE(command ? 0 : line.size(), 60u) << line;
    }
    EXPECT_GT(commands, 0);
}

TEST(Report, MarkdownIsATableWithBarsEscaped) {
    const std::string text = to_markdown(changed());
    EXPECT_THAT(text, HasSubstr("## shadowbench: exit code 2: larger or less accurate\n"));
    EXPECT_THAT(text, HasSubstr("| larger | made / key / deep tolerance=0.02 | bytes | 1000 -\\> 1001 |"));
    EXPECT_THAT(text, HasSubstr("filter=\\<none\\> \\| "));
    EXPECT_THAT(text, HasSubstr("<code>shadowbench run file.json"));
}

TEST(Report, JUnitHasFailuresOnlyForFailures) {
    const Comparison comparison = changed();
    const std::string text = to_junit(comparison);
    int fails = 0;
    for (const Line& line : comparison.lines) fails += code_of(line, comparison.options) > 0;
    EXPECT_THAT(text, HasSubstr("failures=\"" + std::to_string(fails) + "\""));
    EXPECT_THAT(text, HasSubstr("<testcase classname=\"made / key / deep tolerance=0.02\" name=\"bytes\"><failure "
                                "type=\"larger\" message=\"larger: 1000 -&gt; 1001; +1 (+0.1 %)\">shadowbench run"));
    EXPECT_THAT(text, HasSubstr("filter=&lt;none&gt; | &quot;b&quot; &amp; c"));
    EXPECT_THAT(text, HasSubstr("name=\"nodes.total\"/>"));
}

TEST(Report, JsonHasEverything) {
    const Comparison comparison = changed();
    const json report = json::parse(to_json(comparison).dump());
    EXPECT_EQ(report["schema_version"], 1);
    EXPECT_EQ(report["exit_code"], 2);
    EXPECT_EQ(report["interleaved"], true);
    EXPECT_EQ(report["lines"].size(), comparison.lines.size());
    EXPECT_EQ(report["lines"][0]["verdict"], "larger");
    EXPECT_EQ(report["lines"][0]["code"], 2);
    EXPECT_EQ(report["lines"][0]["current"], 1001);
    EXPECT_EQ(report["counts"]["larger"], 1);
    for (const json& line : report["lines"])
        if (line["cell"] == "uncompressed" && line["measure"] == "build") {
            EXPECT_EQ(line["verdict"], "slower");
            EXPECT_EQ(line["time"]["processes"], 20);
            EXPECT_GT(line["time"]["interval95"][0], 1.05);
        }
}

// Even a comparison of equal builds states the smallest slowdown that it would have found.
TEST(Report, EqualBuildsStateTheSmallestDifference) {
    std::vector<json> a(20, made_result()), b(20, made_result());
    Noise noise(3);
    for (std::size_t i = 0; i < a.size(); ++i) {
        make_times(a[i], noise);
        make_times(b[i], noise);
    }
    const Comparison comparison = compare(side(a, "ab"), side(b, "ab"), {});
    EXPECT_THAT(sensitivity(comparison), HasSubstr("smallest slowdown detected: "));
    EXPECT_EQ(sensitivity(compare(side({made_result()}), side({made_result()}), {})), "");
}

}  // namespace
}  // namespace shadowbench::compare
