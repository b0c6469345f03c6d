// The record of a job in the folder of its results, from which its row in the store can be restored.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "service/store/job_store.h"

namespace shadowbench::service {

// "j-" and 16 hexadecimal digits.
bool is_job_id(const std::string& text);

// Writes the job to the hidden file ".job.json" of the folder. Throws Error{io}.
void write_record(const std::filesystem::path& folder, const KeptJob& job);

// The job of a folder with a result.json, from its record. A folder of an earlier version has no record: the job is
// then read from result.json, without an idempotency key, with the times of the run. The job's id is `id`; a folder
// that was copied by hand is a new job, without a key. Nothing for a folder without results.
std::optional<KeptJob> read_record(const std::filesystem::path& folder, const std::string& id);

// Whether the folder has a record of this job, with or without a result.json.
bool has_record_of(const std::filesystem::path& folder, const std::string& id);

}  // namespace shadowbench::service
