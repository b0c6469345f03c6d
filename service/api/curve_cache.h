// Caches the visibility functions of pixels, which the page requests while the mouse moves. It keeps the helper
// processes of the last few lights, and the last answers.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "service/api/examine.h"
#include "service/api/helper.h"
#include "service/api/lru.h"
#include "service/api/slots.h"

namespace shadowbench::service {

struct CurveQuestion {
    std::string job, light;
    std::size_t variant = 0;
    int x = 0, y = 0;
};

// Thread-safe.
class CurveCache {
public:
    // `arguments` go to each helper, before those of the light. `seconds`: longest wait for one answer. `waiting`:
    // requests that may wait for their turn.
    CurveCache(StartHelper start, std::vector<std::string> arguments, double seconds, std::size_t waiting);

    // The JSON of bench::PixelCurves. `scenario` gives the job's scenario on one line; it is called only before a
    // helper is started, and what it throws is passed on. A helper is kept once its first answer is not an error.
    // Throws Error, Busy.
    std::string curves(const CurveQuestion& question, const std::function<std::string()>& scenario);

private:
    struct Worker {
        std::timed_mutex mutex;
        std::unique_ptr<Helper> helper;
    };
    std::shared_ptr<Worker> worker_for(const std::string& key);

    StartHelper start_;
    std::vector<std::string> arguments_;
    double seconds_;
    Slots slots_;
    std::mutex mutex_;
    Lru<std::string> answers_;
    Lru<std::shared_ptr<Worker>> workers_;
    std::map<std::string, std::weak_ptr<Worker>> fresh_;  // workers without a first answer; their requests own them
};

}  // namespace shadowbench::service
