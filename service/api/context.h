// The state that all answers of the API share.
#pragma once

#include <atomic>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "service/api/curve_cache.h"
#include "service/api/examine.h"
#include "service/api/metrics.h"
#include "service/api/service.h"

namespace shadowbench::service {

struct Context {
    Jobs& jobs;
    ServiceOptions options;
    Examiner examiner;
    CurveCache curves;
    Metrics metrics;
    std::shared_ptr<std::atomic<std::size_t>> streams = std::make_shared<std::atomic<std::size_t>>(0);
    std::string scenarios;  // the answer to /v1/scenarios

    Context(Jobs& jobs, const ServiceOptions& options);
};

}  // namespace shadowbench::service
