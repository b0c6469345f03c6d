// Counts for Prometheus.
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
    // One answer. `route` is a pattern of the route table, so that there are few; "none" where there was no route.
    void count(const std::string& method, const std::string& route, int status, double seconds);

    // In Prometheus' text format, with the jobs by state.
    std::string text(const Jobs& jobs, std::size_t event_streams) const;

private:
    struct Latency {
        std::vector<std::uint64_t> buckets;  // not cumulated; the last one has no bound
        double sum = 0.0;
    };
    mutable std::mutex mutex_;
    std::map<std::vector<std::string>, std::uint64_t> requests_;  // method, route, code
    std::map<std::string, Latency> latencies_;                    // by route
};

}  // namespace shadowbench::service
