#include "service/api/metrics.h"

#include <algorithm>
#include <array>
#include <limits>

#include <prometheus/metric_family.h>
#include <prometheus/text_serializer.h>

#include "service/jobs/jobs.h"

namespace shadowbench::service {
namespace {

using prometheus::ClientMetric;
using prometheus::MetricFamily;
using prometheus::MetricType;

constexpr std::array bounds{0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 10.0};  // seconds

MetricFamily family(const char* name, const char* help, MetricType type) {
    MetricFamily result;
    result.name = name;
    result.help = help;
    result.type = type;
    return result;
}

ClientMetric gauge(double value, std::vector<ClientMetric::Label> labels = {}) {
    ClientMetric metric;
    metric.label = std::move(labels);
    metric.gauge.value = value;
    return metric;
}

MetricFamily jobs_by_state(const Jobs& jobs) {
    MetricFamily result = family("shadowbench_jobs", "Jobs on this server, by state.", MetricType::Gauge);
    for (const JobState state :
         {JobState::queued, JobState::running, JobState::succeeded, JobState::failed, JobState::cancelled})
        result.metric.push_back(gauge(static_cast<double>(jobs.count(state)), {{"state", to_string(state)}}));
    return result;
}

}  // namespace

void Metrics::count(const std::string& method, const std::string& route, int status, double seconds) {
    const std::scoped_lock lock(mutex_);
    ++requests_[{method, route, std::to_string(status)}];
    Latency& latency = latencies_[route];
    latency.buckets.resize(bounds.size() + 1);
    ++latency
          .buckets[static_cast<std::size_t>(std::lower_bound(bounds.begin(), bounds.end(), seconds) - bounds.begin())];
    latency.sum += seconds;
}

std::string Metrics::text(const Jobs& jobs, std::size_t event_streams) const {
    std::vector<MetricFamily> families{jobs_by_state(jobs)};
    MetricFamily queue = family("shadowbench_queue_length", "Jobs in the queue.", MetricType::Gauge);
    queue.metric.push_back(gauge(static_cast<double>(jobs.count(JobState::queued))));
    MetricFamily storage =
        family("shadowbench_storage_failing", "1 while jobs wait because the server cannot write its state folder.",
               MetricType::Gauge);
    const JobStorage disk = jobs.storage();
    storage.metric.push_back(gauge(disk.fails || disk.gone ? 1.0 : 0.0));
    MetricFamily left =
        family("shadowbench_storage_free_bytes", "Free bytes on the disk of the state folder.", MetricType::Gauge);
    if (disk.free) left.metric.push_back(gauge(static_cast<double>(*disk.free)));
    MetricFamily least = family("shadowbench_storage_min_free_bytes",
                                "Bytes that must be free for a job to start (--min-free).", MetricType::Gauge);
    least.metric.push_back(gauge(static_cast<double>(disk.min_free)));
    MetricFamily streams = family("shadowbench_event_streams", "Clients that follow events.", MetricType::Gauge);
    streams.metric.push_back(gauge(static_cast<double>(event_streams)));
    MetricFamily requests =
        family("shadowbench_http_requests_total", "Responses, by method, route and status.", MetricType::Counter);
    MetricFamily latencies =
        family("shadowbench_http_request_seconds",
               "Seconds from the complete request to its response, by route; for events, to their start.",
               MetricType::Histogram);
    const std::scoped_lock lock(mutex_);
    for (const auto& [key, count] : requests_) {
        ClientMetric metric;
        metric.label = {{"method", key[0]}, {"route", key[1]}, {"code", key[2]}};
        metric.counter.value = static_cast<double>(count);
        requests.metric.push_back(std::move(metric));
    }
    for (const auto& [route, latency] : latencies_) {
        ClientMetric metric;
        metric.label = {{"route", route}};
        std::uint64_t below = 0;
        for (std::size_t i = 0; i < latency.buckets.size(); ++i) {
            below += latency.buckets[i];
            const double bound = i < bounds.size() ? bounds[i] : std::numeric_limits<double>::infinity();
            metric.histogram.bucket.push_back({below, bound});
        }
        metric.histogram.sample_count = below;
        metric.histogram.sample_sum = latency.sum;
        latencies.metric.push_back(std::move(metric));
    }
    for (MetricFamily* other : {&queue, &storage, &left, &least, &streams, &requests, &latencies})
        families.push_back(std::move(*other));
    return prometheus::TextSerializer().Serialize(families);
}

}  // namespace shadowbench::service
