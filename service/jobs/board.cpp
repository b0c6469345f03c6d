#include "service/jobs/board.h"

#include <algorithm>
#include <utility>

namespace shadowbench::service {

using Lock = std::unique_lock<std::mutex>;

std::shared_ptr<JobBoard::Run> JobBoard::begin(const std::string& id) {
    auto run = std::make_shared<Run>();
    run->id = id;
    const Lock lock(mutex_);
    runs_[id] = run;
    return run;
}

void JobBoard::end(const std::shared_ptr<Run>& run) {
    const Lock lock(mutex_);
    const auto place = runs_.find(run->id);
    if (place != runs_.end() && place->second == run) runs_.erase(place);  // another run of the job may have begun
}

void JobBoard::show(Run& run, JobProgress progress, std::uint64_t revision) {
    {
        const Lock lock(mutex_);
        if (run.progress) progress.fraction = std::max(progress.fraction, run.progress->fraction);
        run.progress = std::move(progress);
        run.revision = revision;
        ++changes_;
    }
    changed_.notify_all();
}

void JobBoard::cancel(const std::string& id) {
    const Lock lock(mutex_);
    const auto place = runs_.find(id);
    if (place != runs_.end()) place->second->cancelled = true;
}

bool JobBoard::is_cancelled(const Run& run) const {
    const Lock lock(mutex_);
    return run.cancelled;
}

bool JobBoard::has_run(const std::string& id) const {
    const Lock lock(mutex_);
    return runs_.contains(id);
}

JobBoard::Shown JobBoard::shown(const std::string& id) const {
    const Lock lock(mutex_);
    const auto place = runs_.find(id);
    if (place == runs_.end()) return {{}, 0, queue_revision_};
    return {place->second->progress, place->second->revision, queue_revision_};
}

void JobBoard::announce(std::uint64_t revision, bool queue_moved) {
    {
        const Lock lock(mutex_);
        if (queue_moved) queue_revision_ = std::max(queue_revision_, revision);
        ++changes_;
    }
    changed_.notify_all();
}

std::uint64_t JobBoard::changes() const {
    const Lock lock(mutex_);
    return changes_;
}

bool JobBoard::wait_for_change(std::uint64_t seen, Clock::time_point until) const {
    Lock lock(mutex_);
    return changed_.wait_until(lock, until, [&] { return stopping_ || changes_ != seen; }) && !stopping_;
}

bool JobBoard::begin_storage_fault() {
    const Lock lock(mutex_);
    return ++storage_faults_ == 1;
}

bool JobBoard::end_storage_fault() {
    const Lock lock(mutex_);
    return --storage_faults_ == 0;
}

bool JobBoard::storage_fails() const {
    const Lock lock(mutex_);
    return storage_faults_ > 0;
}

void JobBoard::add_work() {
    {
        const Lock lock(mutex_);
        ++work_;
    }
    changed_.notify_all();
}

std::uint64_t JobBoard::work() const {
    const Lock lock(mutex_);
    return work_;
}

void JobBoard::wait_for_work(std::uint64_t seen) const {
    Lock lock(mutex_);
    changed_.wait(lock, [&] { return stopping_ || work_ != seen; });
}

void JobBoard::pause(std::chrono::milliseconds time) const {
    Lock lock(mutex_);
    changed_.wait_for(lock, time, [&] { return stopping_; });
}

void JobBoard::stop(Clock::time_point deadline) {
    {
        const Lock lock(mutex_);
        if (stopping_) return;
        stopping_ = true;
        deadline_ = deadline;
    }
    changed_.notify_all();
}

bool JobBoard::stopping() const {
    const Lock lock(mutex_);
    return stopping_;
}

bool JobBoard::past_deadline() const {
    const Lock lock(mutex_);
    return stopping_ && Clock::now() >= deadline_;
}

}  // namespace shadowbench::service
