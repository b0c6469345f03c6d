// What the light rays of a map leave of any function: no technique errs much less than the best of several faithful ones
// that were built from the same rays.
#pragma once

#include <map>
#include <set>
#include <utility>
#include <vector>

#include "recommend/lab.h"

namespace shadowbench::recommend {

// The least error that faithful families reached with these light rays.
struct Floor {
    int resolution = 0, samples = 0;  // steps of axes 0 and 1
    double error = 0.0;
};
// A floor times this is a bound for all families with the same or fewer light rays: filters differ in how much of the
// rays' noise they remove, by up to a factor of 1.6 where it was measured.
inline constexpr double floor_slack = 0.5;

// Whether all axes of a family's own, those from the third on, are in their more accurate half.
bool accurate(const std::vector<int>& step, const std::vector<int>& steps);

class Floors {
public:
    // Takes note of a measured point. Returns the floor at its light rays, if that is a bound, and new or lower.
    const Floor* add(const Family& family, const Point& point, double error);
    // Those that rest on enough families to be bounds.
    const std::vector<Floor>& known() const { return known_; }
    // Those, and others that rest on fewer families: hints.
    std::vector<Floor> all() const;
    // Changes with all().
    std::size_t version() const { return version_; }

private:
    struct Seen {
        std::set<std::size_t> any, accurate;  // families, and those with accurate settings
        double error = 0.0;                   // the least
    };
    std::map<std::pair<int, int>, Seen> seen_;
    std::vector<Floor> known_;
    std::size_t version_ = 0;
};

}  // namespace shadowbench::recommend
