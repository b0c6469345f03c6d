#include "results/report_verdicts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <sstream>

#include "results/report.h"

namespace shadowbench::results {
namespace {

const std::vector<std::string> columns{"shadow_map", "deep", "avsm"};

// A cell judged as in bench: by its bound, or by a noise tolerance of 0.125.
Cell cell(const std::string& technique, const std::string& parameters, double curve_max, double bound) {
    Cell judged;
    judged.verdict = std::isfinite(bound) || curve_max <= 0.125 ? Verdict::kept : Verdict::degraded;
    judged.verdict_why = "curve error";
    judged.technique = technique;
    judged.parameters = parameters;
    judged.defaults = parameters.empty();
    judged.error_bound = bound;
    judged.curve = CurveErrors{};
    judged.curve->norms.max = curve_max;
    judged.lookup = LookupErrors{{0.5, 0.0625, 0.125, 0.4}, 0.0};
    judged.bytes = 1234;
    return judged;
}

LightResult light(const std::string& name, std::vector<Cell> cells) {
    LightResult judged;
    judged.name = name;
    judged.segments = 100;
    judged.reference.noise_tolerance = 0.125;
    judged.cells = std::move(cells);
    return judged;
}

// "first": avsm with default nodes exceeds the noise under one of two lights; deep holds its bound; deep with other
// parameters fails. "second" has no avsm. "third" could not be run.
std::vector<ScenarioOutcome> three() {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    std::vector<ScenarioOutcome> outcomes(3);
    outcomes[0].result.name = "first";
    outcomes[0].result.purpose = "What breaks | here.";
    Cell failed = cell("deep", "tolerance=0.5", 0.9, 0.5);
    failed.status = CellStatus::failed;
    failed.reason = "the |value| rises";
    failed.verdict = Verdict::failed;
    failed.verdict_why = failed.reason;
    outcomes[0].result.variants = {
        {{},
         {light("key", {cell("avsm", "", 0.01, infinity), cell("deep", "", 0.01, 0.02)}),
          light("fill", {cell("avsm", "", 0.3, infinity), cell("deep", "", 0.02, 0.02), failed})}}};
    outcomes[1].result.name = "second";
    outcomes[1].result.variants = {{{{"/rays/seed", "2"}}, {light("key", {cell("deep", "", 0.0, 0.02)})}}};
    outcomes[1].result.variants[0].lights[0].segments = 0;
    outcomes[1].result.variants[0].lights[0].cells[0].lookup->norms.rms = 0.126;
    outcomes[2].result.name = "third";
    outcomes[2].error = "/receivers: none is inside";
    return outcomes;
}

std::string line_with(const std::string& text, const std::string& part) {
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);)
        if (line.find(part) != std::string::npos) return line;
    return {};
}

TEST(VerdictsMarkdown, shows_the_worst_of_the_default_techniques_in_its_matrix) {
    const std::string text = verdicts_markdown(three(), columns);
    EXPECT_EQ(line_with(text, "| scenario"), "| scenario | deep | avsm |")
        << "in the given order; techniques that no scenario has are left out";
    EXPECT_EQ(line_with(text, "| first"), "| first | K | D |");
    EXPECT_EQ(line_with(text, "| second"), "| second | K* | - |") << "lookup error above the noise tolerance";
    EXPECT_EQ(line_with(text, "| third"), "| third | not run | not run |");
    EXPECT_NE(text.find("3 scenarios: 4 verdicts kept, 1 degraded, 1 failed; 1 could not be run."), std::string::npos)
        << text;
}

TEST(VerdictsMarkdown, has_a_section_a_scenario_and_a_row_a_cell) {
    const std::string text = verdicts_markdown(three(), columns);
    EXPECT_NE(text.find("## first\n\nWhat breaks | here.\n\nlight key\n\n"), std::string::npos) << text;
    EXPECT_NE(text.find("## second\n\n/rays/seed = 2\n\n"), std::string::npos) << text;
    EXPECT_NE(text.find("The light sees nothing that casts a shadow"), std::string::npos) << text;
    EXPECT_NE(text.find("## third\n\nCould not be run: /receivers: none is inside\n"), std::string::npos) << text;
    EXPECT_EQ(line_with(text, "tolerance=0.5"),
              "| deep tolerance=0.5 | **failed** | 0.9 | 0.0625 | 0.5 | 1234 | 0.0 | 0 | the \\|value\\| rises |");
    EXPECT_EQ(text.back(), '\n');
    EXPECT_NE(text[text.size() - 2], '\n');
}

TEST(VerdictsMarkdown, does_not_depend_on_the_clock_and_the_machine) {
    std::vector<ScenarioOutcome> other = three();
    for (ScenarioOutcome& outcome : other) {
        outcome.result.times = {"2026-01-01T00:00:00Z", 5.0, 8};
        outcome.result.machine = {"another", 99};
        for (VariantResult& variant : outcome.result.variants)
            for (LightResult& light : variant.lights) {
                light.times = {1.0, 2.0, 3.0};
                for (Cell& cell : light.cells) cell.times = CellTimes{};
            }
    }
    EXPECT_EQ(verdicts_markdown(three(), columns), verdicts_markdown(other, columns));
    EXPECT_EQ(verdicts_text(three(), columns), verdicts_text(other, columns));
}

TEST(VerdictsText, names_failed_cells_and_scenarios_that_could_not_be_run) {
    const std::string text = verdicts_text(three(), columns);
    EXPECT_NE(text.find("failed: first (light fill), deep tolerance=0.5: the |value| rises\n"), std::string::npos)
        << text;
    EXPECT_NE(text.find("could not be run: third: /receivers: none is inside\n"), std::string::npos) << text;
    EXPECT_NE(line_with(text, "  first").find("D"), std::string::npos) << text;
    EXPECT_NE(text.find("4 verdicts kept, 1 degraded, 1 failed"), std::string::npos) << text;
}

}  // namespace
}  // namespace shadowbench::results
