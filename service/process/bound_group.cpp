#include "service/process/bound_group.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>

#include "base/error.h"

namespace shadowbench::service {
namespace {

constexpr int not_started = 127;

[[noreturn]] void fail() {
    throw base::Error(base::ErrorCode::io, "",
                      "a process cannot be started: " + std::generic_category().message(errno));
}

// In a copy of this process, where other threads may have held any lock: system calls alone.
[[noreturn]] void keep(int line) {
    if (::setpgid(0, 0) != 0) ::_exit(not_started);  // else it would kill another group than its own
    ::prctl(PR_SET_NAME, "keeper");
    sigset_t all;
    ::sigfillset(&all);
    ::sigprocmask(SIG_BLOCK, &all, nullptr);  // what a terminal sends is for the others
    // Nothing stays open on its account: no end of a pipe, no lock, no connection.
    if (::dup2(line, 0) < 0) ::_exit(not_started);
    ::close_range(1, ~0u, 0);
    char byte;
    while (::read(0, &byte, 1) < 0 && errno == EINTR) {
    }
    ::kill(0, SIGKILL);
    ::_exit(0);
}

}  // namespace

BoundGroup::BoundGroup() : parent_(::getpid()) {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) fail();
    keeper_ = ::fork();
    if (keeper_ == 0) keep(ends[0]);
    const int failed = errno;
    ::close(ends[0]);
    line_ = ends[1];
    if (keeper_ < 0) {
        ::close(line_);
        errno = failed;
        fail();
    }
    ::setpgid(keeper_, keeper_);  // whichever of the two comes first
}

BoundGroup::~BoundGroup() {
    kill();
    ::close(line_);
    while (::waitpid(keeper_, nullptr, 0) < 0 && errno == EINTR) {
    }
}

void BoundGroup::join() const {
    ::setpgid(0, keeper_);
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent_) ::_exit(not_started);
}

void BoundGroup::kill() const {
    ::kill(-keeper_, SIGKILL);
}

}  // namespace shadowbench::service
