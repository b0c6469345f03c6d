// Scenarios from strangers: checked with all their files, and what they will cost, by a helper.
#pragma once

#include <cstddef>
#include <mutex>
#include <string>
#include <variant>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "base/error.h"
#include "service/api/helper.h"
#include "service/api/lru.h"
#include "service/api/slots.h"

namespace shadowbench::service {

// Throws the Error that a line of a helper holds; the line's value otherwise.
nlohmann::json take_answer(const std::string& line);

// Thread-safe. The last answers are kept: the same scenario is often sent again.
class Examiner {
public:
    // `waiting`: how many may wait for their turn.
    Examiner(StartHelper start, std::vector<std::string> arguments, double seconds, std::size_t waiting);

    // What helper_side.h's examine_lines says of a scenario, JSON on one line: facts, or faults. Throws Error, Busy.
    std::variant<nlohmann::json, std::vector<base::Error>> examine(const std::string& scenario);

private:
    StartHelper start_;
    std::vector<std::string> arguments_;
    double seconds_;
    Slots slots_;
    std::mutex mutex_;
    Lru<std::string> answers_;
};

}  // namespace shadowbench::service
