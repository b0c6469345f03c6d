// The class Jobs without a database or processes, for tests of what stands above it: it is linked instead of the real
// one, and a test says what becomes of a job. Files lie in folders by the job's id under `state`.
#pragma once

#include <functional>
#include <map>
#include <string>

#include "service/jobs/jobs.h"

namespace shadowbench::service::fake {

// Changes a job as its worker would, and wakes who waits for it.
void update(Jobs& jobs, const std::string& id, const std::function<void(JobInfo&)>& change);

void run(Jobs& jobs, const std::string& id);
void progress(Jobs& jobs, const std::string& id, const JobProgress& progress);

// It succeeded, and left these files, by their names.
void succeed(Jobs& jobs, const std::string& id, const std::map<std::string, std::string>& files);

void fail_storage(Jobs& jobs, bool fails);
void set_storage(Jobs& jobs, const JobStorage& storage);
void set_tally(Jobs& jobs, const JobTally& tally);

// The folder of its files.
std::filesystem::path folder(Jobs& jobs, const std::string& id);

// What the last submit() was given.
JobRequest last_request(Jobs& jobs);

}  // namespace shadowbench::service::fake
