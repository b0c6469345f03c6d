#include "service/jobs/jobs_state.h"

#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdint>
#include <random>
#include <system_error>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/hash_text.h"
#include "results/program.h"
#include "service/jobs/board.h"
#include "service/jobs/folders.h"
#include "service/jobs/record.h"
#include "service/jobs/recover.h"
#include "service/jobs/retention.h"
#include "service/jobs/room.h"
#include "service/jobs/state_folder.h"
#include "service/jobs/utc.h"
#include "service/jobs/worker.h"
#include "service/store/job_store.h"
#include "service/store/presence.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;
using base::Error;
using base::ErrorCode;

constexpr std::size_t longest_page = 1000;
constexpr std::pair<JobState, const char*> state_names[] = {{JobState::queued, job_states::queued},
                                                            {JobState::running, job_states::running},
                                                            {JobState::succeeded, job_states::succeeded},
                                                            {JobState::failed, job_states::failed},
                                                            {JobState::cancelled, job_states::cancelled}};

std::string check_program(const std::string& program) {
    if (::access(program.c_str(), X_OK) != 0)
        throw Error(ErrorCode::io, program, "cannot execute the program that runs jobs");
    return program;
}

std::string new_id() {
    std::random_device random;
    return fmt::format("j-{:08x}{:08x}", random(), random());
}

// Requests with the same idempotency key must have the same hash.
std::string request_hash(const JobRequest& request) {
    const std::string recommend = request.recommend.empty() ? "" : request.recommend + " ";
    std::string text = fmt::format("{} {} {}{}", request.pictures, request.reuse, recommend, request.scenario);
    // Only where there is any of these, so that keys of earlier versions stay valid.
    if (!request.owner.empty() || !request.labels.empty() || request.priority != 0) {
        text += fmt::format("\n{}\n{}", request.owner, request.priority);
        for (const std::string& label : request.labels) text += "\n" + label;
    }
    return base::hash_text(text);
}

std::int64_t read_cursor(const std::string& cursor) {
    if (cursor.empty()) return 0;
    std::int64_t before = 0;
    const char* const end = cursor.data() + cursor.size();
    const auto [rest, failed] = std::from_chars(cursor.data(), end, before);
    if (failed != std::errc() || rest != end || before <= 0)
        throw Error(ErrorCode::usage, "cursor", "not a cursor of a list of jobs; use \"next\" of the page before");
    return before;
}

JobInfo info_of(const StoredJob& job, JobBoard::Shown shown) {
    JobInfo info;
    info.id = job.id;
    info.state = parse_job_state(job.state).value_or(JobState::failed);
    info.name = job.name;
    info.scenario_hash = job.key.hash;
    info.seed = job.key.seed;
    info.created = job.created;
    info.started = job.started;
    info.ended = job.ended;
    info.attempts = job.attempts;
    info.pictures = job.key.pictures;
    info.recommend = job.key.recommend;
    info.cached = job.cached;
    if (info.state == JobState::succeeded) info.promises_kept = job.kept;
    if (job.fault) info.fault = {job.fault->code, job.fault->where, job.fault->message};
    info.position = job.ahead;
    info.owner = job.owner;
    info.labels = job.labels;
    info.priority = job.priority;
    info.pinned = job.pinned;
    info.bytes = job.bytes;
    info.revision = job.revision;
    if (info.state == JobState::queued) {
        info.revision = std::max(info.revision, shown.queue_revision);
    } else if (info.state == JobState::running && shown.revision > job.revision) {
        info.progress = std::move(shown.progress);
        info.revision = shown.revision;
    }
    return info;
}

Submitted::Outcome outcome_of(JobStore::Added::Outcome outcome) {
    using From = JobStore::Added::Outcome;
    using To = Submitted::Outcome;
    switch (outcome) {
        case From::added:
            return To::created;
        case From::existing:
            return To::existing;
        case From::conflict:
            return To::conflict;
        case From::owner_full:
            return To::owner_queue_full;
        case From::owner_bytes:
            return To::owner_bytes;
        case From::full:
            break;
    }
    return To::queue_full;
}

}  // namespace

std::string program_version(const std::string& further) {
    const results::Program build = results::this_program();
    return fmt::format("{} {}{}{}", build.version, build.commit, further.empty() ? "" : " ", further);
}

