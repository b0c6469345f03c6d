// Jobs: scenarios that are queued, run one at a time (or a few) each in a child process of its own, and kept with their
// results under one folder. What is accepted survives any kill: see service/store.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace shadowbench::service {

enum class JobState { queued, running, succeeded, failed, cancelled };
const char* to_string(JobState state);
std::optional<JobState> parse_job_state(const std::string& text);

struct JobProgress {
    std::string stage, place;
    std::uint64_t done = 0, total = 0;
    double fraction = 0.0;  // of the whole job, never falling
};

struct JobFault {
    int code = 0;  // a base::ErrorCode
    std::string where, message;
};

struct JobInfo {
    std::string id;  // "j-" and 16 hexadecimal digits
    JobState state = JobState::queued;
    std::string name, scenario_hash;
    std::uint64_t seed = 0;
    std::string created, started, ended;  // UTC, ISO 8601 with milliseconds; empty: not yet
    int attempts = 0;
    bool pictures = true;
    bool cached = false;                    // answered from the result of an earlier job
    std::optional<bool> promises_kept;      // once it succeeded
    std::optional<std::uint64_t> position;  // of a queued job: jobs before it
    std::optional<JobProgress> progress;    // while it runs
    std::optional<JobFault> fault;          // of a failed job
    std::uint64_t revision = 0;             // grows with every change of this job; the id of its events
};

struct JobRequest {
    std::string scenario;    // JSON text, validated by the caller
    std::string name, hash;  // of it
    std::uint64_t seed = 0;
    bool pictures = true;
    bool reuse = true;            // the result of an earlier job of the same scenario and program version may answer
    std::string idempotency_key;  // empty: none
};

struct Submitted {
    enum class Outcome {
        created,
        existing,
        conflict,
        queue_full
    } outcome;  // existing: same key, same request; conflict: same key, another
    JobInfo job;
};

struct JobLimits {
    std::size_t queue = 2000;                    // jobs that wait; more are refused
    double seconds = 3600.0;                     // of one run
    std::size_t memory = std::size_t{16} << 30;  // bytes a child may take
    int attempts = 3;                            // runs of a job whose process died by itself
    int parallel = 1;
    double grace = 10.0;  // seconds that stop() waits before it requeues what runs
};

struct JobPage {
    std::vector<JobInfo> jobs;  // newest first
    std::string next;           // cursor; empty: no more
};

class Jobs {
public:
    // Opens or makes `state` (see state_folder.h), queues again what ran when the last server died, takes back results
    // that the database does not know, starts the worker. `program` is run as `program job FOLDER --data DIR...`.
    // `say` gets what who watches the server should know, a line each, one at a time: what was found and moved away,
    // results taken back, storage that fails and works again. Its lines name places of the machine.
    // Throws base::Error{usage}: the folder is none of ours; {io}: not writable, or another server holds it.
    Jobs(std::filesystem::path state, std::string program, std::vector<std::string> data, JobLimits limits,
         std::function<void(const std::string& line)> say = {});
    ~Jobs();
    Jobs(const Jobs&) = delete;
    Jobs& operator=(const Jobs&) = delete;

    Submitted submit(const JobRequest& request);  // durable once it returns
    std::optional<JobInfo> find(const std::string& id) const;
    // `cursor` as in JobPage::next; empty: from the newest. Throws base::Error{usage} for a cursor that is none.
    JobPage list(std::optional<JobState> state, std::size_t limit, const std::string& cursor) const;
    std::size_t count(JobState state) const;

    enum class Change { done, not_found, refused };
    Change cancel(const std::string& id);  // refused: it has ended
    Change remove(const std::string& id);  // refused: it runs

    // The scenario's text; a file of the job's folder by its relative path ("result.json", "images/reference.png").
    // Nothing when there is no such job or file, it is not whole yet, or the path leads out of the folder (links, ..).
    std::optional<std::string> scenario(const std::string& id) const;
    std::optional<std::filesystem::path> artifact(const std::string& id, const std::string& name) const;
    std::vector<std::string> artifacts(const std::string& id) const;

    // Blocks until the job's revision is above `revision`, it is gone, stop() was called, or `seconds` have passed;
    // the job then. Cheap for many waiting threads.
    std::optional<JobInfo> wait(const std::string& id, std::uint64_t revision, double seconds) const;

    // While the state folder cannot be written, as on a full disk: jobs wait.
    bool storage_fails() const;

    // No more is started; what runs has `grace` seconds to end, then is killed and queued again. Wakes all waits.
    void stop();
    bool stopping() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace shadowbench::service
