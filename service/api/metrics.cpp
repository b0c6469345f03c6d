#include "service/api/metrics.h"

#include <iterator>

#include <prometheus/metric_family.h>
#include <prometheus/text_serializer.h>

#include "service/api/metric_families.h"

namespace shadowbench::service {
namespace {

using prometheus::ClientMetric;
using prometheus::MetricFamily;

const std::vector<double> latency_bounds{0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 10.0};  // s

}  // namespace

void Metrics::count(const std::string& method, const std::string& route, int status, double seconds) {
    const std::scoped_lock lock(mutex_);
    ++requests_[{method, route, std::to_string(status)}];
    latencies_.try_emplace({method, route}, latency_bounds).first->second.add(seconds);
}

std::string Metrics::text(const Jobs& jobs, std::size_t event_streams, double pace) const {
    std::vector<MetricFamily> families = job_families(jobs);
    families.push_back(
        gauge_family("shadowbench_event_streams", "Clients that follow events.", static_cast<double>(event_streams)));
    families.push_back(gauge_family(
        "shadowbench_pace", "Seconds on this machine for one of the machine that estimates are made for, at the start.",
        pace));
    for (MetricFamily& family : process_families()) families.push_back(std::move(family));
    MetricFamily requests =
        counter_family("shadowbench_http_requests_total", "Responses, by method, route and status.", "code", {});
    MetricFamily latencies = empty_histogram_family(
        "shadowbench_http_request_seconds",
        "Seconds from the complete request to its response, by method and route; for events, to their start.");
    const std::scoped_lock lock(mutex_);
    for (const auto& [key, count] : requests_) {
        ClientMetric metric;
        metric.label = {{"method", key[0]}, {"route", key[1]}, {"code", key[2]}};
        metric.counter.value = static_cast<double>(count);
        requests.metric.push_back(std::move(metric));
    }
    for (const auto& [key, latency] : latencies_)
        add_histogram(latencies, latency, {{"method", key.first}, {"route", key.second}});
    families.push_back(std::move(requests));
    families.push_back(std::move(latencies));
    return prometheus::TextSerializer().Serialize(families);
}

}  // namespace shadowbench::service
