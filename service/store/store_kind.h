// Finds out whether a file is a job store, without opening it as a database.
#pragma once

#include <cstdint>
#include <filesystem>

namespace shadowbench::service {

inline constexpr std::int32_t store_application = 0x73626a31;  // "sbj1": SQLite's application_id of our files

// The kind of a file by its first bytes.
enum class StoreKind { none, ours, another_programs, no_database };  // none: no file, or an empty one

// Writes nothing, whereas SQLite creates files beside a database that it opens. Throws Error{io} for a file that cannot
// be read.
StoreKind kind_of_store(const std::filesystem::path& file);

}  // namespace shadowbench::service
