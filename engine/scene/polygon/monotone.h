// Triangulates a polygon whose outline is two chains from its first point to its last one, both monotone in the order
// of the sweep, while the points arrive (M. R. Garey, D. S. Johnson, F. P. Preparata, R. E. Tarjan, "Triangulating a
// simple polygon", Information Processing Letters 7(4), 1978).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace shadowbench::scene {

// A point on a grid of whole numbers up to max_grid, so that `turn` is exact.
struct GridPoint {
    std::int64_t x = 0, y = 0;
    friend auto operator<=>(const GridPoint&, const GridPoint&) = default;  // the order of the sweep
};
inline constexpr std::int64_t max_grid = std::int64_t{1} << 30;

// Twice the area of the triangle: positive when a, b, c turn left.
inline std::int64_t turn(const GridPoint& a, const GridPoint& b, const GridPoint& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

enum class Side { lower, upper };

using Triple = std::array<std::uint32_t, 3>;  // indices of points, in a left turn

class MonotonePolygon {
public:
    explicit MonotonePolygon(std::uint32_t first) : open_{first} {}

    // Adds the next point in the order of the sweep; `side` is the chain that it belongs to.
    void add(std::uint32_t point, Side side, const std::vector<GridPoint>& points, std::vector<Triple>& triangles);
    // Adds the last point, where the chains meet.
    void finish(std::uint32_t point, const std::vector<GridPoint>& points, std::vector<Triple>& triangles);

    std::uint32_t last() const { return open_.back(); }
    Side last_side() const { return side_; }

private:
    std::vector<std::uint32_t> open_;  // the points whose triangles are not complete yet: one chain that bends inward
    Side side_ = Side::lower;          // the side of that chain
};

}  // namespace shadowbench::scene
