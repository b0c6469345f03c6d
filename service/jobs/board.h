// The state of jobs that the threads of a server share besides the store: which jobs run, their progress, and the waits
// for changes.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "service/jobs/jobs.h"

namespace shadowbench::service {

class JobBoard {
public:
    using Clock = std::chrono::steady_clock;

    explicit JobBoard(std::uint64_t queue_revision) : queue_revision_(queue_revision) {}

    // One run of a job, from the time a worker takes it to its end.
    struct Run {
        std::string id;
        bool cancelled = false;
        std::optional<JobProgress> progress;
        std::uint64_t revision = 0;  // of `progress`
    };
    std::shared_ptr<Run> begin(const std::string& id);
    void end(const std::shared_ptr<Run>& run);
    void show(Run& run, JobProgress progress, std::uint64_t revision);
    void cancel(const std::string& id);  // no effect on a job that is not running
    bool is_cancelled(const Run& run) const;
    bool has_run(const std::string& id) const;  // also while a cancelled run ends
    // Held while a worker takes a job from the store and begins its run: else has_run() may not see that run yet.
    std::mutex starting;

    struct Shown {
        std::optional<JobProgress> progress;
        std::uint64_t revision = 0, queue_revision = 0;  // queue_revision: of the last change of places in the queue
    };
    Shown shown(const std::string& id) const;

    // Reports that a job has changed in the store and has this revision; all waits check again. queue_moved: the places
    // of other jobs in the queue may have changed too.
    void announce(std::uint64_t revision, bool queue_moved);
    std::uint64_t changes() const;
    // Waits until changes() differs from `seen`. Returns false when the time is over or the server stops.
    bool wait_for_change(std::uint64_t seen, Clock::time_point until) const;

    // A worker calls the first when it begins to wait for the server's storage, and the second when it ends. They
    // return whether it is the first worker that waits, and the last that waited.
    bool begin_storage_fault();
    bool end_storage_fault();
    bool storage_fails() const;

    void add_work();  // reports that a job was queued
    std::uint64_t work() const;
    void wait_for_work(std::uint64_t seen) const;  // returns also when the server stops
    void pause(std::chrono::milliseconds time) const;

    void stop(Clock::time_point deadline);
    bool stopping() const;
    bool past_deadline() const;

private:
    mutable std::mutex mutex_;
    mutable std::condition_variable changed_;
    std::map<std::string, std::shared_ptr<Run>> runs_;
    std::uint64_t queue_revision_, changes_ = 0, work_ = 0;
    int storage_faults_ = 0;
    bool stopping_ = false;
    Clock::time_point deadline_{};
};

}  // namespace shadowbench::service
