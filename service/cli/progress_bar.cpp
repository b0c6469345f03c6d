#include "service/cli/progress_bar.h"

#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <string>

#include <fmt/format.h>

namespace shadowbench::service {
namespace {

constexpr std::size_t width = 30;
constexpr std::chrono::milliseconds between_frames{50};

}  // namespace

ProgressBar::~ProgressBar() {
    if (length_ > 0) stream_ << '\r' << std::string(length_, ' ') << '\r' << std::flush;
}

void ProgressBar::show(const bench::Progress& progress) {
    const auto now = std::chrono::steady_clock::now();
    if (now - shown_ < between_frames && progress.done < progress.total) return;
    shown_ = now;
    const std::size_t filled = progress.total ? std::min(width, width * progress.done / progress.total) : 0;
    const std::string text =
        fmt::format("[{:#<{}}{:.<{}}] {}{}{} {}/{}", "", filled, "", width - filled, progress.place,
                    progress.place.empty() ? "" : " ", progress.stage, progress.done, progress.total);
    stream_ << '\r' << text << std::string(length_ > text.size() ? length_ - text.size() : 0, ' ') << std::flush;
    length_ = std::max(length_, text.size());
}

bool is_terminal(const std::ostream& err) {
    return &err == &std::cerr && isatty(STDERR_FILENO) == 1;
}

}  // namespace shadowbench::service
