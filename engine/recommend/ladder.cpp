#include "recommend/ladder.h"

#include <algorithm>

namespace shadowbench::recommend {

int ladder_rungs(const std::vector<Family>& families) {
    int rungs = 1;
    for (const Family& family : families)
        for (std::size_t axis = 0; axis < 2; ++axis) {
            const Axis& a = family.axes[axis];
            rungs = std::max(rungs, (a.steps() - 1 + a.stride - 1) / a.stride);
        }
    return rungs;
}

std::vector<Point> ladder(const Family& family, std::size_t number, int rungs) {
    std::vector<Point> points;
    for (int rung = 0; rung <= rungs; ++rung) {
        Point point{number, {}};
        for (const Axis& axis : family.axes) point.step.push_back((rung * (axis.steps() - 1) + rungs / 2) / rungs);
        if (points.empty() || !(points.back() == point)) points.push_back(point);
    }
    return points;
}

}  // namespace shadowbench::recommend
