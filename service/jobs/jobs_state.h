// What the parts of Jobs share.
#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "base/error.h"
#include "service/jobs/board.h"
#include "service/jobs/folders.h"
#include "service/jobs/jobs.h"
#include "service/jobs/news.h"
#include "service/jobs/reserve.h"
#include "service/jobs/state_folder.h"
#include "service/jobs/worker.h"
#include "service/store/job_store.h"
#include "service/store/presence.h"

namespace shadowbench::service {

// `further`: see FurtherArguments::key.
std::string program_version(const std::string& further);

struct Jobs::State {
    State(const std::filesystem::path& path, const std::string& program, const std::vector<std::string>& data,
          JobLimits limits, Log log, const FurtherArguments& further);

    // Gives a new job the results of an earlier one with the same key, if there is one: sets `kept` and `bytes`.
    void reuse_result(NewJob& job);
    // See Jobs::remove().
    Change remove(const StoredJob& job, const char* reason);
    void remove_unpinned(const std::string& id, const char* reason);

    // Calls `body`, which makes jobs fewer. If it cannot be written, as on a full disk, calls it again with the space
    // of the store's log, and then with that of the reserve.
    template <class Body>
    auto write_at_last(const Body& body) {
        const auto use_log = [&] {
            try {
                store.reuse_log();
            } catch (const base::Error&) {
                // It has no space that could be used.
            }
        };
        try {
            return body();
        } catch (const base::Error&) {
            use_log();
        }
        try {
            return body();
        } catch (const base::Error&) {
            if (!reserve.give_up()) throw;
            use_log();
        }
        return body();
    }

    std::string version, checked_program;
    JobNews news;
    StateFolder folder;  // locked before the members below exist, and until they are gone
    JobFolders folders;
    Reserve reserve;
    std::unique_ptr<JobStore> opened;
    JobStore& store;
    Presence presence;
    JobBoard board;
    Workplace place;
    std::vector<std::thread> workers;
    std::thread sweeper;
    std::mutex joining;
    std::mutex pinning;  // held while a job is pinned or retried, or removed unless it is
};

}  // namespace shadowbench::service
