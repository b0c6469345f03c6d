// The jobs that a server has accepted, in one SQLite file. A call that changes something returns once the change is on
// the disk. Every call may come from any thread: changes go one after the other, and readers do not wait for the disk.
// Each throws base::Error{io}; DamagedStore where the file is broken.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace shadowbench::service {

// What stands in the column "state".
namespace job_states {
inline constexpr const char *queued = "queued", *running = "running", *succeeded = "succeeded", *failed = "failed",
                            *cancelled = "cancelled";
}

struct StoredFault {
    int code = 0;
    std::string where, message;
};

// What makes a result the same: a job of equal values may answer for another.
struct ResultKey {
    std::string hash;  // of the scenario
    std::uint64_t seed = 0;
    std::string program;  // version
    bool pictures = true;
};

struct StoredJob {
    std::int64_t sequence = 0;  // grows; the order of the queue
    std::string id, state, name;
    ResultKey key;
    bool cached = false;
    std::string created, started, ended;  // empty: not yet
    int attempts = 0;
    std::optional<bool> kept;  // of its promises
    std::optional<StoredFault> fault;
    std::uint64_t revision = 0;
    std::optional<std::uint64_t> ahead;  // jobs that are queued before it, of a queued one
};

struct NewJob {
    std::string id, name;
    ResultKey key;
    std::string scenario, created;
    std::string idempotency_key, request;  // request: what must be equal when the key comes again; empty key: none
    std::optional<bool> kept;              // given: it has ended already, with the result of another
};

// A job that has succeeded, with all that the store knows of it. job: neither sequence, revision nor ahead are used.
struct KeptJob {
    StoredJob job;
    std::string scenario, idempotency_key, request;
};

struct Ending {
    std::string state, ended;
    std::optional<bool> kept;
    std::optional<StoredFault> fault;
};

class JobStore {
public:
    // Makes the file, or checks that it is whole, ours and of a known version.
    explicit JobStore(const std::filesystem::path& file);
    ~JobStore();
    JobStore(const JobStore&) = delete;
    JobStore& operator=(const JobStore&) = delete;

    struct Added {
        enum class Outcome { added, existing, conflict, full } outcome;
        StoredJob job;  // but for full; of a conflict: that which has the key
    };
    // full: as many as `most_queued` wait already; a job that has ended is never refused.
    Added add(const NewJob& job, std::size_t most_queued);

    // The job that came with this key, if any, as add() would answer.
    std::optional<Added> find_key(const std::string& key, const std::string& request) const;

    // The oldest queued job, which now runs, one attempt more.
    std::optional<StoredJob> claim(const std::string& started);

    // These change a job only in the state that they name, and give its new revision; nothing: it is in another.
    std::optional<std::uint64_t> end_running(const std::string& id, const Ending& ending);
    std::optional<std::uint64_t> end_waiting(const std::string& id, const Ending& ending);  // queued or running
    // uncounted: the attempt is not one of those that it may have.
    std::optional<std::uint64_t> requeue_running(const std::string& id, bool uncounted);

    bool remove(const std::string& id);  // one that does not run

    // Takes jobs in whose results lie in their place, all of them or none: those that the store does not have, and
    // those that it has as queued or running. A key that another job has stays with that one.
    void adopt(const std::vector<KeptJob>& jobs);

    std::optional<StoredJob> find(const std::string& id) const;
    std::optional<std::string> scenario(const std::string& id) const;
    struct Key {
        std::string key, request;
    };
    std::optional<Key> key_of(const std::string& id) const;  // that the job came with, if any
    // Newest first, older than `before` (0: from the newest); state empty: any.
    std::vector<StoredJob> list(const std::string& state, std::size_t limit, std::int64_t before) const;
    std::size_t count(const std::string& state) const;
    // The newest that has succeeded.
    std::optional<StoredJob> find_result(const ResultKey& key) const;

    // Above all that were given out before, in earlier servers too.
    std::uint64_t next_revision();

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace shadowbench::service
