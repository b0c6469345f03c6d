// Child processes, and a folder for what they leave.
#pragma once

#include <signal.h>

#include <filesystem>
#include <string>
#include <vector>

namespace shadowbench::service {

// A new empty folder of its own, gone with all that is in it.
class TemporaryFolder {
public:
    TemporaryFolder();  // throws Error{io}
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

// Throws Error{no_such_file} where it is not there, {usage} where it cannot be executed.
void check_program(const std::string& program);

// While it lives, signals that end a program (SIGHUP, SIGINT, SIGQUIT, SIGTERM) wait: run_child() looks for them, and
// the end of the last such object lets them through. A command makes one before its temporary folder, so that no moment
// leaves that behind. Ignored ones (nohup) stay ignored.
class EndingSignals {
public:
    EndingSignals();
    ~EndingSignals();
    EndingSignals(const EndingSignals&) = delete;
    EndingSignals& operator=(const EndingSignals&) = delete;

    sigset_t let_through() const;  // the mask of a child
    // The signal that came, or 0: a child may have ended, or some time has gone by.
    int wait() const;

private:
    sigset_t waiting_{}, before_{};
};

// One of them came while a child ran. The child is gone, with all that it started.
struct Interrupted {
    int signal;
};

// Runs a program to its end, with nothing on its standard input and what it writes in `log`; it and what it started
// die with this process, however that ends (BoundGroup). Its exit code; throws
// Error{io} where it cannot be started and {internal} where a signal ended it, place: the program; Interrupted.
int run_child(const std::string& program, const std::vector<std::string>& arguments, const std::filesystem::path& log);

}  // namespace shadowbench::service
