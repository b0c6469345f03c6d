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
    std::shared_ptr<const bench::StoredRays> rays;  // null if the attempt was refused before they were captured
    double build_ms = 0.0;                          // without capturing

    std::string failed() const { return contender.ok() ? "" : contender.cell.reason; }
    double ns_per_segment(double ms) const {
        const std::uint64_t segments = rays->source->segments();
        return segments > 0 ? 1e6 * ms / static_cast<double>(segments) : 0.0;
    }
    double capture_ms() const {
        return contender.row->traits.traces ? 0.0 : 1e3 * (rays->setup_seconds + rays->capture_seconds);
    }
};

// One point of a confirmation: the map of the scenario's own seed and its times.
struct Trials::Timed {
    std::size_t index = 0;  // of the point
    Setting setting;
    Attempt attempt;
    bench::LookupPlan plan{};
    std::vector<double> capture_ms{}, build_ms{};
};

inline constexpr const char* no_curve = "stores no function, so it has no error of stored functions";

}  // namespace shadowbench::recommend
