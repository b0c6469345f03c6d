// A comparison as text, Markdown, JUnit XML and JSON. Each line has the command that runs its cell alone.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "compare/compare.h"

namespace shadowbench::compare {

// For a terminal: what is not the same, a block a cell; inconclusive and not comparable times that do not look slower
// are counted alone, unless `all`. Then fronts, notes and counts.
std::string to_text(const Comparison& comparison, bool all);

// The same for a pull request.
std::string to_markdown(const Comparison& comparison);

// A test case a line; a failure where it asks for an exit code, skipped where it is inconclusive or not comparable.
std::string to_junit(const Comparison& comparison);

// All of it. Numbers that do not exist are null.
nlohmann::ordered_json to_json(const Comparison& comparison);

// How fine the times were judged, in words: the smallest slowdown that would have been told from none, and been called
// slower, at the quietest, the median and the noisiest time. Empty where no time was judged.
std::string sensitivity(const Comparison& comparison);

}  // namespace shadowbench::compare
