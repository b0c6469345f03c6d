// Counts of what has become of jobs since the server started.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace shadowbench::service {

struct Histogram {
    std::vector<double> bounds;         // upper ones, ascending
    std::vector<std::uint64_t> counts;  // not cumulative; the last one has no bound
    double sum = 0.0;

    explicit Histogram(std::vector<double> upper) : bounds(std::move(upper)), counts(bounds.size() + 1) {}
    void add(double value) {
        ++counts[static_cast<std::size_t>(std::lower_bound(bounds.begin(), bounds.end(), value) - bounds.begin())];
        sum += value;
    }
};

struct JobTally {
    std::uint64_t submitted = 0, reused = 0, retried = 0;  // reused: answered by an earlier result
    std::uint64_t runs = 0;                                // attempts that began
    std::map<std::string, std::uint64_t> ended = {}, requeued = {}, removed = {};  // by state, and by reason
    Histogram seconds{{0.1, 0.3, 1, 3, 10, 30, 60, 120, 300, 600, 1800, 3600}};    // of runs that succeeded or failed
    Histogram waits{{0.01, 0.1, 1, 10, 60, 300, 1800, 3600, 14400, 86400}};        // from the queue to the first run
};

}  // namespace shadowbench::service
