#include "service/cli/child.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

#include <fmt/format.h>

#include "base/error.h"

extern char** environ;

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;
using base::Error;
using base::ErrorCode;

class FileActions {
public:
    explicit FileActions(const fs::path& log) {
        posix_spawn_file_actions_init(&actions_);
        posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
        posix_spawn_file_actions_addopen(&actions_, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        posix_spawn_file_actions_adddup2(&actions_, STDOUT_FILENO, STDERR_FILENO);
    }
    ~FileActions() { posix_spawn_file_actions_destroy(&actions_); }
    FileActions(const FileActions&) = delete;
    FileActions& operator=(const FileActions&) = delete;
    const posix_spawn_file_actions_t* get() const { return &actions_; }

private:
    posix_spawn_file_actions_t actions_;
};

// In a group of its own, so that all it started can be ended with it.
class SpawnAttributes {
public:
    explicit SpawnAttributes(const sigset_t& signals) {
        posix_spawnattr_init(&attributes_);
        posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETPGROUP);
        posix_spawnattr_setsigmask(&attributes_, &signals);
        posix_spawnattr_setpgroup(&attributes_, 0);
    }
    ~SpawnAttributes() { posix_spawnattr_destroy(&attributes_); }
    SpawnAttributes(const SpawnAttributes&) = delete;
    SpawnAttributes& operator=(const SpawnAttributes&) = delete;
    const posix_spawnattr_t* get() const { return &attributes_; }

private:
    posix_spawnattr_t attributes_;
};

// Its status.
int wait_for(pid_t child, const EndingSignals& signals) {
    int status = 0;
    for (;;) {
        const pid_t ended = waitpid(child, &status, WNOHANG);
        if (ended == child) return status;
        if (ended < 0 && errno != EINTR) return -1;
        if (const int signal = signals.wait()) {
            kill(-child, SIGKILL);  // nothing of it is kept
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
    const FileActions actions(log);
    const EndingSignals signals;
    const SpawnAttributes attributes(signals.let_through());
    pid_t child = 0;
    if (const int failed = posix_spawn(&child, program.c_str(), actions.get(), attributes.get(), argv.data(), environ))
        throw Error(ErrorCode::io, program, fmt::format("cannot be started: {}", std::strerror(failed)));
    const int status = wait_for(child, signals);
    if (status >= 0 && WIFSIGNALED(status))
        throw Error(ErrorCode::internal, program,
                    fmt::format("was ended by signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status))));
    return status >= 0 ? WEXITSTATUS(status) : static_cast<int>(ErrorCode::internal);
}

}  // namespace shadowbench::service
