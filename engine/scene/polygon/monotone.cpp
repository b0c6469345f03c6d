#include "scene/polygon/monotone.h"

namespace shadowbench::scene {
namespace {

// Drops triangles without area.
void emit(std::uint32_t a, std::uint32_t b, std::uint32_t c, const std::vector<GridPoint>& points,
          std::vector<Triple>& triangles) {
    if (turn(points[a], points[b], points[c]) > 0) triangles.push_back({a, b, c});
}

}  // namespace

void MonotonePolygon::add(std::uint32_t point, Side side, const std::vector<GridPoint>& points,
                          std::vector<Triple>& triangles) {
    if (side != side_ && open_.size() > 1) {
        const std::uint32_t top = last();
        finish(point, points, triangles);
        open_ = {top};
    }
    side_ = side;
    while (open_.size() > 1) {
        const std::uint32_t before = open_[open_.size() - 2];
        const std::int64_t bend = turn(points[before], points[last()], points[point]);
        if (side == Side::lower ? bend <= 0 : bend >= 0) break;
        if (side == Side::lower)
            triangles.push_back({before, last(), point});
        else
            triangles.push_back({last(), before, point});
        open_.pop_back();
    }
    open_.push_back(point);
}

void MonotonePolygon::finish(std::uint32_t point, const std::vector<GridPoint>& points,
                             std::vector<Triple>& triangles) {
    for (std::size_t i = 0; i + 1 < open_.size(); ++i)
        if (side_ == Side::lower)
            emit(open_[i], open_[i + 1], point, points, triangles);
        else
            emit(open_[i + 1], open_[i], point, points, triangles);
    open_.clear();
}

}  // namespace shadowbench::scene
