// The range of the coordinates that every layer computes with.
#pragma once

namespace shadowbench::base {

// Coordinates are stored as float; their squares must not overflow.
inline constexpr double max_coordinate = 1e18;

// Lengths below it count as none: their squares must not vanish from floats' products either.
inline constexpr double min_length = 1e-18;

}  // namespace shadowbench::base
