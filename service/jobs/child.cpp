#include "service/jobs/child.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <system_error>

#include "base/error.h"
#include "service/process/bound_group.h"

namespace shadowbench::service {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds tick{50};
constexpr std::size_t kept_errors = 4096;
constexpr std::size_t most_at_once = std::size_t{1} << 20;  // bytes read between two looks at the clock

[[noreturn]] void fail(const char* what) {
    throw base::Error(base::ErrorCode::io, "", std::string(what) + ": " + std::generic_category().message(errno));
}

struct Pipe {
    Pipe() {
        if (::pipe2(ends, O_CLOEXEC) != 0) fail("a job's process cannot be started");
    }
    ~Pipe() {
        for (const int end : ends)
            if (end >= 0) ::close(end);
    }
    Pipe(const Pipe&) = delete;
    Pipe& operator=(const Pipe&) = delete;
    void close(int which) {
        ::close(ends[which]);
        ends[which] = -1;
    }
    int ends[2] = {-1, -1};
};

void write_text(const char* file, std::string_view text) {
    const int to = ::open(file, O_WRONLY | O_CLOEXEC);
    if (to < 0) return;
    [[maybe_unused]] const ssize_t ignored = ::write(to, text.data(), text.size());
    ::close(to);
}

// In the new process, where the memory is a copy and other threads may have held any lock: system calls alone.
[[noreturn]] void become(char* const* arguments, int out, int err, const BoundGroup& group) {
    group.join();
    sigset_t none;
    ::sigemptyset(&none);
    ::sigprocmask(SIG_SETMASK, &none, nullptr);
    for (const int usual : {SIGPIPE, SIGINT, SIGTERM, SIGHUP}) ::signal(usual, SIG_DFL);
    const int nothing = ::open("/dev/null", O_RDONLY);
    if (nothing < 0 || ::dup2(nothing, 0) < 0 || ::dup2(out, 1) < 0 || ::dup2(err, 2) < 0) ::_exit(not_started);
    ::close_range(3, ~0u, CLOSE_RANGE_CLOEXEC);  // connections of clients among them
    write_text("/proc/self/oom_score_adj", "1000");
    ::execv(arguments[0], arguments);
    ::_exit(not_started);
}

pid_t start(const std::vector<std::string>& arguments, const Pipe& out, const Pipe& err, const BoundGroup& group) {
    std::vector<char*> pointers;
    for (const std::string& argument : arguments) pointers.push_back(const_cast<char*>(argument.c_str()));
    pointers.push_back(nullptr);
    const pid_t child = ::fork();
    if (child < 0) fail("a job's process cannot be started");
    if (child == 0) become(pointers.data(), out.ends[1], err.ends[1], group);
    return child;
}

// Bytes that are resident; 0 of a process that has ended.
std::size_t resident(pid_t process) {
    const std::string place = "/proc/" + std::to_string(process) + "/statm";
    std::FILE* file = std::fopen(place.c_str(), "re");
    if (!file) return 0;
    unsigned long long all = 0, pages = 0;
    const bool read = std::fscanf(file, "%llu %llu", &all, &pages) == 2;
    std::fclose(file);
    return read ? static_cast<std::size_t>(pages) * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)) : 0;
}

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

// Whether it has ended. It is not reaped: until then its number is nobody else's.
bool has_ended(pid_t child) {
    siginfo_t info{};
    return ::waitid(P_PID, static_cast<id_t>(child), &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid == child;
}

// Kills what is left of the group, and reaps the child.
void reap(pid_t child, const BoundGroup& group, ChildReport& report) {
    group.kill();
    ::kill(child, SIGKILL);  // which may have left the group
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    report.code = WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status);
    if (report.end == ChildEnd::exited && WIFSIGNALED(status)) report.end = ChildEnd::signalled;
}

}  // namespace

ChildReport run_child(const std::vector<std::string>& arguments, const ChildLimits& limits,
                      const std::function<void(std::string_view)>& on_line, const std::function<bool()>& should_end) {
    const BoundGroup group;
    Pipe out, err;
    const pid_t child = start(arguments, out, err, group);
    out.close(1);
    err.close(1);

    ChildReport report;
    try {
        Stream output(out.ends[0]), errors(err.ends[0]);
        Lines lines(on_line);
        std::size_t bytes = 0;
        const auto read_all = [&] {
            bytes += output.read([&](std::string_view text) { lines.add(text); });
            bytes += errors.read([&](std::string_view text) { keep_last(report.errors, text); });
        };
        const auto end_of_time = Clock::now() + std::chrono::duration<double>(limits.seconds);
        const auto beyond = [&]() -> ChildEnd {
            if (should_end()) return ChildEnd::told;
            if (bytes > limits.output) return ChildEnd::too_much_output;
            if (Clock::now() > end_of_time) return ChildEnd::out_of_time;
            if (resident(child) > limits.memory) return ChildEnd::out_of_memory;
            return ChildEnd::exited;
        };
        int quick = 20;  // the end of its output mostly is its own: then its exit is a matter of microseconds
        for (auto next_look = Clock::now() + tick; !has_ended(child);) {
            pollfd waiting[] = {output.waiting(), errors.waiting()};
            ::poll(waiting, 2, !output.open() && quick > 0 ? 1 : static_cast<int>(tick.count()));
            if (!output.open() && quick > 0) --quick;
            read_all();
            if (Clock::now() < next_look) continue;
            next_look = Clock::now() + tick;
            report.end = beyond();
            if (report.end != ChildEnd::exited) break;
        }
        if (report.end == ChildEnd::exited) read_all();
    } catch (...) {
        reap(child, group, report);
        throw;
    }
    reap(child, group, report);
    return report;
}

}  // namespace shadowbench::service
