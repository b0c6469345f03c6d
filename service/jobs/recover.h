// Recovers the state folder that the last server left.
#pragma once

#include <memory>

#include "service/jobs/folders.h"
#include "service/jobs/state_folder.h"
#include "service/store/job_store.h"

namespace shadowbench::service {

// Opens the store. A damaged file is set aside and replaced by a new one, which recover() fills from the results.
// Throws Error{io}, also for the file of another program, which it leaves in place.
std::unique_ptr<JobStore> open_store(StateFolder& state, const JobFolders& folders, const Say& say);

// Called before any job runs. Complete results end their job, unless the store has it as ended. Jobs that ran are
// requeued, and their run does not count. The folders of unfinished runs, copies and removals are removed. Damaged
// results, and what the server does not know in jobs/ and work/, are set aside. A place that the storage cannot read
// stays. Reports unusual steps through `say`. Throws Error{io}.
void recover(StateFolder& state, JobStore& store, const JobFolders& folders, const Say& say);

}  // namespace shadowbench::service
