// The API: answers requests, without sockets. Thread-safe.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "service/api/helper.h"
#include "service/api/message.h"
#include "service/jobs/jobs.h"
#include "service/log/log.h"

namespace shadowbench::service {

// The largest scenarios that are accepted. All limits but the body's apply to the estimate that is made before a job is
// queued.
struct CostLimits {
    std::size_t body = std::size_t{4} << 20;  // bytes of a request
    int resolution = 4096;                    // map pixels a side
    int samples_per_pixel = 4096;             // light rays, and rays of the reference
    double bytes = 8.0 * (1 << 30);           // of memory that a run certainly needs
    double seconds = 1800.0;                  // estimated duration of a run
};

struct ServiceOptions {
    std::vector<std::filesystem::path> data;       // folders with files that scenarios may name
    std::vector<std::filesystem::path> scenarios;  // folders with the scenarios that /v1/scenarios lists
    std::filesystem::path state;                   // of the jobs: its files are no data, even inside a data folder
    CostLimits limits;
    StartHelper start_helper;        // starts a subcommand of this program
    double helper_seconds = 20.0;    // longest wait for one answer of a helper
    std::size_t waiting = 8;         // requests of one kind that may wait for a helper; less than the number of threads
    std::size_t event_streams = 64;  // clients that may follow events at a time
    double pace = 1.0;               // of this machine, for estimates: bench::measure_pace()
    Log log = {};                    // gets the causes of answers 500 and of 503 for faults of the storage
};

class Service {
public:
    // Reads the scenarios. `jobs` outlives the service.
    Service(Jobs& jobs, ServiceOptions options);
    ~Service();
    Service(const Service&) = delete;
    Service& operator=(const Service&) = delete;

    // The answer that refuses a request before its body is read: 400, 404, 405, 406 or 415. Nothing: go on.
    std::optional<ApiResponse> refuse(const ApiRequest& request) const;

    // The answer to a complete request. Throws nothing.
    ApiResponse handle(const ApiRequest& request);

    // Counts an answer that did not come from handle().
    void count_refusal(const ApiRequest& request, int status);

    const CostLimits& limits() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace shadowbench::service
