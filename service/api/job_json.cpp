#include "service/api/job_json.h"

#include <nlohmann/json.hpp>

namespace shadowbench::service {
namespace {

using nlohmann::ordered_json;

ordered_json text_or_null(const std::string& text) {
    return text.empty() ? ordered_json(nullptr) : ordered_json(text);
}

template <class Value>
ordered_json or_null(const std::optional<Value>& value) {
    return value ? ordered_json(*value) : ordered_json(nullptr);
}

// What a recommendation was asked. Records of results can be edited by hand.
ordered_json recommend_json(const std::string& text) {
    if (text.empty()) return nullptr;
    ordered_json asked = ordered_json::parse(text, nullptr, false);
    return asked.is_object() ? asked : ordered_json::object();
}

ordered_json progress_json(const std::optional<JobProgress>& progress) {
    if (!progress) return nullptr;
    return {{"stage", progress->stage},
            {"place", progress->place},
            {"done", progress->done},
            {"total", progress->total},
            {"fraction", progress->fraction}};
}

ordered_json fault_json(const std::optional<JobFault>& fault) {
    if (!fault) return nullptr;
    return {{"code", fault->code}, {"where", fault->where}, {"message", fault->message}};
}

}  // namespace

nlohmann::ordered_json to_json(const JobInfo& job, const std::vector<std::string>& artifacts,
                               const std::string& prefix) {
    const std::string self = prefix + "/v1/jobs/" + job.id;
    const bool run = job.recommend.empty();
    const ordered_json good = or_null(job.promises_kept);
    return {{"id", job.id},
            {"kind", run ? "run" : "recommendation"},
            {"state", to_string(job.state)},
            {"name", job.name},
            {"scenario_hash", job.scenario_hash},
            {"seed", job.seed},
            {"created", job.created},
            {"started", text_or_null(job.started)},
            {"ended", text_or_null(job.ended)},
            {"attempts", job.attempts},
            {"position", or_null(job.position)},
            {"progress", progress_json(job.progress)},
            {"pictures", job.pictures},
            {"cached", job.cached},
            {"recommend", recommend_json(job.recommend)},
            {"promises_kept", run ? good : nullptr},
            {"reached", run ? nullptr : good},
            {"error", fault_json(job.fault)},
            {"owner", text_or_null(job.owner)},
            {"labels", job.labels},
            {"priority", job.priority},
            {"pinned", job.pinned},
            {"bytes", job.bytes},
            {"artifacts", artifacts},
            {"links",
             {{"self", self},
              {"events", self + "/events"},
              {"scenario", self + "/scenario"},
              {"result", self + "/result"},
              {"csv", self + "/result.csv"},
              {"report", self + "/report"}}}};
}

nlohmann::ordered_json job_json(const Jobs& jobs, const JobInfo& job, const std::string& prefix) {
    return to_json(job, job.state == JobState::queued ? std::vector<std::string>() : jobs.artifacts(job.id), prefix);
}

bool has_ended(const JobInfo& job) {
    return job.state != JobState::queued && job.state != JobState::running;
}

}  // namespace shadowbench::service
