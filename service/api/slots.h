// Limits how many requests work at a time, and how many wait. A request that waits for a helper holds a thread of the
// server.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <mutex>

namespace shadowbench::service {

// Too many requests of one kind work or wait: the answer is 503.
struct Busy {};

// Thread-safe.
class Slots {
public:
    // `most` work at a time; `waiting` more may wait for their turn.
    Slots(std::size_t most, std::size_t waiting) : free_(most), waiting_(waiting) {}
    class Slot {
    public:
        explicit Slot(Slots& slots) : slots_(slots) {}
        ~Slot() { slots_.give_back(); }
        Slot(const Slot&) = delete;
        Slot& operator=(const Slot&) = delete;

    private:
        Slots& slots_;
    };
    // Waits for a turn. Throws Busy at once where too many wait already, and after `seconds` without a turn.
    Slot take(double seconds);

private:
    void give_back();
    std::mutex mutex_;
    std::condition_variable freed_;
    std::size_t free_, waiting_;  // how many more may work, and how many may wait
};

}  // namespace shadowbench::service
