// What a start makes of what the last server left.
#pragma once

#include <memory>

#include "service/jobs/folders.h"
#include "service/jobs/state_folder.h"
#include "service/store/job_store.h"

namespace shadowbench::service {

// Opens the store. A file that is broken is set aside, and a new one is made in its place: recover() fills it from the
// results. Throws Error{io}, as for another program's file, which stays where it is.
std::unique_ptr<JobStore> open_store(StateFolder& state, const JobFolders& folders, const Say& say);

// Before anything runs: results in their place whose job the store has not as ended are taken as that job's; jobs that
// ran are queued again, and that run is not counted; what was half done is removed, and what nobody knows in jobs/ and
// work/ is set aside. Says what it did beyond the usual. Throws Error{io}.
void recover(StateFolder& state, JobStore& store, const JobFolders& folders, const Say& say);

}  // namespace shadowbench::service
