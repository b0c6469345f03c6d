#include "service/jobs/recover.h"

#include <algorithm>
#include <charconv>
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

// Calls `read`. If the storage cannot be read, says so: the place then stays as it is.
template <class Read>
auto read_or_say(const Say& say, const Read& read) -> std::optional<decltype(read())> {
    try {
        return read();
    } catch (const base::Error& error) {
        say(fmt::format("{}; it stays, and the next start reads it again", error.what()));
        return std::nullopt;
    }
}

struct Unclaimed {
    std::string created, id;
};

// `job`: the row of the store, if it has one.
FoundResults read_unclaimed(const JobFolders& folders, const std::string& id, const std::optional<StoredJob>& job) {
    FoundResults found = read_results(folders.jobs / id, id);
    // An earlier version noted in the store that the job had succeeded, before it moved the results, and wrote no
    // record.
    if (found.job && job && job->kept) {
        found.job->job.kept = job->kept;
        found.job->job.attempts = job->attempts;
    }
    return found;
}

bool can_adopt(const std::string& id, const std::optional<StoredJob>& job) {
    return job ? job->state == job_states::queued || job->state == job_states::running : is_job_id(id);
}

// Why an entry of jobs/ that cannot be adopted does not belong there; empty if the store has its job as succeeded.
std::string unknown(const std::optional<StoredJob>& job) {
    if (!job) return "not of this server";
    return job->state == job_states::succeeded ? "" : "the results of a job that is " + job->state;
}

void adopt_results(StateFolder& state, JobStore& store, const JobFolders& folders, const Say& say) {
    std::vector<Unclaimed> unclaimed;
    for (const fs::path& place : entries_of(folders.jobs)) {
        const std::string id = place.filename().string();
        const std::optional<StoredJob> job = store.find(id);
        std::string why;
        if (can_adopt(id, job)) {
            const auto found = read_or_say(say, [&] { return read_unclaimed(folders, id, job); });
            if (!found) continue;
            if (found->job) unclaimed.push_back({found->job->job.created, id});
            why = found->why_none;
        } else {
            why = unknown(job);
        }
        if (!why.empty()) state.set_aside(fs::path("jobs") / id, why);
    }
    // In the order of the jobs, as far as it is known.
    std::sort(unclaimed.begin(), unclaimed.end(), [](const Unclaimed& a, const Unclaimed& b) {
        return std::pair(a.created, a.id) < std::pair(b.created, b.id);
    });
    std::vector<KeptJob> batch;
    for (std::size_t i = 0; i < unclaimed.size(); ++i) {
        const std::string& id = unclaimed[i].id;
        const std::optional<StoredJob> job = store.find(id);
        if (auto found = read_or_say(say, [&] { return read_unclaimed(folders, id, job); }); found && found->job) {
            found->job->job.bytes = bytes_in(folders.jobs / id);
            batch.push_back(std::move(*found->job));
            // Not reported for a run that ended just before the server died.
            if (!job || job->state == job_states::queued)
                say(fmt::format("{}: the database {}; added from its results as succeeded",
                                (folders.jobs / id).string(),
                                job ? "has this job in the queue" : "does not have this job"));
        }
        if (batch.size() == adopted_at_once || i + 1 == unclaimed.size()) {
            store.adopt(batch);
            batch.clear();
        }
    }
}

// The name of a folder in work/: "<id>-<use>".
struct WorkName {
    std::string id, use;
};

std::optional<WorkName> split(const std::string& name) {
    const std::size_t dash = name.rfind('-');
    if (dash == std::string::npos || !is_job_id(name.substr(0, dash))) return std::nullopt;
    return WorkName{name.substr(0, dash), name.substr(dash + 1)};
}

// Whether a run of this number may have left its folder. The folder of the run that succeeded has moved to jobs/.
bool may_have_run(const StoredJob& job, const std::string& number) {
    int attempt = 0;
    std::from_chars(number.data(), number.data() + number.size(), attempt);
    const int last = job.state == job_states::succeeded ? job.attempts - 1 : job.attempts;
    return attempt >= 1 && attempt <= last && std::to_string(attempt) == number;
}

// Whether a folder of results is this job's: it has the job's record, or was emptied already.
bool is_of_job(const fs::path& place, const std::string& id) {
    return entries_of(place).empty() || has_record_of(place, id);
}

// Whether the server left these results of a job that it removed, or that was cancelled while it succeeded. They leave
// jobs/ first. Results of earlier versions have no record.
bool is_removal(const JobFolders& folders, const fs::path& place, const std::string& id,
                const std::optional<StoredJob>& job) {
    if (is_published(folders, id)) return false;
    if (job && job->state != job_states::succeeded && job->state != job_states::cancelled) return false;
    return is_of_job(place, id) || (job && job->state == job_states::succeeded && read_results(place, id).job);
}

// Whether the server left this folder of work/, which nothing needs. `job`: the row of the store, if it has one.
bool is_left_over(const JobFolders& folders, const fs::path& place, const WorkName& name,
                  const std::optional<StoredJob>& job) {
    if (type_of(place) != fs::file_type::directory) return false;
    if (name.use == "removed") return is_removal(folders, place, name.id, job);
    // Results are copied before their job is in the store.
    if (name.use == "copy") return !job && !is_published(folders, name.id) && is_of_job(place, name.id);
    return job && may_have_run(*job, name.use);
}

void sweep_work(StateFolder& state, JobStore& store, const JobFolders& folders, const Say& say) {
    for (const fs::path& place : entries_of(folders.work)) {
        const fs::path relative = fs::path("work") / place.filename();
        if (is_room_file(place)) {
            remove_folder(place);
            continue;
        }
        const auto name = split(place.filename().string());
        if (!name) {
            state.set_aside(relative, "not of this server");
            continue;
        }
        const std::optional<StoredJob> job = store.find(name->id);
        const auto left_over = read_or_say(say, [&] { return is_left_over(folders, place, *name, job); });
        if (!left_over) continue;
        if (!*left_over) {
            state.set_aside(relative,
                            job ? "no run or removal of this job left it" : "of a job that the database does not have");
            continue;
        }
        if (name->use == "removed" && job && job->state == job_states::succeeded) store.remove(name->id);
        remove_folder(place);
    }
}

void note_bytes(JobStore& store, const JobFolders& folders, const std::string& id) {
    try {
        store.set_bytes(id, bytes_in(folders.jobs / id));
    } catch (const base::Error&) {
        // As on a full disk: the next start notes it.
    }
}

// Reports jobs whose results are missing, and measures results of earlier versions, which did not note their size.
void check_succeeded(JobStore& store, const JobFolders& folders, const Say& say) {
    std::int64_t before = 0;
    for (;;) {
        const std::vector<StoredJob> page = store.list({job_states::succeeded}, 1000, before);
        for (const StoredJob& job : page) {
            const auto there = read_or_say(say, [&] { return is_published(folders, job.id); });
            if (there == false)
                say(fmt::format("{}: the results of this job are missing", (folders.jobs / job.id).string()));
            if (there == true && job.bytes == 0) note_bytes(store, folders, job.id);
        }
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
    sweep_work(state, store, folders, say);  // before the numbers of runs are taken back
    for (const StoredJob& job : store.list({job_states::running}, INT32_MAX, 0)) store.requeue_running(job.id, true);
    check_succeeded(store, folders, say);
}

}  // namespace shadowbench::service
