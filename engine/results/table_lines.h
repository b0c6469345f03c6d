// The words that the tables of a result share.
#pragma once

#include <string>

#include "results/result.h"
#include "results/settled.h"

namespace shadowbench::results {

inline constexpr const char* uncertain_legend = "~: a time whose 95 % interval is wider than the scenario's timing.goal.\n";

std::string time_text(double value);
// The median, with a mark if it is uncertain.
std::string time_text(const Sample& sample, const LightResult& light);
// "T? B".
std::string front_text(const Cell& cell);
// "0.24-0.26", with a mark if it covers the truth's uncertainty only.
std::string interval_text(const LookupErrors& errors);

// Whole lines: the name, purpose and notes of the result; what the sweeps set; what stands above and below the rows of
// a light: what was captured, how accurate the truth is, and what was not quiet or not compared.
std::string heading_text(const Result& result);
std::string settings_lines(const VariantResult& variant);
std::string text_above(const LightResult& light, int threads);
std::string text_below(const LightResult& light, const Settling& found);

}  // namespace shadowbench::results
