// The values that a search over settings tries for a parameter.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "techniques/technique.h"

namespace shadowbench::techniques {

// The values of a trade: those of numbers from the cheapest to the most accurate, choices in their order. Neighbours
// differ by a factor of about 2^(1/4), or on a linear scale by 1 if the parameter is an integer, else by a sixteenth of
// the range. Numbers have at most three significant digits, and none occurs twice.
std::vector<ParameterValues::Value> values_of(const Trade& trade, std::span<const Parameter> declared);

// How many values apart a first, coarse search tries them: about an octave, or a quarter of a linear range.
int coarse_stride(const Trade& trade, std::size_t values);

// "samples 1 to 1024", "filter point|bilinear|footprint".
std::string to_string(const Trade& trade);

}  // namespace shadowbench::techniques
