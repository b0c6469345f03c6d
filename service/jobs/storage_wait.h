// How the workers wait while the server's storage fails.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <exception>
#include <optional>
#include <string>
#include <type_traits>

#include "service/jobs/worker.h"

namespace shadowbench::service {

// The server's storage failed, which is not a fault of the job: the job waits. `bytes`: space that it needs.
struct Waits {
    std::string why;
    std::uintmax_t bytes;
};

// Marks the server's storage as failing from begin() to its destructor. The operator gets one message, however often
// and by however many workers the storage is tried.
class StorageAlarm {
public:
    explicit StorageAlarm(const Workplace& place) : place_(place) {}
    ~StorageAlarm();
    StorageAlarm(const StorageAlarm&) = delete;
    StorageAlarm& operator=(const StorageAlarm&) = delete;

    void begin(const std::string& why);

private:
    const Workplace& place_;
    bool begun_ = false;
};

// Waits, longer each time, or until the server stops.
class Patience {
public:
    void wait(const JobBoard& board) {
        board.pause(next_);
        next_ = std::min(next_ * 2, longest);
    }

private:
    static constexpr std::chrono::milliseconds first{250}, longest{10000};
    std::chrono::milliseconds next_ = first;
};

// Calls `body` until the storage lets it succeed. Nothing when the server stops first: the next server then finds the
// job unchanged.
template <class Body>
auto persist(const Workplace& place, const Body& body) -> std::optional<std::decay_t<decltype(body())>> {
    StorageAlarm alarm(place);
    for (Patience patience;;) {
        try {
            return body();
        } catch (const std::exception& error) {
            if (place.board.stopping()) return std::nullopt;
            alarm.begin(error.what());
            patience.wait(place.board);
        }
    }
}

// Whether the disk has less free space than limits.min_free, were `own` bytes of it removed.
bool is_low(const Workplace& place, std::uintmax_t own = 0);

// Throws Error{io} where no job may start: the state folder is gone, or the disk is low. Elsewhere takes the reserve,
// if it was given up.
void check_storage(const Workplace& place);

// Returns when jobs may start and there is room for more than the job had written, when the job is no longer queued, or
// when the server stops.
void wait_for_room(const Workplace& place, const StoredJob& job, const Waits& waits, Patience& patience);

}  // namespace shadowbench::service
