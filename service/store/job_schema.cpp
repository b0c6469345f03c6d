#include "service/store/job_schema.h"

#include <string>
#include <utility>

#include "service/store/job_rows.h"
#include "service/store/old_index.h"

namespace shadowbench::service {
namespace {

using sqlite::Database, sqlite::Rows, sqlite::Transaction;

// AUTOINCREMENT never reuses sequence numbers: cursors and the queue rely on their order.
constexpr const char* schema_1 = R"(
CREATE TABLE jobs (
  sequence INTEGER PRIMARY KEY AUTOINCREMENT, id TEXT NOT NULL UNIQUE, state TEXT NOT NULL, name TEXT NOT NULL,
  hash TEXT NOT NULL, seed INTEGER NOT NULL, program TEXT NOT NULL, pictures INTEGER NOT NULL, cached INTEGER NOT NULL,
  created TEXT NOT NULL, started TEXT NOT NULL DEFAULT '', ended TEXT NOT NULL DEFAULT '',
  attempts INTEGER NOT NULL DEFAULT 0, kept INTEGER, fault_code INTEGER, fault_where TEXT, fault_message TEXT,
  revision INTEGER NOT NULL, scenario TEXT NOT NULL) STRICT;
CREATE INDEX jobs_by_state ON jobs (state, sequence);
CREATE INDEX jobs_by_result ON jobs (hash, seed, program, pictures, state, sequence);
CREATE TABLE keys (
  key TEXT PRIMARY KEY, request TEXT NOT NULL,
  job INTEGER NOT NULL REFERENCES jobs (sequence) ON DELETE CASCADE) STRICT, WITHOUT ROWID;
CREATE INDEX keys_by_job ON keys (job);
CREATE TABLE counter (revision INTEGER NOT NULL) STRICT;
INSERT INTO counter VALUES (0);
)";

// Version 2 has recommendations.
constexpr const char* from_version_1 = "ALTER TABLE jobs ADD COLUMN recommend TEXT NOT NULL DEFAULT '';";

// Version 3 has owners, who take turns, and sizes and checksums. turns: when a job of an owner was last taken.
constexpr const char* from_version_2 = R"(
ALTER TABLE jobs ADD COLUMN owner TEXT NOT NULL DEFAULT '';
ALTER TABLE jobs ADD COLUMN labels TEXT NOT NULL DEFAULT '';
ALTER TABLE jobs ADD COLUMN priority INTEGER NOT NULL DEFAULT 0;
ALTER TABLE jobs ADD COLUMN pinned INTEGER NOT NULL DEFAULT 0;
ALTER TABLE jobs ADD COLUMN bytes INTEGER NOT NULL DEFAULT 0;
ALTER TABLE jobs ADD COLUMN queued TEXT NOT NULL DEFAULT '';
ALTER TABLE jobs ADD COLUMN checksum TEXT NOT NULL DEFAULT '';
CREATE INDEX jobs_by_owner ON jobs (state, owner, priority DESC, sequence);
CREATE INDEX jobs_by_bytes ON jobs (owner, bytes);
CREATE TABLE turns (owner TEXT PRIMARY KEY, last INTEGER NOT NULL) STRICT, WITHOUT ROWID;
PRAGMA user_version = 3;
)";

// Version 4 has an index that lists the jobs of an owner, the newest first.
constexpr const char* from_version_3 = R"(
CREATE INDEX jobs_of_owner ON jobs (owner, sequence, state);
PRAGMA user_version = 4;
)";

constexpr const char* columns_1 =
    "sequence, id, state, name, hash, seed, program, pictures, cached, created, started, ended, attempts, kept, "
    "fault_code, fault_where, fault_message, revision, scenario";
constexpr const char* columns_of_2 = ", recommend";
constexpr const char* columns_of_3 = ", owner, labels, priority, pinned, bytes, queued, checksum";

void check_table(Database& database, const char* table, const std::string& columns) {
    Rows rows(database, "SELECT group_concat(name, ', ') FROM pragma_table_info(?)", {std::string_view(table)});
    if (!rows.next() || rows.text(0) != columns)
        database.fail_damaged(std::string("the database lacks its table ") + table);
}

void check_tables(Database& database, std::int64_t version) {
    std::string columns = columns_1;
    if (version >= 2) columns += columns_of_2;
    if (version >= 3) columns += columns_of_3;
    check_table(database, "jobs", columns);
    check_table(database, "keys", "key, request, job");
    check_table(database, "counter", "revision");
    if (version >= 3) check_table(database, "turns", "owner, last");
}

std::int64_t version_of(Database& database) {
    Rows rows(database, "PRAGMA user_version");
    const std::int64_t version = rows.next() ? rows.integer(0) : 0;
    if (version < 0 || version > schema_version)
        database.fail("a newer shadowbench wrote this database; run that one, or use another folder for the state");
    return version;
}

}  // namespace

void make_schema(Database& database) {
    const std::int64_t version = version_of(database);
    if (version > 0) check_tables(database, version);
    drop_old_index(database);
    if (version == schema_version) return;
    Transaction all(database);
    if (version < 1) database.execute(schema_1);
    if (version < 2) database.execute(from_version_1);
    if (version < 3) database.execute(from_version_2);
    if (version < 4) database.execute(from_version_3);
    if (version < 3) seal_all(database);
    all.commit();
}

void check_schema(Database& database) {
    const std::int64_t version = version_of(database);
    if (version < schema_version)
        database.fail("an earlier shadowbench wrote this database; the next start of the server brings it up to date");
    check_tables(database, version);
}

}  // namespace shadowbench::service
