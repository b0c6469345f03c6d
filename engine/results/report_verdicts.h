// Many scenarios at once: a verdict for every technique and case. Nothing of the clock or the machine stands in them:
// the same scenarios give the same text.
#pragma once

#include <span>
#include <string>

#include "results/result.h"

namespace shadowbench::results {

struct ScenarioOutcome {
    Result result;      // of a scenario that could not be run: its name and purpose alone
    std::string error;  // why it could not; empty: it was
};

// `techniques`: the ids of the matrix's columns, in their order; those that no scenario has are left out.
//
// Markdown: the rule, a matrix of scenarios and techniques with default parameters (the worst of their cells), then a
// section a scenario with a table a light.
std::string verdicts_markdown(std::span<const ScenarioOutcome> outcomes, std::span<const std::string> techniques);

// For people at a terminal: the matrix, the counts, and what failed.
std::string verdicts_text(std::span<const ScenarioOutcome> outcomes, std::span<const std::string> techniques);

}  // namespace shadowbench::results
