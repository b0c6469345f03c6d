#include "recommend/floors.h"

#include <algorithm>

namespace shadowbench::recommend {
namespace {

constexpr std::size_t witnesses = 4;  // families with accurate settings, before a floor is a bound
constexpr std::size_t hints = 3;      // families with any settings, before a floor is a hint

std::vector<int> steps_of(const Family& family) {
    std::vector<int> steps;
    for (const Axis& axis : family.axes) steps.push_back(axis.steps());
    return steps;
}

}  // namespace

bool accurate(const std::vector<int>& step, const std::vector<int>& steps) {
    for (std::size_t axis = 2; axis < steps.size(); ++axis)
        if (2 * step[axis] < steps[axis] - 1) return false;
    return true;
}

std::vector<Floor> Floors::all() const {
    std::vector<Floor> floors;
    for (const auto& [rays, seen] : seen_)
        if (!seen.accurate.empty() || seen.any.size() >= hints) floors.push_back({rays.first, rays.second, seen.error});
    return floors;
}

const Floor* Floors::add(const Family& family, const Point& point, double error) {
    if (!family.faithful) return nullptr;
    Seen& seen = seen_[{point.step[0], point.step[1]}];
    bool news = seen.any.empty() || error < seen.error;
    seen.error = seen.any.empty() ? error : std::min(seen.error, error);
    news = seen.any.insert(point.family).second || news;
    if (accurate(point.step, steps_of(family))) news = seen.accurate.insert(point.family).second || news;
    if (!news) return nullptr;
    ++version_;
    if (seen.accurate.size() < witnesses) return nullptr;
    const auto there = std::find_if(known_.begin(), known_.end(), [&](const Floor& floor) {
        return floor.resolution == point.step[0] && floor.samples == point.step[1];
    });
    if (there == known_.end()) return &known_.emplace_back(Floor{point.step[0], point.step[1], seen.error});
    if (there->error == seen.error) return nullptr;
    there->error = seen.error;
    return &*there;
}

}  // namespace shadowbench::recommend
