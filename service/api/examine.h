// Checks scenarios of clients with all their files, and estimates their cost, in a helper process.
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "base/error.h"
#include "service/api/helper.h"
#include "service/api/lru.h"
#include "service/api/slots.h"

namespace shadowbench::service {

// The value of a helper's line. Throws the Error that the line holds, and Error{internal} where it is not a JSON
// object.
nlohmann::json take_answer(const std::string& line);

// Thread-safe. It keeps the last answers, since clients often send the same scenario again, and the processes that gave
// them, since starting one takes longer than most answers. A process goes after some hundred answers, or a fault.
class Examiner {
public:
    // `seconds`: longest wait for one answer. `waiting`: requests that may wait for their turn.
    Examiner(StartHelper start, std::vector<std::string> arguments, double seconds, std::size_t waiting);

    // `scenario` is JSON on one line, and so is `recommend`, a recommend::Request, where it is not empty. The facts or
    // the faults that examine_lines() in helper_side.h finds. Throws Error, Busy.
    std::variant<nlohmann::json, std::vector<base::Error>> examine(const std::string& scenario,
                                                                   const std::string& recommend = "");

    // The scenario around data files, as JSON; `request` is that of scenario_around() in new_files.h, on one line.
    // Throws as that does, and Busy.
    std::string arrange(const std::string& request);

private:
    struct Idle {
        std::unique_ptr<Helper> helper;
        int answers;  // so far
    };
    std::string ask(const std::string& question);
    std::optional<std::string> ask_idle(const std::string& question);
    void keep(Idle helper);

    StartHelper start_;
    std::vector<std::string> arguments_;
    double seconds_;
    Slots slots_;
    std::mutex mutex_;
    Lru<std::string> answers_;
    std::vector<Idle> idle_;
};

}  // namespace shadowbench::service
