// What the threads of a server share about jobs, beside the store: who runs, how far, and who waits for a change.
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

    // One run of a job, from its claim to its end.
    struct Run {
        std::string id;
        bool cancelled = false;
        std::optional<JobProgress> progress;
        std::uint64_t revision = 0;  // of the progress
    };
    std::shared_ptr<Run> begin(const std::string& id);
    void end(const std::shared_ptr<Run>& run);
    void show(Run& run, JobProgress progress, std::uint64_t revision);
    void cancel(const std::string& id);  // that runs here
    bool is_cancelled(const Run& run) const;

    struct Shown {
        std::optional<JobProgress> progress;
        std::uint64_t revision = 0, queue_revision = 0;  // the latter: of the last change of places in the queue
    };
    Shown shown(const std::string& id) const;

    // A job has changed in the store, and has this revision; all waits look again. queue_moved: others' places may have
    // changed with it.
    void announce(std::uint64_t revision, bool queue_moved);
    std::uint64_t changes() const;
    // Returns false once the time is up or the server stops.
    bool wait_for_change(std::uint64_t seen, Clock::time_point until) const;

    // A worker waits because the server's storage fails; each begin has its end. Whether it is the first that waits, or
    // the last that did.
    bool begin_storage_fault();
    bool end_storage_fault();
    bool storage_fails() const;

    void add_work();  // a job was queued
    std::uint64_t work() const;
    void wait_for_work(std::uint64_t seen) const;  // or for the end
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
