#include "service/jobs/recover.h"

#include <algorithm>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "service/jobs/folders.h"
#include "service/jobs/record.h"
#include "service/jobs/room.h"
#include "service/store/damaged_store.h"
#include "service/store/store_kind.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t adopted_at_once = 200;  // jobs at a time, since each carries the text of its scenario

// A job that the store has as running, with its promises noted. An earlier version noted them before it moved the
// results to their place, and wrote no record.
KeptJob kept_of(const JobStore& store, StoredJob job) {
    KeptJob kept;
    kept.scenario = store.scenario(job.id).value_or("");
    job.ended = job.started;
    kept.job = std::move(job);
    return kept;
}

struct Unclaimed {
    std::string created, id;
};

std::optional<KeptJob> read_unclaimed(const JobStore& store, const JobFolders& folders, const std::string& id) {
    if (auto kept = read_record(folders.jobs / id, id)) return kept;
    const auto job = store.find(id);
    return job && job->kept && is_published(folders, id) ? std::optional(kept_of(store, *job)) : std::nullopt;
}

// Why a folder in jobs/ does not belong there; empty if the store has its job as succeeded.
std::string unknown(const fs::path& place, const std::optional<StoredJob>& job) {
    if (job && job->state == job_states::succeeded) return "";
    if (job && (job->state == job_states::failed || job->state == job_states::cancelled))
        return "the results of a job that is " + job->state;
    std::error_code ignored;
    if (job || (is_job_id(place.filename().string()) && fs::is_directory(fs::symlink_status(place, ignored))))
        return "it has no result of a job";
    return "not of this server";
}

void adopt_results(StateFolder& state, JobStore& store, const JobFolders& folders, const Say& say) {
    std::vector<Unclaimed> unclaimed;
    for (const fs::path& place : entries_of(folders.jobs)) {
        const std::string id = place.filename().string();
        const std::optional<StoredJob> job = store.find(id);
        const bool waits = job && (job->state == job_states::queued || job->state == job_states::running);
        if (waits || (!job && is_job_id(id)))
            if (const auto kept = read_unclaimed(store, folders, id)) {
                unclaimed.push_back({kept->job.created, id});
                continue;
            }
        if (const std::string why = unknown(place, job); !why.empty()) state.set_aside(fs::path("jobs") / id, why);
    }
    // In the order of the jobs, as far as it is known.
    std::sort(unclaimed.begin(), unclaimed.end(), [](const Unclaimed& a, const Unclaimed& b) {
        return std::pair(a.created, a.id) < std::pair(b.created, b.id);
    });
    std::vector<KeptJob> batch;
    for (std::size_t i = 0; i < unclaimed.size(); ++i) {
        const std::string& id = unclaimed[i].id;
        if (auto kept = read_unclaimed(store, folders, id)) batch.push_back(std::move(*kept));
        const std::optional<StoredJob> job = store.find(id);
        // Not reported for a run that ended just before the server died.
        if (!job || job->state == job_states::queued)
            say(fmt::format("{}: the database {}; added from its results as succeeded", (folders.jobs / id).string(),
                            job ? "has this job in the queue" : "does not have this job"));
        if (batch.size() == adopted_at_once || i + 1 == unclaimed.size()) {
            store.adopt(batch);
            batch.clear();
        }
    }
}

// Splits "<id>-<suffix>"; nothing for other names.
std::optional<std::pair<std::string, std::string>> split(const std::string& name) {
    const std::size_t dash = name.rfind('-');
    if (dash == std::string::npos || dash + 1 == name.size()) return std::nullopt;
    return std::pair(name.substr(0, dash), name.substr(dash + 1));
}

bool is_incomplete(JobStore& store, const fs::path& place) {
    if (is_room_file(place)) return true;
    const auto parts = split(place.filename().string());
    std::error_code ignored;
    if (!parts || !fs::is_directory(fs::symlink_status(place, ignored))) return false;
    const auto& [id, suffix] = *parts;
    if (suffix == "copy") return fs::is_empty(place, ignored) || has_record_of(place, id);
    if (suffix == "removed") return is_job_id(id);
    return suffix.find_first_not_of("0123456789") == std::string::npos && store.find(id);
}

void sweep_work(StateFolder& state, JobStore& store, const JobFolders& folders) {
    for (const fs::path& place : entries_of(folders.work)) {
        const std::string name = place.filename().string();
        if (!is_incomplete(store, place)) {
            const auto parts = split(name);
            state.set_aside(fs::path("work") / name, parts && is_job_id(parts->first)
                                                         ? "of a job that the database does not have"
                                                         : "not of this server");
            continue;
        }
        if (name.ends_with("-removed")) store.remove(split(name)->first);
        remove_folder(place);
    }
}

void report_missing(const JobStore& store, const JobFolders& folders, const Say& say) {
    std::int64_t before = 0;
    for (;;) {
        const std::vector<StoredJob> page = store.list(job_states::succeeded, 1000, before);
        for (const StoredJob& job : page)
            if (!is_published(folders, job.id))
                say(fmt::format("{}: the results of this job are missing", (folders.jobs / job.id).string()));
        if (page.size() < 1000) return;
        before = page.back().sequence;
    }
}

}  // namespace

std::unique_ptr<JobStore> open_store(StateFolder& state, const JobFolders& folders, const Say& say) {
    const fs::path file = state.database();
    const auto report = [&](const char* why) {
        say(fmt::format(
            "{}: {}; a new one was made from the results. Jobs that waited, failed or were cancelled are lost",
            file.string(), why));
    };
    if (kind_of_store(file) == StoreKind::none) {
        // SQLite would delete the files beside a database that does not exist.
        state.set_beside_database_aside("its database is missing or empty");
        if (!entries_of(folders.jobs).empty() || !entries_of(folders.work).empty())
            report("the database is missing or empty");
    }
    try {
        return std::make_unique<JobStore>(file);
    } catch (const DamagedStore&) {
        state.set_database_aside("the database is damaged");
        report("the database was damaged");
        return std::make_unique<JobStore>(file);
    }
}

void recover(StateFolder& state, JobStore& store, const JobFolders& folders, const Say& say) {
    adopt_results(state, store, folders, say);
    for (const StoredJob& job : store.list(job_states::running, INT32_MAX, 0)) store.requeue_running(job.id, true);
    sweep_work(state, store, folders);
    report_missing(store, folders, say);
}

}  // namespace shadowbench::service
