#include "service/store/job_store.h"

#include <mutex>
#include <utility>

#include "service/store/database.h"
#include "service/store/store_kind.h"

namespace shadowbench::service {
namespace {

using Outcome = JobStore::Added::Outcome;
using sqlite::Database, sqlite::Rows, sqlite::Transaction, sqlite::Value, sqlite::run;

constexpr std::int64_t schema_version = 2;

// AUTOINCREMENT never reuses sequence numbers: cursors and the queue rely on their order.
constexpr const char* schema = R"(
CREATE TABLE jobs (
  sequence INTEGER PRIMARY KEY AUTOINCREMENT, id TEXT NOT NULL UNIQUE, state TEXT NOT NULL, name TEXT NOT NULL,
  hash TEXT NOT NULL, seed INTEGER NOT NULL, program TEXT NOT NULL, pictures INTEGER NOT NULL, cached INTEGER NOT NULL,
  created TEXT NOT NULL, started TEXT NOT NULL DEFAULT '', ended TEXT NOT NULL DEFAULT '',
  attempts INTEGER NOT NULL DEFAULT 0, kept INTEGER, fault_code INTEGER, fault_where TEXT, fault_message TEXT,
  revision INTEGER NOT NULL, scenario TEXT NOT NULL, recommend TEXT NOT NULL DEFAULT '') STRICT;
CREATE INDEX jobs_by_state ON jobs (state, sequence);
CREATE INDEX jobs_by_result ON jobs (hash, seed, program, pictures, state, sequence);
CREATE TABLE keys (
  key TEXT PRIMARY KEY, request TEXT NOT NULL,
  job INTEGER NOT NULL REFERENCES jobs (sequence) ON DELETE CASCADE) STRICT, WITHOUT ROWID;
CREATE INDEX keys_by_job ON keys (job);
CREATE TABLE counter (revision INTEGER NOT NULL) STRICT;
INSERT INTO counter VALUES (0);
PRAGMA user_version = 2;
)";

// Version 1 had no recommendations.
constexpr const char* from_version_1 = R"(
ALTER TABLE jobs ADD COLUMN recommend TEXT NOT NULL DEFAULT '';
PRAGMA user_version = 2;
)";

constexpr const char* job_columns_1 =
    "sequence, id, state, name, hash, seed, program, pictures, cached, created, started, ended, attempts, kept, "
    "fault_code, fault_where, fault_message, revision, scenario";
constexpr const char* added_columns = ", recommend";

// Revisions are reserved in the file this many at a time, so that a revision of progress, which is not stored, costs no
// write.
constexpr std::uint64_t revisions_at_once = 1000;

// Reads a complete row, in the order of the schema, but not the text of the scenario, which may be long.
StoredJob read_job(const Rows& rows) {
    StoredJob job;
    job.sequence = rows.integer(0);
    job.id = rows.text(1);
    job.state = rows.text(2);
    job.name = rows.text(3);
    job.key = {rows.text(4), static_cast<std::uint64_t>(rows.integer(5)), rows.text(6), rows.integer(7) != 0,
               rows.text(19)};
    job.cached = rows.integer(8) != 0;
    job.created = rows.text(9);
    job.started = rows.text(10);
    job.ended = rows.text(11);
    job.attempts = static_cast<int>(rows.integer(12));
    if (!rows.null(13)) job.kept = rows.integer(13) != 0;
    if (!rows.null(14)) job.fault = {static_cast<int>(rows.integer(14)), rows.text(15), rows.text(16)};
    job.revision = static_cast<std::uint64_t>(rows.integer(17));
    return job;
}

Value value(const std::optional<bool>& flag) {
    return flag ? Value(std::int64_t{*flag}) : Value();
}

Value value(std::uint64_t number) {
    return static_cast<std::int64_t>(number);
}

std::uint64_t count_in(Database& database, const std::string& state) {
    Rows rows(database, "SELECT count(*) FROM jobs WHERE state = ?", {state});
    rows.next();
    return static_cast<std::uint64_t>(rows.integer(0));
}

std::optional<StoredJob> read_first(Rows& rows) {
    return rows.next() ? std::optional(read_job(rows)) : std::nullopt;
}

