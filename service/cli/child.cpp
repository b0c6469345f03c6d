#include "service/cli/child.h"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <system_error>

#include <fmt/format.h>

#include "base/error.h"
#include "service/process/child_process.h"

namespace shadowbench::service {

namespace fs = std::filesystem;
using base::Error;
using base::ErrorCode;

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

int EndingSignals::wait() const {
    const timespec a_while{0, 200'000'000};
    const int signal = sigtimedwait(&waiting_, nullptr, &a_while);
    return signal > 0 && signal != SIGCHLD ? signal : 0;
}

void check_program(const std::string& program) {
    std::error_code failed;
    if (!fs::exists(program, failed)) throw Error(ErrorCode::no_such_file, program, "there is no such program");
    if (fs::is_directory(program, failed) || access(program.c_str(), X_OK) != 0)
        throw Error(ErrorCode::usage, program, "this file cannot be executed; name a program");
}

std::string find_program(const std::string& name, const std::string& remedy) {
    const char* path = std::getenv("PATH");
    std::istringstream folders(path ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');) {
        const fs::path program = fs::path(folder) / name;
        if (access(program.c_str(), X_OK) == 0) return program.string();
    }
    throw Error(ErrorCode::no_such_file, name, "the program is not in $PATH; " + remedy);
}

int run_child(const std::string& program, const std::vector<std::string>& arguments, const fs::path& log) {
    const Descriptor to(::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600));
    if (to.number() < 0)
        throw Error(ErrorCode::io, log.string(), fmt::format("the file cannot be written: {}", std::strerror(errno)));
    const EndingSignals signals;
    ChildProcess child(program, arguments, {.out = to.number(), .err = to.number()});
    while (!child.has_ended())
        if (const int signal = signals.wait()) throw Interrupted{signal};
    const ChildExit exit = child.end();
    if (exit.by_signal)
        throw Error(ErrorCode::internal, program,
                    fmt::format("was ended by signal {} ({})", exit.code, strsignal(exit.code)));
    return exit.code;
}

}  // namespace shadowbench::service
