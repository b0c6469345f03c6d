#include "service/api/helper.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/error.h"
#include "service/process/bound_group.h"

namespace shadowbench::service {
namespace {

using base::Error;
using base::ErrorCode;
using Clock = std::chrono::steady_clock;

// Sanitizers reserve terabytes of address space.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool limit_memory = false;
#else
constexpr bool limit_memory = true;
#endif

constexpr const char* dead = "it ended the process that looked at it; it may need more memory than this server allows";
constexpr std::size_t longest_answer = std::size_t{64} << 20;

[[noreturn]] void fail(const char* what) {
    throw Error(ErrorCode::io, "helper process", std::string(what) + ": " + std::strerror(errno));
}

[[noreturn]] void refuse(const char* why) {
    throw Error(ErrorCode::bad_input, "", why);
}

struct Pipe {
    int read = -1, write = -1;
    Pipe() {
        int ends[2];
        if (::pipe2(ends, O_CLOEXEC) != 0) fail("pipe");
        read = ends[0];
        write = ends[1];
    }
    ~Pipe() {
        close(read);
        close(write);
    }
    static void close(int& end) {
        if (end >= 0) ::close(end);
        end = -1;
    }
    static int take(int& end) { return std::exchange(end, -1); }
};

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

// Between fork and exec: calls that are safe there alone.
[[noreturn]] void become(const Pipe& in, const Pipe& out, std::size_t memory, char* const* argv,
                         const BoundGroup& group) {
    group.join();
    ::dup2(in.read, 0);
    ::dup2(out.write, 1);
    ::close_range(3, ~0u, CLOSE_RANGE_CLOEXEC);  // at exec: the program's name may be one of them
    const rlimit none{0, 0}, bytes{memory, memory};
    ::setrlimit(RLIMIT_CORE, &none);
    if (limit_memory) ::setrlimit(RLIMIT_AS, &bytes);
    sigset_t all;
    sigemptyset(&all);
    sigprocmask(SIG_SETMASK, &all, nullptr);
    ::execv(argv[0], argv);
    ::_exit(127);
}

class Process final : public Helper {
public:
    Process(const std::string& program, const std::vector<std::string>& arguments, std::size_t memory) {
        std::vector<std::string> words{program};
        words.insert(words.end(), arguments.begin(), arguments.end());
        std::vector<char*> argv;
        for (std::string& word : words) argv.push_back(word.data());
        argv.push_back(nullptr);
        Pipe in, out;
        child_ = ::fork();
        if (child_ < 0) fail("fork");
        if (child_ == 0) become(in, out, memory, argv.data(), group_);
        to_ = Pipe::take(in.write);
        from_ = Pipe::take(out.read);
        for (const int end : {to_, from_}) ::fcntl(end, F_SETFL, O_NONBLOCK);
    }
    ~Process() override {
        ::close(to_);
        ::close(from_);
        group_.kill();
        ::kill(child_, SIGKILL);  // which may have left the group
        while (::waitpid(child_, nullptr, 0) < 0 && errno == EINTR) {
        }
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

    // What the child has said by now; false: nothing.
    bool take() {
        char piece[65536];
        const ssize_t n = ::read(from_, piece, sizeof piece);
        if (n == 0) refuse(dead);
        if (n < 0 && errno != EAGAIN && errno != EINTR) fail("read");
        if (n > 0) buffer_.append(piece, static_cast<std::size_t>(n));
        if (buffer_.size() > longest_answer) refuse("its answer is too long");
        return n > 0;
    }

    BoundGroup group_;
    pid_t child_ = -1;
    int to_ = -1, from_ = -1;
    std::string buffer_;
};

}  // namespace

std::unique_ptr<Helper> start_process(const std::string& program, const std::vector<std::string>& arguments,
                                      std::size_t memory) {
    return std::make_unique<Process>(program, arguments, memory);
}

}  // namespace shadowbench::service