// `jobs` are sorted newest first; the queued ones among them are neighbours in the queue.
void count_ahead(Database& database, std::vector<StoredJob>& jobs) {
    std::optional<std::uint64_t> ahead;
    for (StoredJob& job : jobs) {
        if (job.state != job_states::queued) continue;
        if (!ahead) {
            Rows rows(database, "SELECT count(*) FROM jobs WHERE state = ? AND sequence < ?",
                      {job_states::queued, job.sequence});
            rows.next();
            ahead = static_cast<std::uint64_t>(rows.integer(0));
        } else {
            --*ahead;
        }
        job.ahead = *ahead;
    }
}

std::optional<StoredJob> find_by_id(Database& database, const std::string& id) {
    std::vector<StoredJob> jobs;
    {
        Rows rows(database, "SELECT * FROM jobs WHERE id = ?", {id});
        if (rows.next()) jobs.push_back(read_job(rows));
    }
    count_ahead(database, jobs);
    return jobs.empty() ? std::nullopt : std::optional(std::move(jobs.front()));
}

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
    return JobStore::Added{before == request ? Outcome::existing : Outcome::conflict, *find_by_id(database, id)};
}

constexpr std::string_view end_sql =
    "UPDATE jobs SET state = ?1, ended = ?2, kept = ?3, fault_code = ?4, fault_where = ?5, fault_message = ?6, "
    "revision = ?7 WHERE id = ?8 AND state IN (?9, ?10)";

constexpr std::string_view adopt_sql =
    "INSERT INTO jobs (id, state, name, hash, seed, program, pictures, cached, created, started, ended, attempts, "
    "kept, revision, scenario, recommend) "
    "VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13, ?14, ?15, ?16) "
    "ON CONFLICT (id) DO UPDATE SET state = ?2, started = ?10, ended = ?11, attempts = ?12, kept = ?13, revision = ?14 "
    "WHERE state IN (?17, ?18)";

std::optional<std::uint64_t> end_job(Database& database, const std::string& id, const Ending& ending,
                                     std::uint64_t revision, const char* other_state) {
    const auto& fault = ending.fault;
    const std::int64_t changed =
        run(database, end_sql,
            {ending.state, ending.ended, value(ending.kept), fault ? Value(std::int64_t{fault->code}) : Value(),
             fault ? Value(fault->where) : Value(), fault ? Value(fault->message) : Value(), value(revision), id,
             job_states::running, other_state});
    return changed == 1 ? std::optional(revision) : std::nullopt;
}

void check_tables(Database& database, const std::string& job_columns) {
    for (const auto& [table, columns] :
         {std::pair("jobs", job_columns), std::pair("keys", std::string("key, request, job")),
          std::pair("counter", std::string("revision"))}) {
        Rows rows(database, "SELECT group_concat(name, ', ') FROM pragma_table_info(?)", {std::string_view(table)});
        if (!rows.next() || rows.text(0) != columns)
            database.fail_damaged(std::string("the database lacks its table ") + table);
    }
}

void make_schema(Database& database) {
    std::int64_t version = 0;
    {
        Rows rows(database, "PRAGMA user_version");
        if (rows.next()) version = rows.integer(0);
    }
    if (version < 0 || version > schema_version)
        database.fail("a newer shadowbench wrote this database; run that one, or use another folder for the state");
    if (version == schema_version) return check_tables(database, std::string(job_columns_1) + added_columns);
    if (version == 1) check_tables(database, job_columns_1);
    Transaction all(database);
    database.execute(version == 0 ? schema : from_version_1);
    all.commit();
}

}  // namespace

struct JobStore::State {
    explicit State(const std::filesystem::path& file) : writer(file, Database::Access::write, store_application) {
        make_schema(writer);
        Rows rows(writer, "SELECT revision FROM counter");
        if (!rows.next()) writer.fail_damaged("the database is damaged: it has no counter of revisions");
        last = reserved = static_cast<std::uint64_t>(rows.integer(0));
    }

