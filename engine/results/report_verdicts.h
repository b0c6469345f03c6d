// Verdicts on every technique over many scenarios, as text. Neither clock nor machine enters it: the same scenarios
// give the same text.
#pragma once

#include <span>
#include <string>

#include "results/result.h"

namespace shadowbench::results {

struct ScenarioOutcome {
    Result result;      // only name and purpose if the scenario could not be run
    std::string error;  // why it could not be run; empty if it was
};

// `techniques` are the ids of the matrix's columns, in order. Techniques that no scenario has are left out.
//
// Markdown: the rule, a matrix of scenarios and techniques with default parameters (the worst of their cells), then a
// section for each scenario with a table for each light.
std::string verdicts_markdown(std::span<const ScenarioOutcome> outcomes, std::span<const std::string> techniques);

// For a terminal: the matrix, the counts, and all failures.
std::string verdicts_text(std::span<const ScenarioOutcome> outcomes, std::span<const std::string> techniques);

}  // namespace shadowbench::results
