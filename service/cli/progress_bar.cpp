#include "service/cli/progress_bar.h"

#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <iostream>

#include <fmt/format.h>

namespace shadowbench::service {
namespace {

using std::chrono::steady_clock;

constexpr std::size_t width = 30;
constexpr std::chrono::milliseconds between_frames{50}, between_ticks{1000}, between_log_lines{5000};

ProgressBar::Style style_of(const std::ostream& stream) {
    if (&stream != &std::cerr) return ProgressBar::Style::none;
    return isatty(STDERR_FILENO) == 1 ? ProgressBar::Style::bar : ProgressBar::Style::lines;
}

// Blocks all signals while it lives, also in threads that are started meanwhile.
class NoSignals {
public:
    NoSignals() {
        sigset_t all;
        sigfillset(&all);
        pthread_sigmask(SIG_SETMASK, &all, &before_);
    }
    ~NoSignals() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
    NoSignals(const NoSignals&) = delete;
    NoSignals& operator=(const NoSignals&) = delete;

private:
    sigset_t before_{};
};

}  // namespace

ProgressBar::ProgressBar(std::ostream& stream)
    : ProgressBar(stream, style_of(stream), style_of(stream) == Style::bar ? between_ticks : between_log_lines) {}

ProgressBar::ProgressBar(std::ostream& stream, Style style, std::chrono::milliseconds every)
    : stream_(stream), style_(style), every_(every) {
    if (style_ == Style::none) return;
    const NoSignals during_the_start;
    ticker_ = std::jthread([this](const std::stop_token& stop) { tick(stop); });
}

ProgressBar::~ProgressBar() {
    end();
}

void ProgressBar::show(const bench::Progress& progress) {
    if (style_ == Style::none) return;
    const std::lock_guard lock(mutex_);
    what_ = progress.place + (progress.place.empty() ? "" : " ") + progress.stage;
    done_ = progress.done;
    total_ = progress.total;
    if (style_ != Style::bar) return;
    if (steady_clock::now() - drawn_ >= between_frames || done_ >= total_) draw();
}

void ProgressBar::end() {
    if (!ticker_.joinable()) return;
    ticker_.request_stop();
    ticker_.join();
    if (length_ > 0) stream_ << '\r' << std::string(length_, ' ') << '\r' << std::flush;
    length_ = 0;
}

void ProgressBar::tick(const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    while (!ended_.wait_for(lock, stop, every_, [&] { return stop.stop_requested(); }) && !stop.stop_requested())
        draw();
}

std::string ProgressBar::text() const {
    const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(steady_clock::now() - started_).count();
    return fmt::format("{}{}, {} s", what_, total_ ? fmt::format(" {}/{}", done_, total_) : "", seconds);
}

void ProgressBar::draw() {
    drawn_ = steady_clock::now();
    if (style_ == Style::lines) {
        stream_ << "progress: " + text() + "\n" << std::flush;
        return;
    }
    const std::size_t filled = total_ ? std::min(width, width * done_ / total_) : 0;
    const std::string line = fmt::format("[{:#<{}}{:.<{}}] {}", "", filled, "", width - filled, text());
    stream_ << '\r' << line << std::string(length_ > line.size() ? length_ - line.size() : 0, ' ') << std::flush;
    length_ = std::max(length_, line.size());
}

}  // namespace shadowbench::service
