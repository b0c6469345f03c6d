// The API: JSON in, JSON out, no sockets. Thread-safe.
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

namespace shadowbench::service {

// The largest scenarios that are taken. All but the body are judged by an estimate made before the job is queued.
struct CostLimits {
    std::size_t body = std::size_t{4} << 20;  // bytes of a request
    int resolution = 4096;                    // map pixels a side
    int samples_per_pixel = 4096;             // light rays, and of the truth
    double bytes = 8.0 * (1 << 30);           // that a run surely needs
    double seconds = 1800.0;                  // of a run, guessed
};

struct ServiceOptions {
    std::vector<std::filesystem::path> data;       // folders of the files that scenarios may name
    std::vector<std::filesystem::path> scenarios;  // folders of the scenarios that /v1/scenarios gives
    CostLimits limits;
    StartHelper start_helper;        // of subcommands of this program
    double helper_seconds = 20.0;    // that one answer of a helper may take
    std::size_t waiting = 8;         // requests of one kind that may wait for a helper: fewer than there are threads
    std::size_t event_streams = 64;  // clients that may follow events at a time
};

class Service {
public:
    // Reads the scenarios. `jobs` outlives the service.
    Service(Jobs& jobs, ServiceOptions options);
    ~Service();
    Service(const Service&) = delete;
    Service& operator=(const Service&) = delete;

    // What speaks against a request before its body is read: 404, 405, 406, 413, 415; nothing: go on.
    std::optional<ApiResponse> refuse(const ApiRequest& request) const;

    // The answer to a whole request. Throws nothing.
    ApiResponse handle(const ApiRequest& request);

    // Counts an answer that was given without handle().
    void count_refusal(const ApiRequest& request, int status);

    const CostLimits& limits() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace shadowbench::service
