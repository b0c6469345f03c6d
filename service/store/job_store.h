// The jobs that a server has accepted, in one SQLite file. A call that changes something returns once the change is on
// the disk. Thread-safe: changes happen one after the other, and readers do not wait for the disk. Every call can throw
// base::Error{io}, or DamagedStore for a damaged file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "service/store/owner_limits.h"

namespace shadowbench::service {

// The values of the column "state".
namespace job_states {
inline constexpr const char *queued = "queued", *running = "running", *succeeded = "succeeded", *failed = "failed",
                            *cancelled = "cancelled";
}

struct StoredFault {
    int code = 0;
    std::string where, message;
};

// Two jobs with equal values have the same result: the result of one may answer the other.
struct ResultKey {
    std::string hash;  // of the scenario
    std::uint64_t seed = 0;
    std::string program;  // version
    bool pictures = true;
    std::string recommend = {};  // what a recommendation was asked; empty: the scenario is run as it stands
};

struct StoredJob {
    std::int64_t sequence = 0;  // grows with each job
    std::string id, state, name;
    ResultKey key;
    bool cached = false;
    std::string created, started, ended;  // empty: not yet
    std::string queued = {};              // when it last came into the queue, but for runs that were cut short
    std::string owner = {};               // empty: none
    std::vector<std::string> labels = {};
    int priority = 0;
    bool pinned = false;      // it is not removed for its age or the space that it takes
    std::uint64_t bytes = 0;  // of its results
    int attempts = 0;
    std::optional<bool> kept;  // whether its promises were kept
    std::optional<StoredFault> fault;
    std::uint64_t revision = 0;
    std::optional<std::uint64_t> ahead;  // of a queued job: the number of jobs that are taken before it
};

struct NewJob {
    std::string id, name;
    ResultKey key;
    std::string scenario, created;
    std::string idempotency_key, request;  // request: must be equal when the key is used again; empty key: none
    std::optional<bool> kept;              // set: the job has already ended, with the result of another
    std::uint64_t bytes = 0;               // of that result
    std::string owner = {};
    std::vector<std::string> labels = {};  // without line breaks
    int priority = 0;
};

// A job that has succeeded, with all that the store knows about it. job.sequence, job.revision and job.ahead are
// unused.
struct KeptJob {
    StoredJob job;
    std::string scenario, idempotency_key, request;
};

struct Ending {
    std::string state, ended;
    std::optional<bool> kept;
    std::optional<StoredFault> fault;
    std::uint64_t bytes = 0;
};

// Which jobs a list has; an empty text: all.
struct StoreFilter {
    std::string state = {}, owner = {}, label = {};
    std::string text = {};  // a part of the id, name, owner, labels or fault of the job, in upper or lower case
};

class JobStore {
public:
    // Creates the file, or checks that it is a complete job store of a known version. That of an earlier version gets
    // what it lacks.
    explicit JobStore(const std::filesystem::path& file);
    ~JobStore();
    JobStore(const JobStore&) = delete;
    JobStore& operator=(const JobStore&) = delete;

    struct Added {
        enum class Outcome { added, existing, conflict, full, owner_full, owner_bytes } outcome;
        StoredJob job;  // unset for full and the like; for conflict the job that has the key
    };
    // full: `most_queued` jobs wait already; owner_full, owner_bytes: so many of its owner do, or the results of the
    // owner's jobs take so much. A job that has ended is never refused.
    Added add(const NewJob& job, std::size_t most_queued, const OwnerLimits& limits = {});

    // The job of this key, as add() would return it; nothing for a new key.
    std::optional<Added> find_key(const std::string& key, const std::string& request) const;

    // Takes a queued job: it is running now, and its attempts grow by one. Owners take turns; of an owner's jobs the
    // one of the highest priority is taken, of those the oldest. An owner who has `running` jobs that run is passed
    // over.
    std::optional<StoredJob> claim(const std::string& started, const LimitsByOwner& limits = {});

    // These change a job only if it is in the state of their name. Return its new revision; nothing for another state.
    std::optional<std::uint64_t> end_running(const std::string& id, const Ending& ending);
    std::optional<std::uint64_t> end_waiting(const std::string& id, const Ending& ending);  // queued or running
    // uncounted: the attempt does not count against the limit.
    std::optional<std::uint64_t> requeue_running(const std::string& id, bool uncounted);

    enum class Retry { queued, not_found, refused, full };
    struct Retried {
        Retry outcome;
        std::uint64_t revision;  // of a job that was queued
    };
    // Queues a job that failed or was cancelled at its old place, as if it had not run; refused: another state.
    // `program`: the version that will run it.
    Retried retry(const std::string& id, const std::string& program, std::size_t most_queued,
                  const LimitsByOwner& limits = {});

    bool remove(const std::string& id);  // only a job that is not running

    std::optional<std::uint64_t> set_pinned(const std::string& id, bool pinned);  // the new revision; nothing: no job
    void set_bytes(const std::string& id, std::uint64_t bytes);

    // Adds jobs whose results are complete, all or none: jobs that the store does not have, and jobs that it has as
    // queued or running. A key that another job has stays with that job.
    void adopt(const std::vector<KeptJob>& jobs);

    std::optional<StoredJob> find(const std::string& id) const;
    std::optional<std::string> scenario(const std::string& id) const;
    struct Key {
        std::string key, request;
    };
    std::optional<Key> key_of(const std::string& id) const;  // nothing for a job without a key
    // Newest first, older than `before` (0: from the newest).
    std::vector<StoredJob> list(const StoreFilter& filter, std::size_t limit, std::int64_t before) const;
    std::size_t count(const std::string& state) const;
    std::uint64_t bytes() const;  // of all results

    struct Ended {
        std::string id, ended;
        std::uint64_t bytes;
    };
    std::vector<Ended> list_removable() const;  // jobs that have ended and are not pinned, the first to end first
    // The newest job of this key that has succeeded.
    std::optional<StoredJob> find_result(const ResultKey& key) const;

    // Moves what the write-ahead log holds to its place in the file, so that the next changes take its space instead of
    // more.
    void reuse_log();

    // Larger than all earlier revisions, also those of earlier servers.
    std::uint64_t next_revision();

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace shadowbench::service
