// Rows of the table of jobs.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "service/store/database.h"
#include "service/store/job_store.h"

namespace shadowbench::service {

// Reads a complete row, in the order of the schema, but not the text of the scenario, which may be long.
StoredJob read_job(const sqlite::Rows& rows);

sqlite::Value value(const std::optional<bool>& flag);
sqlite::Value value(std::uint64_t number);

std::uint64_t count_in(sqlite::Database& database, const std::string& state);
std::optional<StoredJob> find_by_id(sqlite::Database& database, const std::string& id);

// Sets `ahead` of those that are queued: how many jobs are taken before, if nothing else comes and no limit of an owner
// holds one back.
void count_ahead(sqlite::Database& database, std::vector<StoredJob>& jobs);

// A checksum of all other columns of a row. Every change of a row is followed by seal(), in the same transaction.
void seal(sqlite::Database& database, const std::string& id);
void seal_all(sqlite::Database& database);
// The ids of the rows whose checksum is not that of their columns.
std::vector<std::string> find_unsealed(sqlite::Database& database);

// A list of labels as the text of a column.
std::string join_labels(const std::vector<std::string>& labels);

}  // namespace shadowbench::service
