// Queues scenarios as jobs, runs each in a child process, one or a few at a time, and keeps them with their results in
// one folder. An accepted job survives any kill: see service/store.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "service/jobs/tally.h"
#include "service/log/log.h"
#include "service/store/owner_limits.h"

namespace shadowbench::service {

enum class JobState { queued, running, succeeded, failed, cancelled };
const char* to_string(JobState state);
std::optional<JobState> parse_job_state(const std::string& text);

struct JobProgress {
    std::string stage, place;
    std::uint64_t done = 0, total = 0;
    double fraction = 0.0;  // of the whole job; never decreases
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
    std::string recommend;                  // as in its JobRequest
    bool cached = false;                    // answered from the result of an earlier job
    std::optional<bool> promises_kept;      // of a job that succeeded; of a recommendation: a setting reaches the error
    std::optional<std::uint64_t> position;  // of a queued job: number of jobs before it
    std::optional<JobProgress> progress;    // while it runs
    std::optional<JobFault> fault;          // of a failed job
    std::uint64_t revision = 0;             // grows with every change of the job; the id of its events
    std::string owner = {};                 // the name of the token that it came with; empty: none
    std::vector<std::string> labels = {};
    int priority = 0;         // among the jobs of its owner
    bool pinned = false;      // retention does not remove it
    std::uint64_t bytes = 0;  // of its results
};

struct JobRequest {
    std::string scenario;    // JSON text, validated by the caller
    std::string name, hash;  // of the scenario
    std::uint64_t seed = 0;
    bool pictures = true;
    std::string recommend = {};   // JSON text of a recommend::Request: find its answer; empty: run the scenario
    bool reuse = true;            // an earlier result of the same request and program version may be the answer
    std::string idempotency_key;  // empty: none
    std::string owner = {};
    std::vector<std::string> labels = {};  // without control characters
    int priority = 0;
};

struct Submitted {
    // existing: same key and request; conflict: same key, another request; owner_queue_full, owner_bytes: the owner has
    // reached a limit of JobLimits::owners.
    enum class Outcome { created, existing, conflict, queue_full, owner_queue_full, owner_bytes } outcome;
    JobInfo job;
};

// Which jobs have ended long enough ago, or are too many or too large, to be removed with their results. Pinned jobs
// never are, and count for none of these. Nothing: no limit.
struct Retention {
    std::optional<double> days = {};          // since they ended
    std::optional<std::size_t> jobs = {};     // that have ended; the latest stay
    std::optional<std::uint64_t> bytes = {};  // of results; the latest stay
};

struct JobLimits {
    std::size_t queue = 2000;                    // jobs that may wait; more are refused
    double seconds = 3600.0;                     // that one run may take
    std::size_t memory = std::size_t{16} << 30;  // bytes that a run may take
    int attempts = 3;                            // runs of a job whose process dies
    int parallel = 1;                            // jobs that run at a time
    double grace = 10.0;                         // seconds that stop() waits for running jobs before it requeues them
    std::uint64_t min_free = 0;                  // bytes of the disk that must be free for a job to start
    LimitsByOwner owners = {};
    Retention retention = {};
    std::string launcher = {};  // starts jobs on other machines: see launched.h; empty: here
};

// The disk of the state folder.
struct JobStorage {
    bool fails = false;                 // jobs wait because the server cannot write to it
    bool gone = false;                  // the state folder or its database was removed or replaced: nothing can be kept
    std::optional<std::uint64_t> free;  // bytes; nothing where it does not say
    std::uint64_t min_free = 0;         // as in JobLimits
    bool is_low() const { return free && *free < min_free; }  // jobs wait for space
    bool holds_jobs() const { return fails || gone || is_low(); }
};

// Which jobs a list has; nothing, or an empty text: all.
struct JobFilter {
    std::optional<JobState> state = {};
    std::string owner = {}, label = {};
    std::string text = {};  // in its id, name, owner, labels or fault
};

struct JobPage {
    std::vector<JobInfo> jobs;  // newest first
    std::string next;           // cursor of the next page; empty: this is the last
};

// Arguments of each run beyond those of Jobs, and what tells its results from those of runs with others.
struct FurtherArguments {
    std::vector<std::string> words;
    std::string key;
};

class Jobs {
public:
    // Opens or makes the folder `state` (see state_folder.h), requeues the jobs that ran when the last server died,
    // adopts results that the database does not know, and starts the workers. They run `program job FOLDER --data
    // DIR...` with further arguments. `log` gets what happens to jobs, files that were moved aside, adopted results,
    // and storage that fails and works again. Its lines name folders of the machine. Throws base::Error{usage} for a
    // folder of another program, {io} where it is not writable or another server holds it.
    Jobs(std::filesystem::path state, std::string program, std::vector<std::string> data, JobLimits limits,
         Log log = {}, FurtherArguments further = {});
    ~Jobs();
    Jobs(const Jobs&) = delete;
    Jobs& operator=(const Jobs&) = delete;

    // The job is on the disk once it returns. Throws base::Error{io} when the state folder is gone.
    Submitted submit(const JobRequest& request);
    std::optional<JobInfo> find(const std::string& id) const;
    // `cursor` is a JobPage::next; empty: from the newest. Throws base::Error{usage} for any other text.
    JobPage list(const JobFilter& filter, std::size_t limit, const std::string& cursor) const;
    std::size_t count(JobState state) const;
    std::uint64_t bytes() const;  // of all results
    JobTally tally() const;

    enum class Change { done, not_found, refused };
    Change cancel(const std::string& id);  // refused: the job has ended
    Change remove(const std::string& id);  // refused: the job is running
    // Whether retention passes the job over. Also noted in its results, which outlive the database.
    Change pin(const std::string& id, bool pinned);

    // Queues a job that failed or was cancelled once more, at its old place and with all its attempts. refused: it is
    // in another state; busy: its last run is still ending; full: too many jobs wait. Throws as submit() does.
    enum class Retry { queued, not_found, refused, busy, full };
    Retry retry(const std::string& id);

    // The text of the scenario, and a file of the results by its relative path ("result.json", "images/reference.png").
    // Nothing when the job or file does not exist, the job has not succeeded, or the path leads out of the folder.
    std::optional<std::string> scenario(const std::string& id) const;
    std::optional<std::filesystem::path> artifact(const std::string& id, const std::string& name) const;
    std::vector<std::string> artifacts(const std::string& id) const;

    // Blocks until the job's revision is above `revision`, the job is removed, stop() is called, or `seconds` have
    // passed; returns the job. Many threads may wait.
    std::optional<JobInfo> wait(const std::string& id, std::uint64_t revision, double seconds) const;

    // Whether jobs wait because the state folder cannot be written, for example on a full disk.
    bool storage_fails() const;
    JobStorage storage() const;

    // Starts no more jobs. Running jobs have `grace` seconds to finish; then they are killed and requeued. Ends all
    // waits.
    void stop();
    bool stopping() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace shadowbench::service
