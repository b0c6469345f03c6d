#include "service/api/metric_families.h"

#include <limits>
#include <utility>

#include <prometheus/metric_family.h>

#include "service/jobs/jobs.h"

namespace shadowbench::service {
namespace {

using prometheus::ClientMetric;
using prometheus::MetricFamily;
using prometheus::MetricType;

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

// Counters that have not counted yet are there too: the rate of one that appears with its first event lacks that event.
std::map<std::string, std::uint64_t> with_zeros(std::map<std::string, std::uint64_t> counts,
                                                std::initializer_list<const char*> names) {
    for (const char* name : names) counts.try_emplace(name, 0);
    return counts;
}

}  // namespace

MetricFamily gauge_family(const char* name, const char* help, double value) {
    MetricFamily result = family(name, help, MetricType::Gauge);
    result.metric.push_back(gauge(value));
    return result;
}

MetricFamily counter_family(const char* name, const char* help, double value) {
    MetricFamily result = family(name, help, MetricType::Counter);
    ClientMetric metric;
    metric.counter.value = value;
    result.metric.push_back(std::move(metric));
    return result;
}

MetricFamily counter_family(const char* name, const char* help, const char* label,
                            const std::map<std::string, std::uint64_t>& counts) {
    MetricFamily result = family(name, help, MetricType::Counter);
    for (const auto& [value, count] : counts) {
        ClientMetric metric;
        metric.label = {{label, value}};
        metric.counter.value = static_cast<double>(count);
        result.metric.push_back(std::move(metric));
    }
    return result;
}

MetricFamily empty_histogram_family(const char* name, const char* help) {
    return family(name, help, MetricType::Histogram);
}

void add_histogram(MetricFamily& to, const Histogram& histogram, const MetricLabels& labels) {
    ClientMetric metric;
    for (const auto& [name, value] : labels) metric.label.push_back({name, value});
    std::uint64_t below = 0;
    for (std::size_t i = 0; i < histogram.counts.size(); ++i) {
        below += histogram.counts[i];
        const bool last = i == histogram.bounds.size();
        metric.histogram.bucket.push_back(
            {below, last ? std::numeric_limits<double>::infinity() : histogram.bounds[i]});
    }
    metric.histogram.sample_count = below;
    metric.histogram.sample_sum = histogram.sum;
    to.metric.push_back(std::move(metric));
}

std::vector<MetricFamily> job_families(const Jobs& jobs) {
    const JobTally tally = jobs.tally();
    const JobStorage disk = jobs.storage();
    std::vector<MetricFamily> families{jobs_by_state(jobs)};
    const auto add_gauge = [&](const char* name, const char* help, double value) {
        families.push_back(gauge_family(name, help, value));
    };
    const auto add_counter = [&](const char* name, const char* help, std::uint64_t value) {
        families.push_back(counter_family(name, help, static_cast<double>(value)));
    };
    add_gauge("shadowbench_queue_length", "Jobs in the queue.", static_cast<double>(jobs.count(JobState::queued)));
    add_counter("shadowbench_jobs_submitted_total", "Jobs that were accepted.", tally.submitted);
    add_counter("shadowbench_jobs_reused_total", "Jobs that an earlier result answered.", tally.reused);
    add_counter("shadowbench_jobs_retried_total", "Jobs that were queued once more.", tally.retried);
    add_counter("shadowbench_job_runs_total", "Runs of jobs that began (attempts).", tally.runs);
    families.push_back(counter_family("shadowbench_jobs_ended_total", "Jobs that ended, by state.", "state",
                                      with_zeros(tally.ended, {"succeeded", "failed", "cancelled"})));
    families.push_back(counter_family("shadowbench_jobs_requeued_total", "Runs after which a job waits again.",
                                      "reason", with_zeros(tally.requeued, {"died", "killed", "stopped", "storage"})));
    families.push_back(counter_family("shadowbench_jobs_removed_total", "Jobs that were removed, by reason.", "reason",
                                      with_zeros(tally.removed, {"request", "age", "number", "space"})));
    MetricFamily seconds =
        empty_histogram_family("shadowbench_job_seconds", "Seconds of the runs that succeeded or failed.");
    add_histogram(seconds, tally.seconds, {});
    families.push_back(std::move(seconds));
    MetricFamily waits =
        empty_histogram_family("shadowbench_job_wait_seconds", "Seconds that jobs waited for their first run.");
    add_histogram(waits, tally.waits, {});
    families.push_back(std::move(waits));
    add_gauge(
        "shadowbench_storage_failing",
        "1 while no job starts because the state folder cannot be written, is gone, or has too little free space.",
        disk.holds_jobs() ? 1.0 : 0.0);
    if (disk.free)
        add_gauge("shadowbench_storage_free_bytes", "Free bytes on the disk of the state folder.",
                  static_cast<double>(*disk.free));
    add_gauge("shadowbench_storage_min_free_bytes", "Bytes that must be free for a job to start (--min-free).",
              static_cast<double>(disk.min_free));
    add_gauge("shadowbench_results_bytes", "Bytes of the results of all jobs.", static_cast<double>(jobs.bytes()));
    return families;
}

}  // namespace shadowbench::service