const char* to_string(JobState state) {
    for (const auto& [known, name] : state_names)
        if (known == state) return name;
    return "";
}

std::optional<JobState> parse_job_state(const std::string& text) {
    for (const auto& [state, name] : state_names)
        if (text == name) return state;
    return std::nullopt;
}

Jobs::State::State(const fs::path& path, const std::string& program, const std::vector<std::string>& data,
                   JobLimits limits, Log log, const FurtherArguments& further)
    : version(program_version(further.key)),
      checked_program(check_program(program)),
      news(std::move(log)),
      folder(path, [this](const std::string& line) { news.recovered(line); }),
      folders(make_job_folders(path)),
      reserve(path / "shadowbench-reserve", folders.work),
      opened(open_store(folder, folders, [this](const std::string& line) { news.recovered(line); })),
      store(*opened),
      presence({path, folder.database()}),
      board(store.next_revision()),
      place{store,         board,           presence,
            folders,       checked_program, data,
            further.words, limits,          hidden_folders(path.string(), data),
            news,          reserve} {
    reserve.take();
    const std::vector<StoredJob> cut_off = store.list({job_states::running}, INT32_MAX, 0);
    recover(folder, store, folders, [this](const std::string& line) { news.recovered(line); });
    for (const StoredJob& job : cut_off)
        if (const auto now = store.find(job.id); now && now->state == job_states::queued)
            news.requeued(job, "killed", "");
}

void Jobs::State::reuse_result(NewJob& job) {
    const std::optional<StoredJob> earlier = store.find_result(job.key);
    if (!earlier) return;
    const fs::path work = copy_folder(folders, job.id);
    try {
        make_work_folder(work);
        KeptJob kept;
        kept.scenario = job.scenario;
        kept.idempotency_key = job.idempotency_key;
        kept.request = job.request;
        kept.job.id = job.id;
        kept.job.name = job.name;
        kept.job.key = job.key;
        kept.job.cached = true;
        kept.job.created = kept.job.started = kept.job.ended = job.created;
        kept.job.kept = earlier->kept;
        kept.job.owner = job.owner;
        kept.job.labels = job.labels;
        kept.job.priority = job.priority;
        write_record(work, kept);  // so that a start knows whose folder it is
        link_files(folders.jobs / earlier->id, work);
        write_record(work, kept);  // with the checksums of the files
        // A removal takes all files away before the row. The row still exists, so all files were linked.
        if (find_file_in(work, "result.json") && store.find(earlier->id)) {
            const std::uint64_t bytes = bytes_in(work);
            publish(folders, work, job.id);
            job.kept = earlier->kept;
            job.bytes = bytes;
            return;
        }
    } catch (const Error&) {
        // The job is run instead.
    }
    remove_folder(work);
}

Jobs::Jobs(fs::path state, std::string program, std::vector<std::string> data, JobLimits limits, Log log,
           FurtherArguments further)
    : state_(std::make_unique<State>(state, program, data, limits, std::move(log), further)) {
    State& all = *state_;
    for (int i = 0; i < std::max(limits.parallel, 1); ++i)
        all.workers.emplace_back([&place = std::as_const(all.place)] { run_jobs(place); });
    const Retention& keep = limits.retention;
    if (keep.days || keep.jobs || keep.bytes)
        all.sweeper = std::thread([&all] {
            sweep(all.place, [&](const std::string& id, const char* reason) { all.remove_unpinned(id, reason); });
        });
}

Jobs::~Jobs() {
    stop();
}

