// Scenarios from strangers: checked with all their files, and what they will cost, by a helper.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <string>
#include <variant>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "base/error.h"
#include "service/api/helper.h"
#include "service/api/lru.h"

namespace shadowbench::service {

// Throws the Error that a line of a helper holds; the line's value otherwise.
nlohmann::json take_answer(const std::string& line);

// A few of the same at a time; others wait their turn, for a while.
class Slots {
public:
    explicit Slots(std::size_t most) : free_(most) {}
    class Slot {
    public:
        explicit Slot(Slots& slots) : slots_(slots) {}
        ~Slot() { slots_.give_back(); }
        Slot(const Slot&) = delete;
        Slot& operator=(const Slot&) = delete;

    private:
        Slots& slots_;
    };
    // Throws Error{io} after `seconds` without a turn.
    Slot take(double seconds);

private:
    void give_back();
    std::mutex mutex_;
    std::condition_variable freed_;
    std::size_t free_;
};

// Thread-safe. The last answers are kept: the same scenario is often sent again.
class Examiner {
public:
    Examiner(StartHelper start, std::vector<std::string> arguments, double seconds);

    // What helper_side.h's examine_lines says of a scenario, JSON on one line: facts, or faults. Throws Error.
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
