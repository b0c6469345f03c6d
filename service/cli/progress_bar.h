#pragma once

#include <chrono>
#include <cstddef>
#include <iosfwd>

#include "bench/progress.h"

namespace shadowbench::service {

// One line that is drawn over and over, and gone at the end.
class ProgressBar {
public:
    explicit ProgressBar(std::ostream& stream) : stream_(stream) {}
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    void show(const bench::Progress& progress);

private:
    std::ostream& stream_;
    std::chrono::steady_clock::time_point shown_{};
    std::size_t length_ = 0;
};

// Whether this is standard error and a terminal reads it.
bool is_terminal(const std::ostream& err);

}  // namespace shadowbench::service
