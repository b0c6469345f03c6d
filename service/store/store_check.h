// Copies and checks a job store that a server may be using. Neither changes it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "service/store/job_store.h"

namespace shadowbench::service {

// Writes the state of the store at one moment to a new file. Throws Error{io}, DamagedStore.
void copy_store(const std::filesystem::path& from, const std::filesystem::path& to);

struct StoreContents {
    std::vector<StoredJob> jobs;
    std::vector<std::string> faults;  // a line each: damaged pages, rows whose checksum is wrong
};
// Throws Error{io} for a file that cannot be read or is of an earlier or newer version, DamagedStore where it is no
// database or lacks a table.
StoreContents check_store(const std::filesystem::path& file);

// The jobs alone, unchecked. Throws as check_store() does.
std::vector<StoredJob> read_store(const std::filesystem::path& file);

}  // namespace shadowbench::service
