// The record of a job in the folder of its results, from which its row in the store can be restored.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "service/store/job_store.h"

namespace shadowbench::service {

// "j-" and 16 hexadecimal digits.
bool is_job_id(const std::string& text);

// Writes the job to the hidden file ".job.json" of the folder, with the checksums of the other files there. Throws
// Error{io}.
void write_record(const std::filesystem::path& folder, const KeptJob& job);

// Notes in the record of a folder whether its job is pinned. No effect without a record. Throws Error{io}.
void pin_in_record(const std::filesystem::path& folder, bool pinned);

// Compares the files of a folder with the checksums in its record: a line for each that is missing or differs. Nothing
// where the record has none, as in results of earlier versions. Throws Error{io} where a file cannot be read.
std::vector<std::string> check_files(const std::filesystem::path& folder);

// The job of a folder of results, or why the folder has none.
struct FoundResults {
    std::optional<KeptJob> job;
    std::string why_none;
};

// Reads the job of a folder whose result.json is complete (results::from_json), from its record. Without a record, as
// in results of earlier versions, or with a damaged one, the job is read from result.json: without an idempotency key,
// with the times of the run. The job's id is `id`; a folder that was copied by hand is a new job, without a key. Throws
// Error when the storage cannot be read, never for damaged contents.
FoundResults read_results(const std::filesystem::path& folder, const std::string& id);

// Whether the folder has a record of this job, with or without a result.json. Throws like read_results().
bool has_record_of(const std::filesystem::path& folder, const std::string& id);

}  // namespace shadowbench::service
