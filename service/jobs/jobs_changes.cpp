// The parts of Jobs that cancel, remove, pin and retry jobs.
#include <chrono>
#include <filesystem>
#include <mutex>
#include <optional>

#include "service/jobs/folders.h"
#include "service/jobs/jobs_state.h"
#include "service/jobs/record.h"
#include "service/jobs/utc.h"

namespace shadowbench::service {
namespace {

constexpr std::chrono::seconds longest_end{5};  // that a request waits for the process of a cancelled job

}  // namespace

Jobs::Change Jobs::cancel(const std::string& id) {
    State& all = *state_;
    const auto revision = all.write_at_last([&] {
        return all.store.end_waiting(id, {job_states::cancelled, now_utc(), {}, {}, 0});
    });
    if (!revision) return all.store.find(id) ? Change::refused : Change::not_found;
    all.board.cancel(id);
    all.board.announce(*revision, true);
    all.news.cancelled(id);
    return Change::done;
}

// Removes the files before the row, so that it works on a full disk, and leaves no results without a job, which the
// next start would adopt. If the server dies in between, the next start completes the removal.
Jobs::Change Jobs::State::remove(const StoredJob& job, const char* reason) {
    if (job.state == job_states::running) return Change::refused;
    const bool had_results = job.state == job_states::succeeded && unpublish(folders, job.id);
    const std::filesystem::path removed = removed_folder(folders, job.id);
    if (had_results) empty_folder(removed);
    if (!write_at_last([&] { return store.remove(job.id); }))
        return store.find(job.id) ? Change::refused : Change::not_found;
    if (had_results) remove_folder(removed);
    board.announce(write_at_last([&] { return store.next_revision(); }), true);
    news.removed(job.id, reason);
    return Change::done;
}

void Jobs::State::remove_unpinned(const std::string& id, const char* reason) {
    const std::scoped_lock lock(pinning);
    const std::optional<StoredJob> job = store.find(id);
    const bool ended = job && job->state != job_states::queued && job->state != job_states::running;
    if (ended && !job->pinned) remove(*job, reason);
}

Jobs::Change Jobs::remove(const std::string& id) {
    const std::optional<StoredJob> job = state_->store.find(id);
    return job ? state_->remove(*job, "request") : Change::not_found;
}

Jobs::Change Jobs::pin(const std::string& id, bool pinned) {
    State& all = *state_;
    all.presence.check();
    const std::scoped_lock lock(all.pinning);
    const std::optional<StoredJob> job = all.store.find(id);
    if (!job) return Change::not_found;
    if (job->state == job_states::succeeded) pin_in_record(all.folders.jobs / id, pinned);
    const auto revision = all.store.set_pinned(id, pinned);
    if (!revision) return Change::not_found;
    all.board.announce(*revision, false);
    return Change::done;
}

// A job ends a moment before its run, which uses the folder that the next run gets.
Jobs::Retry Jobs::retry(const std::string& id) {
    State& all = *state_;
    all.presence.check();
    const auto end = JobBoard::Clock::now() + longest_end;
    const auto try_once = [&]() -> std::optional<JobStore::Retried> {
        // Retention must not remove the job after it has seen that it had ended.
        const std::scoped_lock lock(all.pinning, all.board.starting);
        const std::optional<StoredJob> job = all.store.find(id);
        const bool ended = job && (job->state == job_states::failed || job->state == job_states::cancelled);
        if (job && all.board.has_run(id))
            return ended ? std::nullopt : std::optional(JobStore::Retried{JobStore::Retry::refused, 0});
        return all.store.retry(id, all.version, all.place.limits.queue, all.place.limits.owners);
    };
    std::optional<JobStore::Retried> retried = try_once();
    for (; !retried; retried = try_once()) {
        if (all.board.stopping() || JobBoard::Clock::now() > end) return Retry::busy;
        all.board.pause(std::chrono::milliseconds(10));
    }
    switch (retried->outcome) {
        case JobStore::Retry::not_found:
            return Retry::not_found;
        case JobStore::Retry::refused:
            return Retry::refused;
        case JobStore::Retry::full:
            return Retry::full;
        case JobStore::Retry::queued:
            break;
    }
    all.news.retried(id);
    all.board.announce(retried->revision, true);
    all.board.add_work();
    return Retry::queued;
}

}  // namespace shadowbench::service
