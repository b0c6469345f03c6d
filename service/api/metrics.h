// Counts requests and jobs for Prometheus.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "service/jobs/tally.h"

namespace shadowbench::service {

class Jobs;

// Thread-safe.
class Metrics {
public:
    // Counts one answer. `route` is a pattern of the route table, which bounds the number of labels; "none" without a
    // route.
    void count(const std::string& method, const std::string& route, int status, double seconds);

    // All counts in Prometheus' text format, with those of the jobs, the disk and the process. `pace`: as in
    // ServiceOptions.
    std::string text(const Jobs& jobs, std::size_t event_streams, double pace) const;

private:
    mutable std::mutex mutex_;
    std::map<std::vector<std::string>, std::uint64_t> requests_;          // method, route, code
    std::map<std::pair<std::string, std::string>, Histogram> latencies_;  // by method and route
};

}  // namespace shadowbench::service
