// The points of one family, numbered; the last axis runs fastest.
#pragma once

#include <cstddef>
#include <vector>

#include "recommend/lab.h"

namespace shadowbench::recommend {

class Lattice {
public:
    Lattice(const Family& family, std::size_t number) : family_(number) {
        for (const Axis& axis : family.axes) {
            steps_.push_back(axis.steps());
            size_ *= static_cast<std::size_t>(axis.steps());
        }
        for (std::size_t i = 0; i < size_; ++i) points_.push_back(point_of(i));
    }

    std::size_t size() const { return size_; }
    std::size_t axes() const { return steps_.size(); }
    int steps(std::size_t axis) const { return steps_[axis]; }
    const std::vector<int>& steps() const { return steps_; }

    const Point& point(std::size_t index) const { return points_[index]; }
    std::size_t index(const std::vector<int>& step) const {
        std::size_t index = 0;
        for (std::size_t i = 0; i < steps_.size(); ++i)
            index = index * static_cast<std::size_t>(steps_[i]) + static_cast<std::size_t>(step[i]);
        return index;
    }

private:
    Point point_of(std::size_t index) const {
        Point point{family_, std::vector<int>(steps_.size())};
        for (std::size_t i = steps_.size(); i-- > 0;) {
            point.step[i] = static_cast<int>(index % static_cast<std::size_t>(steps_[i]));
            index /= static_cast<std::size_t>(steps_[i]);
        }
        return point;
    }

    std::size_t family_;
    std::vector<int> steps_;
    std::size_t size_ = 1;
    std::vector<Point> points_;
};

// Whether every step of `a` is at most that of `b`: b then costs at least as much, and errs at most as much.
inline bool at_most(const std::vector<int>& a, const std::vector<int>& b) {
    for (std::size_t i = 0; i < a.size(); ++i)
        if (a[i] > b[i]) return false;
    return true;
}

}  // namespace shadowbench::recommend
