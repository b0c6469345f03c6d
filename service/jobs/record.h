// What the folder of a job's results says about the job, so that its row in the store can be made anew from it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "service/store/job_store.h"

namespace shadowbench::service {

// "j-" and 16 hexadecimal digits.
bool is_job_id(const std::string& text);

// Writes the job as the folder's hidden file ".job.json". Throws Error{io}.
void write_record(const std::filesystem::path& folder, const KeptJob& job);

// Of a folder with a result.json: what the record says or, of a folder of an earlier version, which has none, what
// result.json does; the key of a request is then not known, times are those of the run. The id is `id`: a folder that
// was copied by hand is a job of its own, without a key. Nothing: it holds no job's results.
std::optional<KeptJob> read_record(const std::filesystem::path& folder, const std::string& id);

// Whether the folder's record is of this job; a result.json need not be there.
bool has_record_of(const std::filesystem::path& folder, const std::string& id);

}  // namespace shadowbench::service
