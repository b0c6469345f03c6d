// Whether a file is a job store, found out without opening it as one.
#pragma once

#include <cstdint>
#include <filesystem>

namespace shadowbench::service {

inline constexpr std::int32_t store_application = 0x73626a31;  // "sbj1": SQLite's application_id of our files

// What lies in the place of a store, as its first bytes tell.
enum class StoreKind { none, ours, another_programs, no_database };  // none: no file, or an empty one

// Nothing is written or made, as SQLite does beside a file that it opens. Throws Error{io} where it cannot be read.
StoreKind kind_of_store(const std::filesystem::path& file);

}  // namespace shadowbench::service
