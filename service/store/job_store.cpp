#include "service/store/job_store.h"

#include <string_view>
#include <utility>

#include "service/store/job_store_state.h"

namespace shadowbench::service {
namespace {

using Outcome = JobStore::Added::Outcome;
using sqlite::Database, sqlite::Rows, sqlite::Value, sqlite::run;

constexpr std::string_view add_sql =
    "INSERT INTO jobs (id, state, name, hash, seed, program, pictures, cached, created, started, ended, kept, "
    "revision, scenario, recommend, owner, labels, priority, bytes, queued) "
    "VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?10, ?11, ?12, ?13, ?14, ?15, ?16, ?17, ?18, ?9)";

constexpr std::string_view end_sql =
    "UPDATE jobs SET state = ?1, ended = ?2, kept = ?3, fault_code = ?4, fault_where = ?5, fault_message = ?6, "
    "revision = ?7, bytes = ?11 WHERE id = ?8 AND state IN (?9, ?10)";

constexpr std::string_view adopt_sql =
    "INSERT INTO jobs (id, state, name, hash, seed, program, pictures, cached, created, started, ended, attempts, "
    "kept, revision, scenario, recommend, owner, labels, priority, pinned, bytes) "
    "VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13, ?14, ?15, ?16, ?19, ?20, ?21, ?22, ?23) "
    "ON CONFLICT (id) DO UPDATE SET state = ?2, started = ?10, ended = ?11, attempts = ?12, kept = ?13, "
    "revision = ?14, bytes = ?23 WHERE state IN (?17, ?18)";

constexpr std::string_view retry_sql =
    "UPDATE jobs SET state = ?, program = ?, attempts = 0, started = '', ended = '', kept = NULL, "
    "fault_code = NULL, fault_where = NULL, fault_message = NULL, revision = ?, "
    "queued = strftime('%Y-%m-%dT%H:%M:%fZ', 'now') WHERE id = ?";

std::optional<std::uint64_t> end_job(Database& database, const std::string& id, const Ending& ending,
                                     std::uint64_t revision, const char* other_state) {
    const auto& fault = ending.fault;
    const std::int64_t changed =
        run(database, end_sql,
            {ending.state, ending.ended, value(ending.kept), fault ? Value(std::int64_t{fault->code}) : Value(),
             fault ? Value(fault->where) : Value(), fault ? Value(fault->message) : Value(), value(revision), id,
             job_states::running, other_state, value(ending.bytes)});
    return changed == 1 ? std::optional(revision) : std::nullopt;
}

std::uint64_t count_of(Database& database, const char* state, const std::string& owner) {
    Rows rows(database, "SELECT count(*) FROM jobs WHERE state = ? AND owner = ?", {state, owner});
    rows.next();
    return static_cast<std::uint64_t>(rows.integer(0));
}

std::uint64_t bytes_of(Database& database, const std::string& owner) {
    Rows rows(database, "SELECT coalesce(sum(bytes), 0) FROM jobs WHERE owner = ?", {owner});
    rows.next();
    return static_cast<std::uint64_t>(rows.integer(0));
}

// Why no further job of this owner may wait.
std::optional<Outcome> refusal(Database& database, const std::string& owner, std::size_t most_queued,
                               const OwnerLimits& limits) {
    if (count_in(database, job_states::queued) >= most_queued) return Outcome::full;
    if (limits.queued && count_of(database, job_states::queued, owner) >= *limits.queued) return Outcome::owner_full;
    if (limits.bytes && bytes_of(database, owner) >= *limits.bytes) return Outcome::owner_bytes;
    return std::nullopt;
}

// The owner whose turn it is: of those who have jobs that wait and may run, the one whose last turn is longest ago.
std::optional<std::string> next_owner(Database& database, const LimitsByOwner& limits) {
    Rows rows(database,
              "SELECT owner, coalesce(last, 0) AS turn FROM (SELECT DISTINCT owner FROM jobs WHERE state = ?) "
              "LEFT JOIN turns USING (owner) ORDER BY turn, owner",
              {job_states::queued});
    while (rows.next()) {
        std::string owner = rows.text(0);
        const auto most = limits_of(limits, owner).running;
        if (!most || count_of(database, job_states::running, owner) < *most) return owner;
    }
    return std::nullopt;
}

std::optional<StoredJob> first_of(Database& database, const std::string& owner) {
    Rows rows(database, "SELECT * FROM jobs WHERE state = ? AND owner = ? ORDER BY priority DESC, sequence LIMIT 1",
              {job_states::queued, owner});
    return rows.next() ? std::optional(read_job(rows)) : std::nullopt;
}

}  // namespace

JobStore::JobStore(const std::filesystem::path& file) : state_(std::make_unique<State>(file)) {
    state_->reader.emplace(file, Database::Access::read, store_application);
    state_->counter.emplace(file, Database::Access::read, store_application);
    state_->searcher.emplace(file, Database::Access::read, store_application);
}

JobStore::~JobStore() = default;

JobStore::Added JobStore::add(const NewJob& job, std::size_t most_queued, const OwnerLimits& limits) {
    Database& database = state_->writer;
    return state_->write([&]() -> Added {
        if (auto known = find_by_key(database, job.idempotency_key, job.request)) return std::move(*known);
        const bool ended = job.kept.has_value();
        if (!ended)
            if (const auto refused = refusal(database, job.owner, most_queued, limits)) return {*refused, {}};
        const std::string_view time_of_end = ended ? std::string_view(job.created) : std::string_view();
        const std::string labels = join_labels(job.labels);
        run(database, add_sql,
            {job.id, ended ? job_states::succeeded : job_states::queued, job.name, job.key.hash, value(job.key.seed),
             job.key.program, std::int64_t{job.key.pictures}, std::int64_t{ended}, job.created, time_of_end,
             value(job.kept), value(state_->take_revision()), job.scenario, job.key.recommend, job.owner, labels,
             std::int64_t{job.priority}, value(job.bytes)});
        state_->seal(job.id);
        if (!job.idempotency_key.empty())
            run(database, "INSERT INTO keys (key, request, job) SELECT ?, ?, sequence FROM jobs WHERE id = ?",
                {job.idempotency_key, job.request, job.id});
        return {Outcome::added, *find_by_id(database, job.id)};
    });
}

std::optional<StoredJob> JobStore::claim(const std::string& started, const LimitsByOwner& limits) {
    Database& database = state_->writer;
    return state_->write([&]() -> std::optional<StoredJob> {
        const std::optional<std::string> owner = next_owner(database, limits);
        const std::optional<StoredJob> job = owner ? first_of(database, *owner) : std::nullopt;
        if (!job) return std::nullopt;
        const std::uint64_t revision = state_->take_revision();
        run(database, "INSERT OR REPLACE INTO turns (owner, last) VALUES (?, ?)", {*owner, value(revision)});
        run(database, "UPDATE jobs SET state = ?, attempts = attempts + 1, started = ?, revision = ? WHERE id = ?",
            {job_states::running, started, value(revision), job->id});
        state_->seal(job->id);
        return find_by_id(database, job->id);
    });
}

std::optional<std::uint64_t> JobStore::end_running(const std::string& id, const Ending& ending) {
    return state_->write([&] {
        const auto revision = end_job(state_->writer, id, ending, state_->take_revision(), job_states::running);
        if (revision) state_->seal(id);
        return revision;
    });
}

std::optional<std::uint64_t> JobStore::end_waiting(const std::string& id, const Ending& ending) {
    return state_->write([&] {
        const auto revision = end_job(state_->writer, id, ending, state_->take_revision(), job_states::queued);
        if (revision) state_->seal(id);
        return revision;
    });
}

std::optional<std::uint64_t> JobStore::requeue_running(const std::string& id, bool uncounted) {
    return state_->write([&]() -> std::optional<std::uint64_t> {
        const std::uint64_t revision = state_->take_revision();
        const std::int64_t changed =
            run(state_->writer,
                "UPDATE jobs SET state = ?, started = '', kept = NULL, attempts = attempts - ?, revision = ? "
                "WHERE id = ? AND state = ?",
                {job_states::queued, std::int64_t{uncounted}, value(revision), id, job_states::running});
        if (changed != 1) return std::nullopt;
        state_->seal(id);
        return revision;
    });
}

JobStore::Retried JobStore::retry(const std::string& id, const std::string& program, std::size_t most_queued,
                                  const LimitsByOwner& limits) {
    Database& database = state_->writer;
    return state_->write([&]() -> Retried {
        const std::optional<StoredJob> job = find_by_id(database, id);
        if (!job) return {Retry::not_found, 0};
        if (job->state != job_states::failed && job->state != job_states::cancelled) return {Retry::refused, 0};
        if (refusal(database, job->owner, most_queued, limits_of(limits, job->owner))) return {Retry::full, 0};
        const std::uint64_t revision = state_->take_revision();
        run(database, retry_sql, {job_states::queued, program, value(revision), id});
        state_->seal(id);
        return {Retry::queued, revision};
    });
}

bool JobStore::remove(const std::string& id) {
    Database& database = state_->writer;
    return state_->write([&] {
        const std::optional<StoredJob> job = find_by_id(database, id);
        if (!job || job->state == job_states::running) return false;
        run(database, "DELETE FROM jobs WHERE id = ?", {id});
        state_->changed.push_back({job->sequence, ""});
        return true;
    });
}

std::optional<std::uint64_t> JobStore::set_pinned(const std::string& id, bool pinned) {
    return state_->write([&]() -> std::optional<std::uint64_t> {
        const std::uint64_t revision = state_->take_revision();
        if (run(state_->writer, "UPDATE jobs SET pinned = ?, revision = ? WHERE id = ?",
                {std::int64_t{pinned}, value(revision), id}) != 1)
            return std::nullopt;
        state_->seal(id);
        return revision;
    });
}

void JobStore::set_bytes(const std::string& id, std::uint64_t bytes) {
    state_->write([&] {
        run(state_->writer, "UPDATE jobs SET bytes = ? WHERE id = ?", {value(bytes), id});
        state_->seal(id);
        return true;
    });
}

void JobStore::adopt(const std::vector<KeptJob>& jobs) {
    Database& database = state_->writer;
    state_->write([&] {
        for (const auto& [job, scenario, key, request] : jobs) {
            const std::string labels = join_labels(job.labels);
            run(database, adopt_sql,
                {job.id,
                 job_states::succeeded,
                 job.name,
                 job.key.hash,
                 value(job.key.seed),
                 job.key.program,
                 std::int64_t{job.key.pictures},
                 std::int64_t{job.cached},
                 job.created,
                 job.started,
                 job.ended,
                 std::int64_t{job.attempts},
                 value(job.kept),
                 value(state_->take_revision()),
                 scenario,
                 job.key.recommend,
                 job_states::queued,
                 job_states::running,
                 job.owner,
                 labels,
                 std::int64_t{job.priority},
                 std::int64_t{job.pinned},
                 value(job.bytes)});
            state_->seal(job.id);
            if (!key.empty())
                run(database,
                    "INSERT OR IGNORE INTO keys (key, request, job) SELECT ?, ?, sequence FROM jobs WHERE id = ?",
                    {key, request, job.id});
        }
        return true;
    });
}

void JobStore::reuse_log() {
    const std::scoped_lock lock(state_->write_mutex);
    run(state_->writer, "PRAGMA wal_checkpoint(RESTART)");
}

std::uint64_t JobStore::next_revision() {
    {
        const std::scoped_lock lock(state_->write_mutex);
        if (state_->last < state_->reserved) return ++state_->last;
    }
    return state_->write([&] { return state_->take_revision(); });
}

}  // namespace shadowbench::service