    // Called within a transaction.
    std::uint64_t take_revision() {
        if (last >= reserved) {
            run(writer, "UPDATE counter SET revision = revision + ?", {value(revisions_at_once)});
            reserved += revisions_at_once;
        }
        return ++last;
    }

    template <class Body>
    auto write(Body&& body) {
        const std::scoped_lock lock(write_mutex);
        try {
            Transaction all(writer);
            auto result = body();
            all.commit();
            return result;
        } catch (...) {
            reserved = last;  // the reservation may have been rolled back
            throw;
        }
    }

    std::mutex write_mutex, read_mutex;
    Database writer;
    std::optional<Database> reader;        // opened once the file has its tables
    std::uint64_t last = 0, reserved = 0;  // the last revision used, and the last one reserved in the file
};

JobStore::JobStore(const std::filesystem::path& file) : state_(std::make_unique<State>(file)) {
    state_->reader.emplace(file, Database::Access::read, store_application);
}

JobStore::~JobStore() = default;

JobStore::Added JobStore::add(const NewJob& job, std::size_t most_queued) {
    Database& database = state_->writer;
    return state_->write([&]() -> Added {
        if (auto known = find_by_key(database, job.idempotency_key, job.request)) return std::move(*known);
        const bool ended = job.kept.has_value();
        if (!ended && count_in(database, job_states::queued) >= most_queued) return {Outcome::full, {}};
        const std::string_view time_of_end = ended ? std::string_view(job.created) : std::string_view();
        run(database,
            "INSERT INTO jobs (id, state, name, hash, seed, program, pictures, cached, created, started, ended, kept, "
            "revision, scenario, recommend) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
            {job.id, ended ? job_states::succeeded : job_states::queued, job.name, job.key.hash, value(job.key.seed),
             job.key.program, std::int64_t{job.key.pictures}, std::int64_t{ended}, job.created, time_of_end,
             time_of_end, value(job.kept), value(state_->take_revision()), job.scenario, job.key.recommend});
        if (!job.idempotency_key.empty())
            run(database, "INSERT INTO keys (key, request, job) SELECT ?, ?, sequence FROM jobs WHERE id = ?",
                {job.idempotency_key, job.request, job.id});
        return {Outcome::added, *find_by_id(database, job.id)};
    });
}

std::optional<JobStore::Added> JobStore::find_key(const std::string& key, const std::string& request) const {
    const std::scoped_lock lock(state_->read_mutex);
    return find_by_key(*state_->reader, key, request);
}

std::optional<StoredJob> JobStore::claim(const std::string& started) {
    Database& database = state_->writer;
    return state_->write([&]() -> std::optional<StoredJob> {
        std::optional<StoredJob> job;
        {
            Rows rows(database, "SELECT * FROM jobs WHERE state = ? ORDER BY sequence LIMIT 1", {job_states::queued});
            job = read_first(rows);
        }
        if (!job) return std::nullopt;
        run(database,
            "UPDATE jobs SET state = ?, attempts = attempts + 1, started = ?, revision = ? WHERE sequence = ?",
            {job_states::running, started, value(state_->take_revision()), job->sequence});
        return find_by_id(database, job->id);
    });
}

std::optional<std::uint64_t> JobStore::end_running(const std::string& id, const Ending& ending) {
    return state_->write(
        [&] { return end_job(state_->writer, id, ending, state_->take_revision(), job_states::running); });
}

std::optional<std::uint64_t> JobStore::end_waiting(const std::string& id, const Ending& ending) {
    return state_->write(
        [&] { return end_job(state_->writer, id, ending, state_->take_revision(), job_states::queued); });
}

std::optional<std::uint64_t> JobStore::requeue_running(const std::string& id, bool uncounted) {
    return state_->write([&]() -> std::optional<std::uint64_t> {
        const std::uint64_t revision = state_->take_revision();
        const std::int64_t changed =
            run(state_->writer,
                "UPDATE jobs SET state = ?, started = '', kept = NULL, attempts = attempts - ?, revision = ? "
                "WHERE id = ? AND state = ?",
                {job_states::queued, std::int64_t{uncounted}, value(revision), id, job_states::running});
        return changed == 1 ? std::optional(revision) : std::nullopt;
    });
}

