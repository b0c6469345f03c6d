// The parts of JobStore that change nothing.
#include <utility>

#include "service/store/job_search.h"
#include "service/store/job_store.h"
#include "service/store/job_store_state.h"

namespace shadowbench::service {
namespace {

using sqlite::Database, sqlite::Rows, sqlite::run;

// Of a state with fewer jobs, each is looked at; else the index of texts finds some, of any state.
constexpr std::int64_t few_jobs = 2000;

bool has_few(Database& database, const std::string& state) {
    Rows rows(database, "SELECT count(*) FROM (SELECT 1 FROM jobs WHERE state = ? LIMIT ?)", {state, few_jobs});
    return rows.next() && rows.integer(0) < few_jobs;
}

std::string as_line(const std::string& text) {
    return text.empty() ? "" : fold_case('\n' + text + '\n');
}

// What the index of texts looks for, which may find more than the jobs that are wanted; `text` is folded.
std::string match_of(const StoreFilter& filter, const std::string& text) {
    std::string match;
    for (const std::string& part : {text, as_line(filter.label), as_line(filter.owner)})
        if (const std::string phrase = phrase_of(part); !phrase.empty())
            match += (match.empty() ? "" : " AND ") + phrase;
    return match;
}

// ?1 to ?3 are state, owner and label of the filter, ?4 is the folded text and ?5 what the index of texts looks for.
// Labels have no line breaks, so a label between two of them is a whole one.
std::string list_sql(const StoreFilter& filter, const std::string& match, bool few) {
    const bool searched = !filter.text.empty() || !filter.label.empty(), by_text = searched && !few;
    const std::string sequence = by_text ? "jobs_text.rowid" : "jobs.sequence";
    std::string sql = "SELECT jobs.* FROM ";
    if (by_text)
        sql += "jobs_text CROSS JOIN jobs ON jobs.sequence = jobs_text.rowid";
    else if (!filter.text.empty())
        sql += "jobs CROSS JOIN jobs_text ON jobs_text.rowid = jobs.sequence";
    else
        sql += !searched && !filter.owner.empty() ? "jobs INDEXED BY jobs_of_owner" : "jobs";
    sql += " WHERE " + sequence + " < ?6";
    if (by_text && !match.empty()) sql += " AND jobs_text MATCH ?5";
    if (!filter.text.empty()) sql += " AND instr(jobs_text.text, ?4) > 0";
    if (!filter.state.empty()) sql += " AND jobs.state = ?1";
    if (!filter.owner.empty()) sql += " AND jobs.owner = ?2";
    if (!filter.label.empty()) sql += " AND instr(char(10) || jobs.labels || char(10), char(10) || ?3 || char(10)) > 0";
    return sql + " ORDER BY " + sequence + " DESC LIMIT ?7";
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
    const std::scoped_lock lock(state_->read_mutex);
    const std::int64_t below = before > 0 ? before : INT64_MAX, most = static_cast<std::int64_t>(limit);
    const std::string text = fold_case(filter.text), match = match_of(filter, text);
    std::vector<StoredJob> jobs;
    run(*state_->reader, "BEGIN");  // the page and the places in the queue are read at the same moment
    try {
        const bool few = !filter.state.empty() && has_few(*state_->reader, filter.state);
        {
            Rows rows(*state_->reader, list_sql(filter, match, few),
                      {filter.state, filter.owner, filter.label, text, match, below, most});
            while (rows.next()) jobs.push_back(read_job(rows));
        }
        count_ahead(*state_->reader, jobs);
    } catch (...) {
        run(*state_->reader, "ROLLBACK");
        throw;
    }
    run(*state_->reader, "COMMIT");
    return jobs;
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
