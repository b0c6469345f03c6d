#include "fake_jobs/fake_jobs.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <fstream>
#include <mutex>

#include "base/error.h"

namespace shadowbench::service {

namespace fs = std::filesystem;

const char* to_string(JobState state) {
    switch (state) {
        case JobState::queued:
            return "queued";
        case JobState::running:
            return "running";
        case JobState::succeeded:
            return "succeeded";
        case JobState::failed:
            return "failed";
        case JobState::cancelled:
            break;
    }
    return "cancelled";
}

std::optional<JobState> parse_job_state(const std::string& text) {
    for (const JobState state :
         {JobState::queued, JobState::running, JobState::succeeded, JobState::failed, JobState::cancelled})
        if (text == to_string(state)) return state;
    return {};
}

namespace fake {

struct Shared {
    struct Kept {
        JobInfo info;
        JobRequest request;
    };
    mutable std::mutex mutex;
    mutable std::condition_variable changed;
    std::vector<Kept> jobs;  // oldest first
    JobRequest last;
    fs::path folder;
    JobLimits limits;
    bool stopping = false;
    JobStorage storage;
    JobTally tally;
    std::uint64_t next = 1;

    Kept* find(const std::string& id) {
        const auto found = std::find_if(jobs.begin(), jobs.end(), [&](const Kept& kept) { return kept.info.id == id; });
        return found == jobs.end() ? nullptr : &*found;
    }
    std::size_t count(JobState state) const {
        return static_cast<std::size_t>(
            std::count_if(jobs.begin(), jobs.end(), [&](const Kept& kept) { return kept.info.state == state; }));
    }
    void place_all() {
        std::uint64_t before = 0;
        for (Kept& kept : jobs) {
            kept.info.position.reset();
            if (kept.info.state == JobState::queued) kept.info.position = before++;
        }
    }
};

namespace {

std::mutex registry_mutex;
std::map<const Jobs*, Shared*> registry;

Shared& shared(const Jobs& jobs) {
    const std::scoped_lock lock(registry_mutex);
    return *registry.at(&jobs);
}

}  // namespace
}  // namespace fake

struct Jobs::State : fake::Shared {};

Jobs::Jobs(fs::path state, std::string, std::vector<std::string>, JobLimits limits, Log, FurtherArguments)
    : state_(std::make_unique<State>()) {
    state_->folder = std::move(state);
    state_->limits = limits;
    fs::create_directories(state_->folder);
    const std::scoped_lock lock(fake::registry_mutex);
    fake::registry[this] = state_.get();
}

Jobs::~Jobs() {
    stop();
    const std::scoped_lock lock(fake::registry_mutex);
    fake::registry.erase(this);
}

Submitted Jobs::submit(const JobRequest& request) {
    const std::scoped_lock lock(state_->mutex);
    state_->last = request;
    for (const fake::Shared::Kept& kept : state_->jobs)
        if (!request.idempotency_key.empty() && kept.request.idempotency_key == request.idempotency_key)
            return {kept.request.scenario == request.scenario && kept.request.recommend == request.recommend
                        ? Submitted::Outcome::existing
                        : Submitted::Outcome::conflict,
                    kept.info};
    if (state_->count(JobState::queued) >= state_->limits.queue) return {Submitted::Outcome::queue_full, {}};
    if (limits_of(state_->limits.owners, request.owner).queued) return {Submitted::Outcome::owner_queue_full, {}};
    if (limits_of(state_->limits.owners, request.owner).bytes) return {Submitted::Outcome::owner_bytes, {}};
    fake::Shared::Kept kept;
    kept.request = request;
    char id[32];
    std::snprintf(id, sizeof id, "j-%016llx", static_cast<unsigned long long>(state_->next++));
    kept.info.id = id;
    kept.info.name = request.name;
    kept.info.scenario_hash = request.hash;
    kept.info.seed = request.seed;
    kept.info.pictures = request.pictures;
    kept.info.recommend = request.recommend;
    kept.info.created = "2026-11-25T02:03:04.123Z";
    kept.info.owner = request.owner;
    kept.info.labels = request.labels;
    kept.info.priority = request.priority;
    kept.info.revision = 1;
    state_->jobs.push_back(kept);
    state_->place_all();
    return {Submitted::Outcome::created, state_->jobs.back().info};
}

std::optional<JobInfo> Jobs::find(const std::string& id) const {
    const std::scoped_lock lock(state_->mutex);
    const fake::Shared::Kept* kept = state_->find(id);
    return kept ? std::optional(kept->info) : std::nullopt;
}

JobPage Jobs::list(const JobFilter& filter, std::size_t limit, const std::string& cursor) const {
    const std::scoped_lock lock(state_->mutex);
    std::size_t from = 0;
    if (!cursor.empty()) {
        if (cursor.find_first_not_of("0123456789") != std::string::npos)
            throw base::Error(base::ErrorCode::usage, "cursor", "is none");
        from = std::stoul(cursor);
    }
    JobPage page;
    std::size_t at = 0;
    for (auto kept = state_->jobs.rbegin(); kept != state_->jobs.rend(); ++kept, ++at) {
        const JobInfo& job = kept->info;
        const bool has_label =
            filter.label.empty() || std::find(job.labels.begin(), job.labels.end(), filter.label) != job.labels.end();
        if (at < from || (filter.state && job.state != *filter.state) || !has_label ||
            (!filter.owner.empty() && job.owner != filter.owner) || job.name.find(filter.text) == std::string::npos)
            continue;
        if (page.jobs.size() == limit) {
            page.next = std::to_string(at);
            break;
        }
        page.jobs.push_back(kept->info);
    }
    return page;
}

std::size_t Jobs::count(JobState state) const {
    const std::scoped_lock lock(state_->mutex);
    return state_->count(state);
}

Jobs::Change Jobs::cancel(const std::string& id) {
    const std::scoped_lock lock(state_->mutex);
    fake::Shared::Kept* kept = state_->find(id);
    if (!kept) return Change::not_found;
    if (kept->info.state != JobState::queued && kept->info.state != JobState::running) return Change::refused;
    kept->info.state = JobState::cancelled;
    ++kept->info.revision;
    state_->place_all();
    state_->changed.notify_all();
    return Change::done;
}

Jobs::Change Jobs::remove(const std::string& id) {
    const std::scoped_lock lock(state_->mutex);
    const fake::Shared::Kept* kept = state_->find(id);
    if (!kept) return Change::not_found;
    if (kept->info.state == JobState::running) return Change::refused;
    state_->jobs.erase(state_->jobs.begin() + (kept - state_->jobs.data()));
    state_->changed.notify_all();
    return Change::done;
}

Jobs::Change Jobs::pin(const std::string& id, bool pinned) {
    const std::scoped_lock lock(state_->mutex);
    fake::Shared::Kept* kept = state_->find(id);
    if (!kept) return Change::not_found;
    kept->info.pinned = pinned;
    return Change::done;
}

std::uint64_t Jobs::bytes() const {
    return 0;
}

JobTally Jobs::tally() const {
    const std::scoped_lock lock(state_->mutex);
    return state_->tally;
}

Jobs::Retry Jobs::retry(const std::string& id) {
    const std::scoped_lock lock(state_->mutex);
    fake::Shared::Kept* kept = state_->find(id);
    if (!kept) return Retry::not_found;
    if (kept->info.state != JobState::failed && kept->info.state != JobState::cancelled) return Retry::refused;
    if (state_->count(JobState::queued) >= state_->limits.queue) return Retry::full;
    kept->info.state = JobState::queued;
    kept->info.started = kept->info.ended = "";
    kept->info.attempts = 0;
    kept->info.fault.reset();
    ++kept->info.revision;
    state_->place_all();
    state_->changed.notify_all();
    return Retry::queued;
}

std::optional<std::string> Jobs::scenario(const std::string& id) const {
    const std::scoped_lock lock(state_->mutex);
    const fake::Shared::Kept* kept = state_->find(id);
    return kept ? std::optional(kept->request.scenario) : std::nullopt;
}

std::optional<fs::path> Jobs::artifact(const std::string& id, const std::string& name) const {
    if (!find(id)) return {};
    const fs::path top = state_->folder / id, file = top / name;
    std::error_code fault;
    const fs::path real = fs::canonical(file, fault);
    if (fault || !fs::is_regular_file(real, fault)) return {};
    const fs::path real_top = fs::canonical(top, fault);
    if (std::mismatch(real_top.begin(), real_top.end(), real.begin(), real.end()).first != real_top.end()) return {};
    return file;
}

std::vector<std::string> Jobs::artifacts(const std::string& id) const {
    std::vector<std::string> names;
    std::error_code ignored;
    const fs::path top = state_->folder / id;
    for (fs::recursive_directory_iterator entry(top, ignored), end; entry != end; entry.increment(ignored))
        if (entry->is_regular_file(ignored) && !entry->is_symlink(ignored))
            names.push_back(fs::relative(entry->path(), top).generic_string());
    std::sort(names.begin(), names.end());
    return names;
}

std::optional<JobInfo> Jobs::wait(const std::string& id, std::uint64_t revision, double seconds) const {
    std::unique_lock lock(state_->mutex);
    state_->changed.wait_for(lock, std::chrono::duration<double>(seconds), [&] {
        const fake::Shared::Kept* kept = state_->find(id);
        return state_->stopping || !kept || kept->info.revision > revision;
    });
    const fake::Shared::Kept* kept = state_->find(id);
    return kept ? std::optional(kept->info) : std::nullopt;
}

void Jobs::stop() {
    const std::scoped_lock lock(state_->mutex);
    state_->stopping = true;
    state_->changed.notify_all();
}

bool Jobs::stopping() const {
    const std::scoped_lock lock(state_->mutex);
    return state_->stopping;
}

bool Jobs::storage_fails() const {
    const std::scoped_lock lock(state_->mutex);
    return state_->storage.fails;
}

JobStorage Jobs::storage() const {
    const std::scoped_lock lock(state_->mutex);
    return state_->storage;
}

namespace fake {

void fail_storage(Jobs& jobs, bool fails) {
    Shared& state = shared(jobs);
    const std::scoped_lock lock(state.mutex);
    state.storage.fails = fails;
}

void set_storage(Jobs& jobs, const JobStorage& storage) {
    Shared& state = shared(jobs);
    const std::scoped_lock lock(state.mutex);
    state.storage = storage;
}

void set_tally(Jobs& jobs, const JobTally& tally) {
    Shared& state = shared(jobs);
    const std::scoped_lock lock(state.mutex);
    state.tally = tally;
}

void update(Jobs& jobs, const std::string& id, const std::function<void(JobInfo&)>& change) {
    Shared& state = shared(jobs);
    const std::scoped_lock lock(state.mutex);
    JobInfo& info = state.find(id)->info;
    change(info);
    ++info.revision;
    state.place_all();
    state.changed.notify_all();
}

void run(Jobs& jobs, const std::string& id) {
    update(jobs, id, [](JobInfo& job) {
        job.state = JobState::running;
        job.started = "2026-11-25T02:03:05.000Z";
        job.attempts = 1;
    });
}

void progress(Jobs& jobs, const std::string& id, const JobProgress& progress) {
    update(jobs, id, [&](JobInfo& job) { job.progress = progress; });
}

void succeed(Jobs& jobs, const std::string& id, const std::map<std::string, std::string>& files) {
    for (const auto& [name, content] : files) {
        const fs::path file = folder(jobs, id) / name;
        fs::create_directories(file.parent_path());
        std::ofstream(file, std::ios::binary) << content;
    }
    update(jobs, id, [](JobInfo& job) {
        job.state = JobState::succeeded;
        job.ended = "2026-11-25T02:03:06.000Z";
        job.progress.reset();
        job.promises_kept = true;
    });
}

std::filesystem::path folder(Jobs& jobs, const std::string& id) {
    return shared(jobs).folder / id;
}

JobRequest last_request(Jobs& jobs) {
    Shared& state = shared(jobs);
    const std::scoped_lock lock(state.mutex);
    return state.last;
}

}  // namespace fake
}  // namespace shadowbench::service
