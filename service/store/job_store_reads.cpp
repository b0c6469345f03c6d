// The parts of JobStore that change nothing.
#include <utility>

#include "service/store/job_store.h"
#include "service/store/job_store_state.h"

namespace shadowbench::service {
namespace {

using sqlite::Database, sqlite::Rows, sqlite::run;

// ?1 to ?4 are the texts of a StoreFilter. Labels have no line breaks, so a label between two of them is a whole one.
constexpr std::string_view list_sql = R"(
SELECT * FROM jobs
WHERE (?1 = '' OR state = ?1) AND (?2 = '' OR owner = ?2)
  AND (?3 = '' OR instr(char(10) || labels || char(10), char(10) || ?3 || char(10)) > 0)
  AND (?4 = '' OR instr(lower(id || char(10) || name || char(10) || owner || char(10) || labels || char(10) ||
                              coalesce(fault_message, '')), lower(?4)) > 0)
  AND sequence < ?5 ORDER BY sequence DESC LIMIT ?6)";

// The query of all jobs of a state, which the index answers.
constexpr std::string_view list_state_sql =
    "SELECT * FROM jobs WHERE state = ? AND sequence < ? ORDER BY sequence DESC LIMIT ?";

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
    std::vector<StoredJob> jobs;
    const auto collect = [&](Rows&& rows) {
        while (rows.next()) jobs.push_back(read_job(rows));
    };
    run(*state_->reader, "BEGIN");  // the page and the places in the queue are read at the same moment
    try {
        const bool only_state = filter.owner.empty() && filter.label.empty() && filter.text.empty();
        if (only_state && !filter.state.empty())
            collect(Rows(*state_->reader, list_state_sql, {filter.state, below, most}));
        else
            collect(
                Rows(*state_->reader, list_sql, {filter.state, filter.owner, filter.label, filter.text, below, most}));
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
