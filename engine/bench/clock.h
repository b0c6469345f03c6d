// A stopwatch of wall time.
#pragma once

#include <chrono>

namespace shadowbench::bench {

// Wall time since construction.
class Stopwatch {
public:
    double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point start_ = Clock::now();
};

}  // namespace shadowbench::bench
