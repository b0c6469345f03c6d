// What happens to jobs, for the log and for the counts.
#pragma once

#include <mutex>
#include <string>

#include "service/jobs/tally.h"
#include "service/log/log.h"
#include "service/store/job_store.h"

namespace shadowbench::service {

// Thread-safe.
class JobNews {
public:
    explicit JobNews(Log log) : log_(std::move(log)) {}

    void queued(const StoredJob& job);  // or answered at once, with the result of another
    void retried(const std::string& id);
    void started(const StoredJob& job);
    // `why`: the fault of a job that failed.
    void ended(const StoredJob& job, const std::string& state, const std::string& why, double seconds);
    void cancelled(const std::string& id);
    // `reason`: "died"; "stopped" or "killed", with the server; "storage".
    void requeued(const StoredJob& job, const char* reason, const std::string& why);
    // `reason`: "request", "age", "number", "space".
    void removed(const std::string& id, const char* reason);
    // What a start found and did, and the storage that fails or works again: a sentence each.
    void recovered(const std::string& line);
    void storage(const std::string& line);

    JobTally tally() const;

private:
    Log log_;
    mutable std::mutex mutex_;
    JobTally tally_;
};

}  // namespace shadowbench::service
