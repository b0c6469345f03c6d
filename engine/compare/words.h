// What the forms of a report share. Internal.
#pragma once

#include <string>
#include <vector>

#include "compare/compare.h"

namespace shadowbench::compare {

// How the times were judged: a sentence.
std::string method(const Comparison& comparison);

std::string values_text(const Line& line);  // "237828 -> 237829", "5.29 -> 5.92 ns"
std::string change_text(const Line& line);  // "x1.120 [1.090, 1.150] in 20 pairs; reason", or the reason alone
std::string front_text(const FrontChange& change);
std::string counts_text(const Comparison& comparison);   // "larger 1, same 84"
std::string outcome_text(const Comparison& comparison);  // "exit code 2: larger or less accurate"

// Neither the same nor folded: what a reader has to see.
bool is_news(const Line& line);

// The worst first; of equals in the order they have.
std::vector<const Line*> by_severity(const Comparison& comparison);

}  // namespace shadowbench::compare
