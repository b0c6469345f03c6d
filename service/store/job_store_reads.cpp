// The parts of JobStore that change nothing.
#include <algorithm>
#include <utility>

#include "service/store/job_store.h"
#include "service/store/job_store_state.h"
#include "service/store/job_texts.h"

namespace shadowbench::service {
namespace {

using sqlite::Database, sqlite::Rows, sqlite::run;

// Of a state with fewer jobs, each row is looked at; else the texts in memory find some, of any state.
constexpr std::int64_t few_jobs = 2000;
constexpr std::size_t found_at_once = 1000;

bool has_few(Database& database, const std::string& state) {
    Rows rows(database, "SELECT count(*) FROM (SELECT 1 FROM jobs WHERE state = ? LIMIT ?)", {state, few_jobs});
    return rows.next() && rows.integer(0) < few_jobs;
}

// A search for a text or a label.
struct Wanted {
    const StoreFilter& filter;
    std::string text;                // folded
    std::vector<std::string> parts;  // that the text of each wanted job has
    std::size_t limit;
    std::int64_t before;
};

Wanted wanted_of(const StoreFilter& filter, std::size_t limit, std::int64_t before) {
    Wanted wanted{filter, fold_case(filter.text), {}, limit, before};
    if (!wanted.text.empty()) wanted.parts.push_back(wanted.text);
    for (const std::string& line : {filter.label, filter.owner})
        if (!line.empty()) wanted.parts.push_back(fold_case('\n' + line + '\n'));
    return wanted;
}

bool is_wanted(const StoredJob& job, const Wanted& wanted) {
    const StoreFilter& filter = wanted.filter;
    return (filter.state.empty() || job.state == filter.state) && (filter.owner.empty() || job.owner == filter.owner) &&
           (filter.label.empty() ||
            std::find(job.labels.begin(), job.labels.end(), filter.label) != job.labels.end()) &&
           searched_text(job).find(wanted.text) != std::string::npos;
}

void keep_wanted(Rows& rows, const Wanted& wanted, std::vector<StoredJob>& jobs) {
    while (jobs.size() < wanted.limit && rows.next())
        if (StoredJob job = read_job(rows); is_wanted(job, wanted)) jobs.push_back(std::move(job));
}

// Every job that the texts find is looked at in its row, which may have changed since.
void keep_found(Database& database, const JobTexts& texts, const Wanted& wanted, std::vector<StoredJob>& jobs) {
    std::int64_t before = wanted.before;
    while (jobs.size() < wanted.limit) {
        const std::vector<std::int64_t> found = texts.find(wanted.parts, before, found_at_once);
        for (const std::int64_t sequence : found) {
            Rows row(database, "SELECT * FROM jobs WHERE sequence = ?1 AND (?2 = '' OR state = ?2)",
                     {sequence, wanted.filter.state});
            keep_wanted(row, wanted, jobs);
        }
        if (found.size() < found_at_once) return;
        before = found.back();
    }
}

// Reads within one transaction: the rows and their places in the queue are those of the same moment.
template <class Read>
std::vector<StoredJob> read_page(Database& database, const Read& read) {
    std::vector<StoredJob> jobs;
    run(database, "BEGIN");
    try {
        read(jobs);
        count_ahead(database, jobs);
    } catch (...) {
        run(database, "ROLLBACK");
        throw;
    }
    run(database, "COMMIT");
    return jobs;
}

std::string list_sql(const StoreFilter& filter) {
    std::string sql = "SELECT * FROM jobs";
    if (!filter.owner.empty()) sql += " INDEXED BY jobs_of_owner";
    sql += " WHERE sequence < ?3";
    if (!filter.state.empty()) sql += " AND state = ?1";
    if (!filter.owner.empty()) sql += " AND owner = ?2";
    return sql + " ORDER BY sequence DESC LIMIT ?4";
}

}  // namespace

std::optional<JobStore::Added> find_by_key(Database& database, const std::string& key, const std::string& request) {
    if (key.empty()) return std::nullopt;
    std::string id, before;
    {
        Rows rows(database, "SELECT jobs.id, request FROM keys JOIN jobs ON jobs.sequence = keys.job WHERE key = ?",
                  {key});
        if (!rows.next()) return std::nullopt;
        id = rows.text(0);
        before = rows.text(1);
    }
    using Outcome = JobStore::Added::Outcome;
    return JobStore::Added{before == request ? Outcome::existing : Outcome::conflict, *find_by_id(database, id)};
}

std::optional<JobStore::Added> JobStore::find_key(const std::string& key, const std::string& request) const {
    const std::scoped_lock lock(state_->read_mutex);
    return find_by_key(*state_->reader, key, request);
}

std::optional<StoredJob> JobStore::find(const std::string& id) const {
    const std::scoped_lock lock(state_->read_mutex);
    return find_by_id(*state_->reader, id);
}

std::optional<std::string> JobStore::scenario(const std::string& id) const {
    const std::scoped_lock lock(state_->read_mutex);
    Rows rows(*state_->reader, "SELECT scenario FROM jobs WHERE id = ?", {id});
    return rows.next() ? std::optional(rows.text(0)) : std::nullopt;
}

std::optional<JobStore::Key> JobStore::key_of(const std::string& id) const {
    const std::scoped_lock lock(state_->read_mutex);
    Rows rows(*state_->reader, "SELECT key, request FROM keys JOIN jobs ON jobs.sequence = keys.job WHERE id = ?",
              {id});
    return rows.next() ? std::optional(Key{rows.text(0), rows.text(1)}) : std::nullopt;
}

std::vector<StoredJob> JobStore::list(const StoreFilter& filter, std::size_t limit, std::int64_t before) const {
    if (before <= 0) before = INT64_MAX;
    if (filter.text.empty() && filter.label.empty()) {
        const std::scoped_lock lock(state_->read_mutex);
        return read_page(*state_->reader, [&](std::vector<StoredJob>& jobs) {
            Rows rows(*state_->reader, list_sql(filter),
                      {filter.state, filter.owner, before, static_cast<std::int64_t>(limit)});
            while (rows.next()) jobs.push_back(read_job(rows));
        });
    }
    const std::scoped_lock lock(state_->search_mutex);
    Database& database = *state_->searcher;
    const Wanted wanted = wanted_of(filter, limit, before);
    const bool few = !filter.state.empty() && has_few(database, filter.state);
    if (!few) state_->texts.load(database);
    return read_page(database, [&](std::vector<StoredJob>& jobs) {
        if (!few) return keep_found(database, state_->texts, wanted, jobs);
        Rows rows(database, "SELECT * FROM jobs WHERE state = ? AND sequence < ? ORDER BY sequence DESC",
                  {filter.state, before});
        keep_wanted(rows, wanted, jobs);
    });
}

std::size_t JobStore::count(const std::string& state) const {
    const std::scoped_lock lock(state_->count_mutex);
    return count_in(*state_->counter, state);
}

std::uint64_t JobStore::bytes() const {
    const std::scoped_lock lock(state_->count_mutex);
    Rows rows(*state_->counter, "SELECT coalesce(sum(bytes), 0) FROM jobs");
    rows.next();
    return static_cast<std::uint64_t>(rows.integer(0));
}

std::vector<JobStore::Ended> JobStore::list_removable() const {
    const std::scoped_lock lock(state_->read_mutex);
    Rows rows(*state_->reader,
              "SELECT id, ended, bytes FROM jobs WHERE state IN (?, ?, ?) AND pinned = 0 ORDER BY ended, sequence",
              {job_states::succeeded, job_states::failed, job_states::cancelled});
    std::vector<Ended> jobs;
    while (rows.next()) jobs.push_back({rows.text(0), rows.text(1), static_cast<std::uint64_t>(rows.integer(2))});
    return jobs;
}

std::optional<StoredJob> JobStore::find_result(const ResultKey& key) const {
    const std::scoped_lock lock(state_->read_mutex);
    Rows rows(
        *state_->reader,
        "SELECT * FROM jobs WHERE hash = ? AND seed = ? AND program = ? AND pictures = ? AND recommend = ? "
        "AND state = ? ORDER BY sequence DESC LIMIT 1",
        {key.hash, value(key.seed), key.program, std::int64_t{key.pictures}, key.recommend, job_states::succeeded});
    return rows.next() ? std::optional(read_job(rows)) : std::nullopt;
}

}  // namespace shadowbench::service
