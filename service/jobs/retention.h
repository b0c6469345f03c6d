// Removes jobs that are too old, too many or too large: see Retention.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "service/jobs/worker.h"

namespace shadowbench::service {

struct Removable {
    std::string id;
    const char* reason;  // "age", "number", "space"
};

// The jobs to remove, the first to end first. `jobs` are sorted by their end.
std::vector<Removable> choose_removable(const std::vector<JobStore::Ended>& jobs, const Retention& keep,
                                        const std::string& now);

// Removes jobs whenever one has ended, and at least once a minute, until the board stops. A job that
// cannot be removed keeps no other one, is reported once, and is tried again the next time.
void sweep(const Workplace& place, const std::function<void(const std::string& id, const char* reason)>& remove);

}  // namespace shadowbench::service
