// Work that holds a thread of the server while a helper does it: so much of it at a time, and so much that waits.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <mutex>

namespace shadowbench::service {

// Too much of one kind is at work: 503, to be tried again soon.
struct Busy {};

// Thread-safe.
class Slots {
public:
    // `most` at a time; `waiting` more may wait for their turn.
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
    // Throws Busy: at once where as many wait as may, else after `seconds` without a turn.
    Slot take(double seconds);

private:
    void give_back();
    std::mutex mutex_;
    std::condition_variable freed_;
    std::size_t free_, waiting_;  // how many more may work, and may wait
};

}  // namespace shadowbench::service
