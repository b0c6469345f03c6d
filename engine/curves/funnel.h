// The lines that pass through windows of values, one depth after the other.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

namespace shadowbench::curves {

// Keeps the highest and the lowest of the lines that do not rise and pass all windows so far, for the depths ahead
// (O'Rourke 1981). In the plane of slope and offset these lines are a convex polygon; a depth ahead is steeper than all
// its sides, so the extreme lines there are those of the greatest and the least slope. The highest one leans on the
// hull of the lower ends of the windows, which it leaves behind as it turns down, so each window costs O(1) on average.
//
// Depths must increase, and no lower end may lie above an upper end before it: lines could only rise to it.
class Funnel {
public:
    struct Point {
        double z, value;
    };

    // All lines with a value in [low, high] at z.
    void start(double z, double low, double high) {
        floor_.restart({z, low});
        ceiling_.restart({z, high});
        highest_ = {{z, high}, 0.0};
        lowest_ = {{z, low}, -std::numeric_limits<double>::infinity()};
    }

    // The greatest and the least value of these lines at a depth behind the last window.
    double highest(double z) const { return highest_.at(z); }
    double lowest(double z) const { return lowest_.at(z); }

    // Keeps the lines with a value in [low, high] at z; there must be some.
    void pass(double z, double low, double high) {
        if (high < highest_.at(z)) {
            const Point end{z, high};
            while (floor_.more() && side(floor_.first(), floor_.second(), end) >= 0.0) ++floor_.begin;
            highest_ = {end, std::min(slope_of(floor_.first(), end), 0.0)};
        }
        if (low > lowest_.at(z)) {
            const Point end{z, low};
            while (ceiling_.more() && side(ceiling_.first(), ceiling_.second(), end) <= 0.0) ++ceiling_.begin;
            lowest_ = {end, slope_of(ceiling_.first(), end)};
        }
        while (floor_.more() && side(floor_.last_but_one(), floor_.last(), {z, low}) <= 0.0) floor_.points.pop_back();
        floor_.points.push_back({z, low});
        while (ceiling_.more() && side(ceiling_.last_but_one(), ceiling_.last(), {z, high}) >= 0.0)
            ceiling_.points.pop_back();
        ceiling_.points.push_back({z, high});
    }

    std::size_t bytes() const { return (floor_.points.capacity() + ceiling_.points.capacity()) * sizeof(Point); }

private:
    struct Line {
        Point point{0.0, 0.0};
        double slope = 0.0;

        double at(double z) const { return point.value + slope * (z - point.z); }
    };

    // Points [begin, size): the hull of one end of the windows, from where an extreme line leans on it.
    struct Hull {
        std::vector<Point> points;
        std::size_t begin = 0;

        void restart(const Point& point) {
            points.assign(1, point);
            begin = 0;
        }
        bool more() const { return points.size() - begin > 1; }
        const Point& first() const { return points[begin]; }
        const Point& second() const { return points[begin + 1]; }
        const Point& last() const { return points.back(); }
        const Point& last_but_one() const { return points[points.size() - 2]; }
    };

    // Above 0 if b lies above the line from a to c.
    static double side(const Point& a, const Point& b, const Point& c) {
        return (b.value - a.value) * (c.z - a.z) - (c.value - a.value) * (b.z - a.z);
    }
    static double slope_of(const Point& a, const Point& b) { return (b.value - a.value) / (b.z - a.z); }

    Hull floor_, ceiling_;  // of the lower and of the upper ends
    Line highest_, lowest_;
};

// The lines for the depths before, from the last window to the first: with depths and values negated, lines that do not
// rise do not rise either.
class BackwardFunnel {
public:
    explicit BackwardFunnel(Funnel& funnel) : funnel_(funnel) {}

    void start(double z, double low, double high) { funnel_.start(-z, -high, -low); }
    double highest(double z) const { return -funnel_.lowest(-z); }
    double lowest(double z) const { return -funnel_.highest(-z); }
    void pass(double z, double low, double high) { funnel_.pass(-z, -high, -low); }
    // Whether one of the lines has a value in [low, high] at z.
    bool meets(double z, double low, double high) const {
        return std::max(low, lowest(z)) <= std::min(high, highest(z));
    }

private:
    Funnel& funnel_;
};

}  // namespace shadowbench::curves
