#include "service/jobs/news.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "service/jobs/utc.h"

namespace shadowbench::service {
namespace {

LogEvent about(LogLevel level, const char* what, const std::string& id) {
    return {level, "job", what, {{"job", id}}};
}

}  // namespace

void JobNews::queued(const StoredJob& job) {
    {
        const std::scoped_lock lock(mutex_);
        ++tally_.submitted;
        if (job.cached) ++tally_.reused;
    }
    LogEvent event = about(LogLevel::info, job.cached ? "reused" : "queued", job.id);
    event.fields.push_back({"name", job.name});
    if (!job.owner.empty()) event.fields.push_back({"owner", job.owner});
    say(log_, event);
}

void JobNews::retried(const std::string& id) {
    {
        const std::scoped_lock lock(mutex_);
        ++tally_.retried;
    }
    say(log_, about(LogLevel::info, "retried", id));
}

void JobNews::started(const StoredJob& job) {
    const std::optional<double> waited = job.attempts == 1 ? seconds_between(job.queued, job.started) : std::nullopt;
    {
        const std::scoped_lock lock(mutex_);
        ++tally_.runs;
        if (waited) tally_.waits.add(std::max(*waited, 0.0));  // the clock may have been set back
    }
    LogEvent event = about(LogLevel::info, "started", job.id);
    event.fields.push_back({"attempt", std::int64_t{job.attempts}});
    if (waited) event.fields.push_back({"waited", *waited});
    say(log_, event);
}

void JobNews::ended(const StoredJob& job, const std::string& state, const std::string& why, double seconds) {
    {
        const std::scoped_lock lock(mutex_);
        ++tally_.ended[state];
        tally_.seconds.add(seconds);
    }
    LogEvent event = about(why.empty() ? LogLevel::info : LogLevel::warning, state.c_str(), job.id);
    event.fields.push_back({"seconds", seconds});
    event.fields.push_back({"attempt", std::int64_t{job.attempts}});
    if (!why.empty()) event.fields.push_back({"reason", why});
    say(log_, event);
}

void JobNews::cancelled(const std::string& id) {
    {
        const std::scoped_lock lock(mutex_);
        ++tally_.ended[job_states::cancelled];
    }
    say(log_, about(LogLevel::info, job_states::cancelled, id));
}

void JobNews::requeued(const StoredJob& job, const char* reason, const std::string& why) {
    {
        const std::scoped_lock lock(mutex_);
        ++tally_.requeued[reason];
    }
    LogEvent event = about(LogLevel::warning, "requeued", job.id);
    event.fields.push_back({"attempt", std::int64_t{job.attempts}});
    event.fields.push_back({"reason", why.empty() ? reason : why});
    say(log_, event);
}

void JobNews::removed(const std::string& id, const char* reason) {
    {
        const std::scoped_lock lock(mutex_);
        ++tally_.removed[reason];
    }
    LogEvent event = about(LogLevel::info, "removed", id);
    event.fields.push_back({"reason", std::string(reason)});
    say(log_, event);
}

void JobNews::recovered(const std::string& line) {
    say(log_, {LogLevel::warning, "recovery", line});
}

void JobNews::storage(const std::string& line) {
    say(log_, {LogLevel::warning, "storage", line});
}

JobTally JobNews::tally() const {
    const std::scoped_lock lock(mutex_);
    return tally_;
}

}  // namespace shadowbench::service
