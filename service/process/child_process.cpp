#include "service/process/child_process.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <system_error>

#include "base/error.h"

namespace shadowbench::service {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool limits_address_space = false;
#else
constexpr bool limits_address_space = true;
#endif

// From here to become(): in the new process, where the memory is a copy and other threads may have held any lock.
// System calls only. False, and errno, where one fails.

bool take_streams(const Streams& streams) {
    int from[] = {streams.in, streams.out, streams.err};
    for (int& stream : from) {  // out of the places that the others are to take
        if (stream < 0) stream = ::open("/dev/null", O_RDWR | O_CLOEXEC);
        stream = ::fcntl(stream, F_DUPFD_CLOEXEC, 3);
        if (stream < 0) return false;
    }
    for (int to = 0; to < 3; ++to)
        if (::dup2(from[to], to) < 0) return false;
    return ::close_range(3, ~0u, CLOSE_RANGE_CLOEXEC) == 0;  // by exec(): the program's path may lead through one
}

bool limit(std::size_t address_space) {
    if (const int file = ::open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC); file >= 0) {
        [[maybe_unused]] const ssize_t ignored = ::write(file, "1000", 4);
        ::close(file);
    }
    const rlimit none{0, 0};
    if (::setrlimit(RLIMIT_CORE, &none) != 0) return false;
    if (address_space == 0 || !limits_address_space) return true;
    rlimit bytes;
    if (::getrlimit(RLIMIT_AS, &bytes) != 0) return false;
    bytes.rlim_cur = bytes.rlim_max = std::min<rlim_t>(bytes.rlim_max, address_space);
    return ::setrlimit(RLIMIT_AS, &bytes) == 0;
}

bool reset_signals() {
    for (int signal = 1; signal < NSIG; ++signal) ::signal(signal, SIG_DFL);  // fails where there is nothing to reset
    sigset_t none;
    ::sigemptyset(&none);
    return ::sigprocmask(SIG_SETMASK, &none, nullptr) == 0;
}

// Writes errno to `fault` where the program cannot be run; exec() closes it.
[[noreturn]] void become(char* const* words, const Streams& streams, std::size_t address_space, int fault,
                         const BoundGroup& group) {
    const int kept = ::fcntl(fault, F_DUPFD_CLOEXEC, 3);
    if (kept >= 0 && group.join() && take_streams(streams) && limit(address_space) && reset_signals())
        ::execv(words[0], words);
    const int why = errno;
    [[maybe_unused]] const ssize_t ignored = ::write(kept >= 0 ? kept : fault, &why, sizeof why);
    ::_exit(1);
}

}  // namespace

ChildProcess::ChildProcess(const std::string& program, const std::vector<std::string>& arguments,
                           const Streams& streams, std::size_t address_space) {
    std::vector<char*> words{const_cast<char*>(program.c_str())};
    for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
    words.push_back(nullptr);
    Pipe fault;
    sigset_t all, before;
    ::sigfillset(&all);
    ::pthread_sigmask(SIG_SETMASK, &all, &before);  // so that no handler of this process runs in the new one
    child_ = ::fork();
    if (child_ == 0) become(words.data(), streams, address_space, fault.write.number(), group_);
    int why = errno;
    ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
    const auto because = [&] { return std::generic_category().message(why); };
    if (child_ < 0) throw base::Error(base::ErrorCode::io, program, "a process cannot be started: " + because());
    fault.write.close();
    ssize_t count;
    while ((count = ::read(fault.read.number(), &why, sizeof why)) < 0 && errno == EINTR) {
    }
    if (count <= 0) return;
    end();
    throw base::Error(base::ErrorCode::internal, program, "the program cannot be started: " + because());
}

ChildProcess::~ChildProcess() {
    if (child_ > 0) end();
}

// The child is not reaped here, so its process id cannot be reused.
bool ChildProcess::has_ended() const {
    siginfo_t info{};
    const int failed = ::waitid(P_PID, static_cast<id_t>(child_), &info, WEXITED | WNOHANG | WNOWAIT);
    return failed ? errno != EINTR : info.si_pid == child_;
}

std::size_t ChildProcess::resident() const {
    const std::string place = "/proc/" + std::to_string(child_) + "/statm";
    std::FILE* file = std::fopen(place.c_str(), "re");
    if (!file) return 0;
    unsigned long long all = 0, pages = 0;
    const bool read = std::fscanf(file, "%llu %llu", &all, &pages) == 2;
    std::fclose(file);
    return read ? static_cast<std::size_t>(pages) * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)) : 0;
}

void ChildProcess::terminate() const {
    ::kill(child_, SIGTERM);
}

ChildExit ChildProcess::end() {
    group_.kill();
    ::kill(child_, SIGKILL);  // which may have left the group
    int status = SIGKILL;     // also where this process ignores SIGCHLD, and the end is lost
    while (::waitpid(child_, &status, 0) < 0 && errno == EINTR) {
    }
    child_ = -1;
    const bool by_signal = WIFSIGNALED(status);
    return {by_signal, by_signal ? WTERMSIG(status) : WEXITSTATUS(status)};
}

}  // namespace shadowbench::service
