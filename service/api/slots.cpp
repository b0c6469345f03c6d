#include "service/api/slots.h"

#include <chrono>

namespace shadowbench::service {

Slots::Slot Slots::take(double seconds) {
    std::unique_lock lock(mutex_);
    if (free_ == 0) {
        if (waiting_ == 0) throw Busy{};
        --waiting_;
        const bool turn = freed_.wait_for(lock, std::chrono::duration<double>(seconds), [&] { return free_ > 0; });
        ++waiting_;
        if (!turn) throw Busy{};
    }
    --free_;
    return Slot(*this);
}

void Slots::give_back() {
    const std::scoped_lock lock(mutex_);
    ++free_;
    freed_.notify_one();
}

}  // namespace shadowbench::service
