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

bool Floors::Seen::bounds() const {
    return accurate.size() >= witnesses;
}

std::vector<Floor> Floors::known() const {
    std::vector<Floor> floors;
    for (const auto& [rays, seen] : seen_)
        if (seen.bounds()) floors.push_back({rays.first, rays.second, seen.error});
    return floors;
}

std::vector<Floor> Floors::all() const {
    std::vector<Floor> floors;
    for (const auto& [rays, seen] : seen_)
        if (!seen.accurate.empty() || seen.any.size() >= hints) floors.push_back({rays.first, rays.second, seen.error});
    return floors;
}

std::optional<Floor> Floors::add(const Family& family, const Point& point, double error) {
    if (!family.faithful) return {};
    Seen& seen = seen_[{point.step[0], point.step[1]}];
    const bool bounded = seen.bounds(), lower = error < seen.error;
    seen.error = std::min(seen.error, error);
    bool news = seen.any.insert(point.family).second || lower;
    if (accurate(point.step, steps_of(family))) news = seen.accurate.insert(point.family).second || news;
    if (news) ++version_;
    if (!seen.bounds() || (bounded && !lower)) return {};
    return Floor{point.step[0], point.step[1], seen.error};
}

}  // namespace shadowbench::recommend
