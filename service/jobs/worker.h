// The threads that run jobs.
#pragma once

#include <string>
#include <vector>

#include "service/jobs/board.h"
#include "service/jobs/fault.h"
#include "service/jobs/folders.h"
#include "service/jobs/jobs.h"
#include "service/jobs/news.h"
#include "service/jobs/reserve.h"
#include "service/privacy/hidden_folders.h"
#include "service/store/job_store.h"
#include "service/store/presence.h"

namespace shadowbench::service {

// The store, folders and limits that the workers share.
struct Workplace {
    JobStore& store;
    JobBoard& board;
    const Presence& presence;  // of the state folder and its database
    JobFolders folders;
    std::string program;
    std::vector<std::string> data, further;  // of the arguments of a run
    JobLimits limits;
    std::vector<HiddenFolder> hidden;
    JobNews& news;
    Reserve& reserve;
};

// Takes jobs from the queue, one after the other, and runs each to its end. Returns once the board stops. Throws
// nothing: when the server's storage fails, the job keeps its place in the queue, the run does not count, and the
// worker tries again, with growing pauses, until the storage works. It starts no job while the state folder is gone, or
// the disk has less free space than limits.min_free.
void run_jobs(const Workplace& place);

}  // namespace shadowbench::service
