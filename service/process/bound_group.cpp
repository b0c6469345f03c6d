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

// In a copy of this process, where other threads may have held any lock: system calls only.
[[noreturn]] void keep(int line) {
    if (::setpgid(0, 0) != 0) ::_exit(1);  // else it would kill another group than its own
    ::prctl(PR_SET_NAME, "keeper");
    sigset_t all;
    ::sigfillset(&all);
    ::sigprocmask(SIG_BLOCK, &all, nullptr);  // what a terminal sends is for the others
    // It keeps nothing else open: no end of a pipe, no lock, no connection.
    if (::dup2(line, 0) < 0) ::_exit(1);
    ::close_range(1, ~0u, 0);
    char byte;
    while (::read(0, &byte, 1) < 0 && errno == EINTR) {
    }
    ::kill(0, SIGKILL);
    ::_exit(0);
}

}  // namespace

BoundGroup::BoundGroup() : parent_(::getpid()) {
    keeper_ = ::fork();
    if (keeper_ == 0) keep(line_.read.number());
    if (keeper_ < 0)
        throw base::Error(base::ErrorCode::io, "",
                          "a process cannot be started: " + std::generic_category().message(errno));
    line_.read.close();
    ::setpgid(keeper_, keeper_);  // whichever of the two comes first
}

BoundGroup::~BoundGroup() {
    kill();
    line_.write.close();
    while (::waitpid(keeper_, nullptr, 0) < 0 && errno == EINTR) {
    }
}

bool BoundGroup::join() const {
    if (::setpgid(0, keeper_) != 0 || ::prctl(PR_SET_PDEATHSIG, SIGKILL) != 0) return false;
    errno = ESRCH;
    return ::getppid() == parent_;
}

void BoundGroup::kill() const {
    ::kill(-keeper_, SIGKILL);
}

}  // namespace shadowbench::service
