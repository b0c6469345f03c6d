// A comparison as text, Markdown, JUnit XML and JSON. Each line has the command that runs only its cell.
#pragma once

#include <cstddef>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "compare/compare.h"

namespace shadowbench::compare {

// For a terminal: all that is not the same, one block per cell; then fronts and counts. Inconclusive times that do not
// look slower are only counted, unless `all`. In lines of `width` characters, but for the commands.
std::string to_text(const Comparison& comparison, bool all, std::size_t width = std::string::npos);

// The same for a pull request.
std::string to_markdown(const Comparison& comparison);

// One test case per line: a failure if its exit code is above 0; otherwise skipped if it is inconclusive, missing or
// not comparable.
std::string to_junit(const Comparison& comparison);

// The whole comparison. Numbers that do not exist are null.
nlohmann::ordered_json to_json(const Comparison& comparison);

// How finely the times were judged, in words: the smallest slowdown that would have been detected, and that would have
// been called slower, at the quietest, the median and the noisiest time. Empty if no time was judged.
std::string sensitivity(const Comparison& comparison);

}  // namespace shadowbench::compare