Submitted Jobs::submit(const JobRequest& request) {
    State& all = *state_;
    all.presence.check();
    NewJob job;
    job.request = request_hash(request);
    if (!request.idempotency_key.empty())
        if (const auto known = all.store.find_key(request.idempotency_key, job.request))
            return {outcome_of(known->outcome), info_of(known->job, all.board.shown(known->job.id))};
    job.id = new_id();
    job.name = request.name;
    job.key = {request.hash, request.seed, all.version, request.pictures, request.recommend};
    job.scenario = request.scenario;
    job.created = now_utc();
    job.idempotency_key = request.idempotency_key;
    job.owner = request.owner;
    job.labels = request.labels;
    job.priority = request.priority;
    if (request.reuse) all.reuse_result(job);

    JobStore::Added added{};
    const auto forget_files = [&] {
        if (job.kept) discard_results(all.folders, job.id);
    };
    try {
        added = all.store.add(job, all.place.limits.queue, limits_of(all.place.limits.owners, job.owner));
    } catch (...) {
        forget_files();
        throw;
    }
    const Submitted::Outcome outcome = outcome_of(added.outcome);
    if (outcome == Submitted::Outcome::created) {
        all.news.queued(added.job);
        if (!job.kept) all.board.add_work();
    } else {
        forget_files();
    }
    if (added.job.id.empty()) return {outcome, {}};
    return {outcome, info_of(added.job, all.board.shown(added.job.id))};
}

std::optional<JobInfo> Jobs::find(const std::string& id) const {
    // The board first: if the run ends between the two, the row in the store is newer and counts.
    JobBoard::Shown shown = state_->board.shown(id);
    const std::optional<StoredJob> job = state_->store.find(id);
    return job ? std::optional(info_of(*job, std::move(shown))) : std::nullopt;
}

JobPage Jobs::list(const JobFilter& filter, std::size_t limit, const std::string& cursor) const {
    const std::int64_t before = read_cursor(cursor);
    limit = std::clamp<std::size_t>(limit, 1, longest_page);
    // One more job than the page has shows whether there is a next page.
    const StoreFilter wanted{filter.state ? to_string(*filter.state) : "", filter.owner, filter.label, filter.text};
    std::vector<StoredJob> jobs = state_->store.list(wanted, limit + 1, before);
    JobPage page;
    if (jobs.size() > limit) {
        jobs.resize(limit);
        page.next = std::to_string(jobs.back().sequence);
    }
    for (const StoredJob& job : jobs) page.jobs.push_back(info_of(job, state_->board.shown(job.id)));
    return page;
}

std::size_t Jobs::count(JobState state) const {
    return state_->store.count(to_string(state));
}

std::uint64_t Jobs::bytes() const {
    return state_->store.bytes();
}

JobTally Jobs::tally() const {
    return state_->news.tally();
}

std::optional<std::string> Jobs::scenario(const std::string& id) const {
    return state_->store.scenario(id);
}

std::optional<fs::path> Jobs::artifact(const std::string& id, const std::string& name) const {
    const std::optional<StoredJob> job = state_->store.find(id);
    if (!job || job->state != job_states::succeeded) return std::nullopt;
    return find_file_in(state_->folders.jobs / job->id, name);
}

std::vector<std::string> Jobs::artifacts(const std::string& id) const {
    const std::optional<StoredJob> job = state_->store.find(id);
    if (!job || job->state != job_states::succeeded) return {};
    return list_files(state_->folders.jobs / job->id);
}

std::optional<JobInfo> Jobs::wait(const std::string& id, std::uint64_t revision, double seconds) const {
    const auto until = JobBoard::Clock::now() + std::chrono::duration_cast<JobBoard::Clock::duration>(
                                                    std::chrono::duration<double>(std::clamp(seconds, 0.0, 1e6)));
    for (;;) {
        const std::uint64_t seen = state_->board.changes();
        std::optional<JobInfo> info = find(id);
        if (!info || info->revision > revision || !state_->board.wait_for_change(seen, until)) return info;
    }
}

bool Jobs::storage_fails() const {
    return state_->board.storage_fails();
}

JobStorage Jobs::storage() const {
    return {storage_fails(), state_->presence.gone().has_value(), free_bytes(state_->folders.work),
            state_->place.limits.min_free};
}

void Jobs::stop() {
    State& all = *state_;
    all.board.stop(JobBoard::Clock::now() + std::chrono::duration_cast<JobBoard::Clock::duration>(
                                                std::chrono::duration<double>(all.place.limits.grace)));
    const std::scoped_lock lock(all.joining);
    for (std::thread& worker : all.workers)
        if (worker.joinable()) worker.join();
    if (all.sweeper.joinable()) all.sweeper.join();
}

bool Jobs::stopping() const {
    return state_->board.stopping();
}

}  // namespace shadowbench::service
