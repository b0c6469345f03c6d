// What the light rays of a map leave of any function: no technique errs much less than the best of several faithful ones
// that were built from the same rays.
#pragma once

#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "recommend/lab.h"

namespace shadowbench::recommend {

// The least error that faithful families reached with these light rays.
struct Floor {
    int resolution = 0, samples = 0;  // steps of axes 0 and 1
    double error = 0.0;

    bool is_of(const std::vector<int>& step) const { return step[0] == resolution && step[1] == samples; }
    // Whether all families certainly err more than wanted with these light rays, and so with fewer. Filters differ in
    // how much of the rays' noise they remove, by up to a factor of 1.6 where it was measured; 2 is allowed.
    bool exceeds(double wanted) const { return error * 0.5 > wanted; }
    bool rules_out(const std::vector<int>& step, double wanted) const {
        return exceeds(wanted) && step[0] <= resolution && step[1] <= samples;
    }
};

// Whether all axes of a family's own, those from the third on, are in their more accurate half.
bool accurate(const std::vector<int>& step, const std::vector<int>& steps);

class Floors {
public:
    // Takes note of a measured point. Returns the floor at its light rays, if that is a bound, and new or lower.
    std::optional<Floor> add(const Family& family, const Point& point, double error);
    // Those that rest on enough families to be bounds.
    std::vector<Floor> known() const;
    // Those, and others that rest on fewer families: hints.
    std::vector<Floor> all() const;
    // Changes with all().
    std::size_t version() const { return version_; }

private:
    struct Seen {
        std::set<std::size_t> any, accurate;  // families, and those with accurate settings
        double error = std::numeric_limits<double>::infinity();  // the least

        bool bounds() const;
    };
    std::map<std::pair<int, int>, Seen> seen_;
    std::size_t version_ = 0;
};

}  // namespace shadowbench::recommend
