#include "service/api/helper.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include "base/error.h"
#include "service/process/child_process.h"

namespace shadowbench::service {
namespace {

using base::Error;
using base::ErrorCode;
using Clock = std::chrono::steady_clock;

constexpr const char* dead =
    "checking it failed, since the process ended; it may need more memory than this server allows";
constexpr std::size_t longest_answer = std::size_t{64} << 20;

[[noreturn]] void fail(const char* what) {
    throw Error(ErrorCode::io, "helper process", std::string(what) + ": " + std::strerror(errno));
}

[[noreturn]] void refuse(const char* why) {
    throw Error(ErrorCode::bad_input, "", why);
}

// A child that has gone is an error of write(), and no signal, for this thread.
class NoPipeSignal {
public:
    NoPipeSignal() {
        sigemptyset(&pipe_);
        sigaddset(&pipe_, SIGPIPE);
        pthread_sigmask(SIG_BLOCK, &pipe_, &before_);
    }
    ~NoPipeSignal() {
        const timespec at_once{0, 0};
        if (!sigismember(&before_, SIGPIPE))
            while (sigtimedwait(&pipe_, nullptr, &at_once) > 0) {
            }
        pthread_sigmask(SIG_SETMASK, &before_, nullptr);
    }
    NoPipeSignal(const NoPipeSignal&) = delete;
    NoPipeSignal& operator=(const NoPipeSignal&) = delete;

private:
    sigset_t pipe_{}, before_{};
};

class Process final : public Helper {
public:
    Process(const std::string& program, const std::vector<std::string>& arguments, std::size_t memory)
        : child_(program, arguments, {in_.read.number(), out_.write.number(), STDERR_FILENO}, memory) {
        in_.read.close();
        out_.write.close();
        for (const int end : {to_, from_}) ::fcntl(end, F_SETFL, O_NONBLOCK);
    }

    std::string ask(const std::string& line, double seconds) override {
        const auto end =
            Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
        const NoPipeSignal no_signal;
        send(line + "\n", end);
        return receive(end);
    }

private:
    // Until the child answers, or takes more where there is more to send.
    void wait(bool sending, Clock::time_point end) {
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
        pollfd ends[2] = {{from_, POLLIN, 0}, {to_, POLLOUT, 0}};
        const int ready =
            left > 0 ? ::poll(ends, sending ? 2 : 1, static_cast<int>(std::min<long long>(left, 1'000'000))) : 0;
        if (ready < 0 && errno != EINTR) fail("poll");
        if (ready == 0) refuse("it takes longer than this server allows");
    }

    void send(const std::string& text, Clock::time_point end) {
        for (std::size_t sent = 0; sent < text.size();) {
            const ssize_t n = ::write(to_, text.data() + sent, text.size() - sent);
            if (n > 0) {
                sent += static_cast<std::size_t>(n);
            } else if (errno == EAGAIN) {
                wait(true, end);
                take();  // a child that nobody listens to would not listen either
            } else if (errno != EINTR) {
                refuse(dead);
            }
        }
    }

    std::string receive(Clock::time_point end) {
        for (;;) {
            if (const std::size_t at = buffer_.find('\n'); at != std::string::npos) {
                std::string line = buffer_.substr(0, at);
                buffer_.erase(0, at + 1);
                return line;
            }
            if (!take()) wait(false, end);
        }
    }

    // Reads what the child has written; returns false if there is nothing.
    bool take() {
        char piece[65536];
        const ssize_t n = ::read(from_, piece, sizeof piece);
        if (n == 0) refuse(dead);
        if (n < 0 && errno != EAGAIN && errno != EINTR) fail("read");
        if (n > 0) buffer_.append(piece, static_cast<std::size_t>(n));
        if (buffer_.size() > longest_answer) refuse("its answer is too long");
        return n > 0;
    }

    Pipe in_, out_;
    ChildProcess child_;
    const int to_ = in_.write.number(), from_ = out_.read.number();
    std::string buffer_;
};

}  // namespace

std::unique_ptr<Helper> start_process(const std::string& program, const std::vector<std::string>& arguments,
                                      std::size_t memory) {
    return std::make_unique<Process>(program, arguments, memory);
}

}  // namespace shadowbench::service
