// How far a command is, for those who wait for it.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <iosfwd>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>

#include "bench/progress.h"

namespace shadowbench::service {

// On a terminal one line that is drawn over and over, and gone at the end. Elsewhere, as in a log, a line every few
// seconds: "progress: 2/5 key build 3/7, 25 s". A thread of its own draws, so that long pieces of work show life too;
// signals never end up in it.
class ProgressBar {
public:
    enum class Style { none, bar, lines };

    // On standard error, whichever fits what reads it; on any other stream nothing.
    explicit ProgressBar(std::ostream& stream);
    // A line, or a drawing, `every` so often, besides those that show() draws on a bar.
    ProgressBar(std::ostream& stream, Style style, std::chrono::milliseconds every);
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    void show(const bench::Progress& progress);
    void end();  // nothing is written after it; the bar is gone

private:
    void tick(const std::stop_token& stop);
    std::string text() const;
    void draw();  // with the mutex held

    std::ostream& stream_;
    const Style style_;
    const std::chrono::milliseconds every_;
    const std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
    std::mutex mutex_;  // of all below
    std::condition_variable_any ended_;
    std::string what_ = "preparing";
    std::size_t done_ = 0, total_ = 0;
    std::chrono::steady_clock::time_point drawn_{};
    std::size_t length_ = 0;  // of the bar on the screen
    std::jthread ticker_;
};

}  // namespace shadowbench::service
