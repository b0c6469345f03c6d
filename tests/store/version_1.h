// A job store as version 1 wrote it, before there were recommendations.
#pragma once

#include <filesystem>
#include <string>
#include <tuple>

#include "service/store/database.h"
#include "service/store/store_kind.h"

namespace shadowbench::service {

// Jobs j-000000000000000a, which succeeded, and j-000000000000000b, which waits; both have this text as their scenario.
inline void write_version_1(const std::filesystem::path& file, const std::string& scenario) {
    sqlite::Database database(file, sqlite::Database::Access::write, store_application);
    database.execute(R"(
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
INSERT INTO counter VALUES (1000);
PRAGMA user_version = 1;
)");
    for (const auto& [id, state, ended, kept] :
         {std::tuple("j-000000000000000a", "succeeded", "then", sqlite::Value(std::int64_t{1})),
          std::tuple("j-000000000000000b", "queued", "", sqlite::Value())})
        sqlite::run(database,
                    "INSERT INTO jobs (id, state, name, hash, seed, program, pictures, cached, created, ended, kept, "
                    "revision, scenario) VALUES (?, ?, 'name', 'hash', 5, '1.0 abc', 1, 0, 'created', ?, ?, 7, ?)",
                    {id, state, ended, kept, scenario});
}

}  // namespace shadowbench::service
