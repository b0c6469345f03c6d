// What Trials knows of one map. Internal to it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bench/lookup_timing.h"
#include "recommend/trials.h"

namespace shadowbench::recommend {

// One map with everything that was measured on it.
struct Trials::Attempt {
    bench::Contender contender;
    std::shared_ptr<const bench::Frame> frame;      // null if the attempt was refused before rays were captured
    std::shared_ptr<const bench::StoredRays> rays;  // null if there is no more to check, or nothing was captured
    std::uint64_t segments = 0;
    double capture_ms = 0.0;  // 0 for what uses no light rays
    double build_ms = 0.0;    // without capturing

    std::string failed() const { return contender.ok() ? "" : contender.cell.reason; }
    double ns_per_segment(double ms) const { return segments > 0 ? 1e6 * ms / static_cast<double>(segments) : 0.0; }
};

// A map that is built and checked, for other settings that store the same map.
struct Trials::Kept {
    Setting setting;
    Attempt attempt;
};

// One point of a confirmation: the map of the scenario's own seed and its times.
struct Trials::Timed {
    std::size_t index = 0;  // of the point
    Setting setting;
    std::size_t lookups = 0;  // of one pass
    Attempt attempt;
    bench::LookupPlan plan{};
    std::vector<double> capture_ms{}, build_ms{};
};

// Whether two settings store the same map, so that only their lookups differ.
bool same_map(const Setting& a, const Setting& b);

inline constexpr double large_map = 64e6;  // bytes: filling the memory of larger ones takes most of the time
inline constexpr int seeds = 5;            // of a confirmation, the scenario's own among them
inline constexpr int fewer_builds = 3;     // repetitions in a confirmation, if time runs out
inline constexpr double rest_of_a_trial = 0.05;  // seconds: what every measurement takes besides rays and builds
inline constexpr const char* no_curve = "stores no function, so it has no error of stored functions";

}  // namespace shadowbench::recommend
