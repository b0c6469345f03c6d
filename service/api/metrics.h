// Counts requests and jobs for Prometheus.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace shadowbench::service {

class Jobs;

// Thread-safe.
class Metrics {
public:
    // Counts one answer. `route` is a pattern of the route table, which bounds the number of labels; "none" without a
    // route.
    void count(const std::string& method, const std::string& route, int status, double seconds);

    // All counts in Prometheus' text format, with the jobs by state.
    std::string text(const Jobs& jobs, std::size_t event_streams) const;

private:
    struct Latency {
        std::vector<std::uint64_t> buckets;  // not cumulative; the last one has no upper bound
        double sum = 0.0;
    };
    mutable std::mutex mutex_;
    std::map<std::vector<std::string>, std::uint64_t> requests_;  // method, route, code
    std::map<std::string, Latency> latencies_;                    // by route
};

}  // namespace shadowbench::service
