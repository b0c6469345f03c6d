// The curves of pixels, as a page asks for them while the mouse moves: helpers stay with the last few lights, and the
// last answers are kept.
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
    // `arguments` come before those of the light; `waiting`: how many may wait for their turn.
    CurveCache(StartHelper start, std::vector<std::string> arguments, double seconds, std::size_t waiting);

    // JSON of bench::PixelCurves. `scenario`, the job's on one line, is asked for only when it is needed, and before a
    // helper is started: what it throws is thrown. A helper stays once its first answer was good. Throws Error, Busy.
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
    std::map<std::string, std::weak_ptr<Worker>> fresh_;  // that have not answered yet, held by who asks
};

}  // namespace shadowbench::service
