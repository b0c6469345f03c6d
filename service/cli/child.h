// The child processes of commands, and the signals that end a command meanwhile.
#pragma once

#include <signal.h>

#include <filesystem>
#include <string>
#include <vector>

namespace shadowbench::service {

// Throws Error{no_such_file} where it is not there, {usage} where it cannot be executed.
void check_program(const std::string& program);

// The path of a program in $PATH. Throws Error{no_such_file}, place: its name, that ends with the remedy.
std::string find_program(const std::string& name, const std::string& remedy);

// While it lives, signals that end a program (SIGHUP, SIGINT, SIGQUIT, SIGTERM) wait: run_child() looks for them, and
// the end of the last such object lets them through. A command makes one before its temporary folder, so that a signal
// never leaves the folder behind. Ignored ones (nohup) stay ignored.
class EndingSignals {
public:
    EndingSignals();
    ~EndingSignals();
    EndingSignals(const EndingSignals&) = delete;
    EndingSignals& operator=(const EndingSignals&) = delete;

    // The signal that came, or 0: a child may have ended, or some time has gone by.
    int wait() const;

private:
    sigset_t waiting_{}, before_{};
};

// One of them came while a child ran. The child is gone, with all that it started.
struct Interrupted {
    int signal;
};

// Runs a program to its end, with nothing on its standard input and all its output in the file `log`. Returns its exit
// code. Throws as ChildProcess does, Error{io} where the log cannot be written, Error{internal}, place: the program,
// where a signal ended it, and Interrupted.
int run_child(const std::string& program, const std::vector<std::string>& arguments, const std::filesystem::path& log);

}  // namespace shadowbench::service