JobStore::Retried JobStore::retry(const std::string& id, const std::string& program, std::size_t most_queued) {
    Database& database = state_->writer;
    return state_->write([&]() -> Retried {
        const std::optional<StoredJob> job = find_by_id(database, id);
        if (!job) return {Retry::not_found, 0};
        if (job->state != job_states::failed && job->state != job_states::cancelled) return {Retry::refused, 0};
        if (count_in(database, job_states::queued) >= most_queued) return {Retry::full, 0};
        const std::uint64_t revision = state_->take_revision();
        run(database,
            "UPDATE jobs SET state = ?, program = ?, attempts = 0, started = '', ended = '', kept = NULL, "
            "fault_code = NULL, fault_where = NULL, fault_message = NULL, revision = ? WHERE id = ?",
            {job_states::queued, program, value(revision), id});
        return {Retry::queued, revision};
    });
}

bool JobStore::remove(const std::string& id) {
    return state_->write([&] {
        return run(state_->writer, "DELETE FROM jobs WHERE id = ? AND state <> ?", {id, job_states::running}) == 1;
    });
}

void JobStore::adopt(const std::vector<KeptJob>& jobs) {
    Database& database = state_->writer;
    state_->write([&] {
        for (const auto& [job, scenario, key, request] : jobs) {
            run(database, adopt_sql,
                {job.id, job_states::succeeded, job.name, job.key.hash, value(job.key.seed), job.key.program,
                 std::int64_t{job.key.pictures}, std::int64_t{job.cached}, job.created, job.started, job.ended,
                 std::int64_t{job.attempts}, value(job.kept), value(state_->take_revision()), scenario,
                 job.key.recommend, job_states::queued, job_states::running});
            if (!key.empty())
                run(database,
                    "INSERT OR IGNORE INTO keys (key, request, job) SELECT ?, ?, sequence FROM jobs WHERE id = ?",
                    {key, request, job.id});
        }
        return true;
    });
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

std::vector<StoredJob> JobStore::list(const std::string& state, std::size_t limit, std::int64_t before) const {
    const std::scoped_lock lock(state_->read_mutex);
    const std::int64_t below = before > 0 ? before : INT64_MAX, most = static_cast<std::int64_t>(limit);
    std::vector<StoredJob> jobs;
    const auto collect = [&](Rows&& rows) {
        while (rows.next()) jobs.push_back(read_job(rows));
    };
    run(*state_->reader, "BEGIN");  // the page and the places in the queue are read at the same moment
    try {
        if (state.empty())
            collect(Rows(*state_->reader, "SELECT * FROM jobs WHERE sequence < ? ORDER BY sequence DESC LIMIT ?",
                         {below, most}));
        else
            collect(Rows(*state_->reader,
                         "SELECT * FROM jobs WHERE state = ? AND sequence < ? ORDER BY sequence DESC LIMIT ?",
                         {state, below, most}));
        count_ahead(*state_->reader, jobs);
    } catch (...) {
        run(*state_->reader, "ROLLBACK");
        throw;
    }
    run(*state_->reader, "COMMIT");
    return jobs;
}

std::size_t JobStore::count(const std::string& state) const {
    const std::scoped_lock lock(state_->read_mutex);
    return count_in(*state_->reader, state);
}

std::optional<StoredJob> JobStore::find_result(const ResultKey& key) const {
    const std::scoped_lock lock(state_->read_mutex);
    Rows rows(
        *state_->reader,
        "SELECT * FROM jobs WHERE hash = ? AND seed = ? AND program = ? AND pictures = ? AND recommend = ? "
        "AND state = ? ORDER BY sequence DESC LIMIT 1",
        {key.hash, value(key.seed), key.program, std::int64_t{key.pictures}, key.recommend, job_states::succeeded});
    return read_first(rows);
}

std::uint64_t JobStore::next_revision() {
    {
        const std::scoped_lock lock(state_->write_mutex);
        if (state_->last < state_->reserved) return ++state_->last;
    }
    return state_->write([&] { return state_->take_revision(); });
}

}  // namespace shadowbench::service
