#include "service/cli/child.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

#include <fmt/format.h>

#include "base/error.h"
#include "service/process/bound_group.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;
using base::Error;
using base::ErrorCode;

// In the new process: system calls alone, as in every copy of a program that may have threads. A failure is told
// through `fault`, which exec() closes.
[[noreturn]] void become(char* const* argv, int log, int fault, const sigset_t& signals, const BoundGroup& group) {
    group.join();
    const int nothing = ::open("/dev/null", O_RDONLY);
    if (nothing >= 0 && ::dup2(nothing, STDIN_FILENO) >= 0 && ::dup2(log, STDOUT_FILENO) >= 0 &&
        ::dup2(log, STDERR_FILENO) >= 0 && ::sigprocmask(SIG_SETMASK, &signals, nullptr) == 0)
        ::execv(argv[0], argv);
    const int why = errno;
    [[maybe_unused]] const ssize_t ignored = ::write(fault, &why, sizeof why);
    ::_exit(127);
}

class Descriptor {
public:
    explicit Descriptor(int number) : number_(number) {}
    ~Descriptor() { close(); }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    int number() const { return number_; }
    void close() {
        if (number_ >= 0) ::close(number_);
        number_ = -1;
    }

private:
    int number_;
};

pid_t start(char* const* argv, const fs::path& log, const sigset_t& signals, const BoundGroup& group) {
    const auto fail = [&](int why) {
        throw Error(ErrorCode::io, argv[0], fmt::format("cannot be started: {}", std::strerror(why)));
    };
    const Descriptor to(::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600));
    int ends[2] = {-1, -1};
    if (to.number() < 0 || ::pipe2(ends, O_CLOEXEC) != 0) fail(errno);
    const Descriptor fault(ends[0]);
    Descriptor mine(ends[1]);
    const pid_t child = ::fork();
    if (child < 0) fail(errno);
    if (child == 0) become(argv, to.number(), mine.number(), signals, group);
    mine.close();
    int why = 0;
    ssize_t count = 0;
    while ((count = ::read(fault.number(), &why, sizeof why)) < 0 && errno == EINTR) {
    }
    if (count == sizeof why) {
        while (::waitpid(child, nullptr, 0) < 0 && errno == EINTR) {
        }
        fail(why);
    }
    return child;
}

// Its status.
int wait_for(pid_t child, const BoundGroup& group, const EndingSignals& signals) {
    int status = 0;
    for (;;) {
        const pid_t ended = waitpid(child, &status, WNOHANG);
        if (ended == child) return status;
        if (ended < 0 && errno != EINTR) return -1;
        if (const int signal = signals.wait()) {
            group.kill();  // nothing of it is kept
            kill(child, SIGKILL);
            while (waitpid(child, nullptr, 0) < 0 && errno == EINTR) {
            }
            throw Interrupted{signal};
        }
    }
}

}  // namespace

EndingSignals::EndingSignals() {
    sigemptyset(&waiting_);
    sigaddset(&waiting_, SIGCHLD);
    for (const int signal : {SIGHUP, SIGINT, SIGQUIT, SIGTERM}) {
        struct sigaction now {};
        if (sigaction(signal, nullptr, &now) == 0 && now.sa_handler != SIG_IGN) sigaddset(&waiting_, signal);
    }
    pthread_sigmask(SIG_BLOCK, &waiting_, &before_);
}

EndingSignals::~EndingSignals() {
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

sigset_t EndingSignals::let_through() const {
    sigset_t mask = before_;
    for (int signal = 1; signal < NSIG; ++signal)
        if (sigismember(&waiting_, signal) == 1) sigdelset(&mask, signal);
    return mask;
}

int EndingSignals::wait() const {
    const timespec a_while{0, 200'000'000};
    const int signal = sigtimedwait(&waiting_, nullptr, &a_while);
    return signal > 0 && signal != SIGCHLD ? signal : 0;
}

TemporaryFolder::TemporaryFolder() {
    std::error_code failed;
    std::string name = (fs::temp_directory_path(failed) / "shadowbench-XXXXXX").string();
    if (failed || !mkdtemp(name.data()))
        throw Error(ErrorCode::io, name, fmt::format("cannot make a temporary folder: {}", std::strerror(errno)));
    path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

void check_program(const std::string& program) {
    std::error_code failed;
    if (!fs::exists(program, failed)) throw Error(ErrorCode::no_such_file, program, "there is no such program");
    if (fs::is_directory(program, failed) || access(program.c_str(), X_OK) != 0)
        throw Error(ErrorCode::usage, program, "this is no program that can be run");
}

int run_child(const std::string& program, const std::vector<std::string>& arguments, const fs::path& log) {
    std::vector<std::string> words{program};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    const EndingSignals signals;
    const BoundGroup group;
    const pid_t child = start(argv.data(), log, signals.let_through(), group);
    const int status = wait_for(child, group, signals);
    if (status >= 0 && WIFSIGNALED(status))
        throw Error(ErrorCode::internal, program,
                    fmt::format("was ended by signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status))));
    return status >= 0 ? WEXITSTATUS(status) : static_cast<int>(ErrorCode::internal);
}

}  // namespace shadowbench::service
