// The families of metrics, as values of prometheus-cpp.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "service/jobs/tally.h"

namespace prometheus {
struct MetricFamily;
}

namespace shadowbench::service {

class Jobs;

using MetricLabels = std::vector<std::pair<std::string, std::string>>;

prometheus::MetricFamily gauge_family(const char* name, const char* help, double value);
prometheus::MetricFamily counter_family(const char* name, const char* help, double value);
// One counter for each value of a label.
prometheus::MetricFamily counter_family(const char* name, const char* help, const char* label,
                                        const std::map<std::string, std::uint64_t>& counts);
prometheus::MetricFamily empty_histogram_family(const char* name, const char* help);
void add_histogram(prometheus::MetricFamily& family, const Histogram& histogram, const MetricLabels& labels);

// The jobs by state, what became of them, and the disk.
std::vector<prometheus::MetricFamily> job_families(const Jobs& jobs);
// process_*, as Prometheus' own libraries name them, and the version of the program.
std::vector<prometheus::MetricFamily> process_families();

}  // namespace shadowbench::service
