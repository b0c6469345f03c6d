// Shows the progress of a command.
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

// On a terminal it draws one line again and again and removes it at the end. Elsewhere, for example in a log, it writes
// a line every few seconds: "progress: 2/5 key build 3/7, 25 s". A thread draws, so that a long step shows progress
// too; all signals are blocked in it.
class ProgressBar {
public:
    enum class Style { none, bar, lines };

    // On standard error a bar for a terminal, else lines; on any other stream nothing.
    explicit ProgressBar(std::ostream& stream);
    // Writes a line, or draws the bar, once per `every`. show() also draws the bar.
    ProgressBar(std::ostream& stream, Style style, std::chrono::milliseconds every);
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    void show(const bench::Progress& progress);
    void end();  // removes the bar; nothing is written afterwards

private:
    void tick(const std::stop_token& stop);
    std::string text() const;
    void draw();  // with the mutex held

    std::ostream& stream_;
    const Style style_;
    const std::chrono::milliseconds every_;
    const std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
    std::mutex mutex_;  // guards the members below
    std::condition_variable_any ended_;
    std::string what_ = "preparing";
    std::size_t done_ = 0, total_ = 0;
    std::chrono::steady_clock::time_point drawn_{};
    std::size_t length_ = 0;  // characters of the bar on the screen
    std::jthread ticker_;
};

}  // namespace shadowbench::service
