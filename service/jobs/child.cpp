#include "service/jobs/child.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>

#include "service/process/child_process.h"

namespace shadowbench::service {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds tick{50};
constexpr std::chrono::seconds between_signs{1};  // of life
constexpr std::size_t kept_errors = 4096;
constexpr std::size_t most_at_once = std::size_t{1} << 20;  // bytes read between two looks at the clock

// Cuts what comes into lines.
class Lines {
public:
    explicit Lines(const std::function<void(std::string_view)>& on_line) : on_line_(on_line) {}

    void add(std::string_view text) {
        for (std::size_t end; (end = text.find('\n')) != std::string_view::npos; text.remove_prefix(end + 1)) {
            take(text.substr(0, end));
            if (!too_long_) on_line_(line_);
            line_.clear();
            too_long_ = false;
        }
        take(text);
    }

private:
    void take(std::string_view text) {
        too_long_ = too_long_ || line_.size() + text.size() > longest_line;
        if (!too_long_) line_ += text;
    }

    const std::function<void(std::string_view)>& on_line_;
    std::string line_;
    bool too_long_ = false;
};

void keep_last(std::string& kept, std::string_view text) {
    kept += text;
    if (kept.size() > kept_errors) kept.erase(0, kept.size() - kept_errors);
}

// One end of a pipe, until the other is closed.
class Stream {
public:
    explicit Stream(int file) : file_(file) { ::fcntl(file, F_SETFL, O_NONBLOCK); }

    bool open() const { return file_ >= 0; }
    pollfd waiting() const { return {file_, POLLIN, 0}; }  // poll() passes over -1

    // Gives what is there, but not without end; the number of bytes.
    std::size_t read(const std::function<void(std::string_view)>& use) {
        char buffer[16384];
        std::size_t all = 0;
        while (open() && all < most_at_once) {
            const ssize_t count = ::read(file_, buffer, sizeof buffer);
            if (count < 0 && errno == EINTR) continue;
            if (count < 0 && errno == EAGAIN) break;
            if (count <= 0) {
                file_ = -1;
                break;
            }
            use({buffer, static_cast<std::size_t>(count)});
            all += static_cast<std::size_t>(count);
        }
        return all;
    }

private:
    int file_;
};

}  // namespace

ChildReport run_child(const std::string& program, const std::vector<std::string>& arguments, const ChildLimits& limits,
                      const std::function<void(std::string_view)>& on_line, const std::function<bool()>& should_end) {
    Pipe in, out, err;
    const bool polite = limits.farewell > 0.0;
    ChildProcess child(program, arguments,
                       {.in = polite ? in.read.number() : -1, .out = out.write.number(), .err = err.write.number()});
    ::fcntl(in.write.number(), F_SETFL, O_NONBLOCK);
    // This process keeps the reading end too, so that writing never raises SIGPIPE.
    auto next_sign = Clock::now();
    const auto give_sign = [&] {
        if (!polite || Clock::now() < next_sign) return;
        next_sign = Clock::now() + between_signs;
        [[maybe_unused]] const ssize_t ignored = ::write(in.write.number(), "\n", 1);  // if it is full, none is needed
    };
    out.write.close();
    err.write.close();

    ChildReport report;
    Stream output(out.read.number()), errors(err.read.number());
    Lines lines(on_line);
    std::size_t bytes = 0;
    const auto read_all = [&] {
        bytes += output.read([&](std::string_view text) { lines.add(text); });
        bytes += errors.read([&](std::string_view text) { keep_last(report.errors, text); });
    };
    const auto end_of_time = Clock::now() + std::chrono::duration<double>(limits.seconds);
    const auto beyond = [&]() -> ChildEnd {
        if (should_end()) return ChildEnd::stopped;
        if (bytes > limits.output) return ChildEnd::too_much_output;
        if (Clock::now() > end_of_time) return ChildEnd::out_of_time;
        if (child.resident() > limits.memory) return ChildEnd::out_of_memory;
        return ChildEnd::exited;
    };
    const auto farewell = [&] {
        const auto end = Clock::now() + std::chrono::duration<double>(limits.farewell);
        for (; !child.has_ended() && Clock::now() < end; read_all()) {
            pollfd waiting[] = {output.waiting(), errors.waiting()};
            ::poll(waiting, 2, static_cast<int>(tick.count()));
        }
    };
    int quick = 20;  // a child that closes its output usually exits within microseconds
    for (auto next_look = Clock::now() + tick; report.end == ChildEnd::exited && !child.has_ended();) {
        pollfd waiting[] = {output.waiting(), errors.waiting()};
        ::poll(waiting, 2, !output.open() && quick > 0 ? 1 : static_cast<int>(tick.count()));
        if (!output.open() && quick > 0) --quick;
        read_all();
        if (Clock::now() < next_look) continue;
        next_look = Clock::now() + tick;
        give_sign();
        report.end = beyond();
    }
    if (report.end != ChildEnd::exited && polite) {
        in.write.close();
        farewell();
        if (!child.has_ended()) child.terminate();
        farewell();
    }
    if (report.end == ChildEnd::exited) read_all();
    const ChildExit exit = child.end();
    report.code = exit.code;
    if (report.end == ChildEnd::exited && exit.by_signal) report.end = ChildEnd::signalled;
    return report;
}

}  // namespace shadowbench::service
