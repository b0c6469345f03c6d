// The range of the coordinates that every layer computes with.
#pragma once

namespace shadowbench::base {

// Coordinates are stored as float, and their squares must not overflow.
inline constexpr double max_coordinate = 1e18;

// Shorter lengths count as zero: the squares of lengths must not underflow in float either.
inline constexpr double min_length = 1e-18;

}  // namespace shadowbench::base
