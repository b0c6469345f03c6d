// The climb of a family: all axes together, from the cheapest to the most accurate setting.
#pragma once

#include <cstddef>
#include <vector>

#include "recommend/lab.h"

namespace shadowbench::recommend {

// How many rungs all climbs have above the first: as many as the light rays' axes have coarse steps, so that all
// families meet the same light rays.
int ladder_rungs(const std::vector<Family>& families);

// The points of one family's climb. Rungs that are the same point count once.
std::vector<Point> ladder(const Family& family, std::size_t number, int rungs);

// If two rungs lower the error to more than this share of it, a family gets no better.
inline constexpr double flat_share = 0.9;

}  // namespace shadowbench::recommend
