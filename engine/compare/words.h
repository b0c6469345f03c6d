// Texts that all forms of a report share. Internal.
#pragma once

#include <string>
#include <vector>

#include "compare/compare.h"

namespace shadowbench::compare {

// How the times were judged, in words; no full stop at the end.
std::string method(const Comparison& comparison);

std::string values_text(const Line& line);  // "237828 -> 237829", "5.29 -> 5.92 ns"
std::string change_text(const Line& line);  // "x1.120 [1.090, 1.150] in 20 pairs; reason", or only the reason
std::string front_text(const FrontChange& change);
std::string counts_text(const Comparison& comparison);   // "larger 1, same 84"
std::string outcome_text(const Comparison& comparison);  // "exit code 2: larger or less accurate"

// Whether a line is listed: it is neither the same nor only counted.
bool is_news(const Line& line);

// The lines by severity, the worst first; equal ones keep their order.
std::vector<const Line*> by_severity(const Comparison& comparison);

}  // namespace shadowbench::compare
