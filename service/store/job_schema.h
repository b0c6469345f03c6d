// The tables of a job store, and those of earlier versions.
#pragma once

#include <cstdint>

#include "service/store/database.h"

namespace shadowbench::service {

inline constexpr std::int64_t schema_version = 4;

// Makes the tables of a new file, or gives those of an earlier version what they lack and drops its index of texts.
// Throws Error{io} for a file of a newer version, DamagedStore where a table or a column is missing.
void make_schema(sqlite::Database& database);

// Throws like make_schema(), and also for a file of an earlier version. Writes nothing.
void check_schema(sqlite::Database& database);

}  // namespace shadowbench::service
