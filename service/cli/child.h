// Child processes, and a folder for what they leave.
#pragma once

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

// SIGHUP, SIGINT or SIGTERM came while a child ran. The child is gone, with all that it started.
struct Interrupted {
    int signal;
};

// Runs a program to its end, with nothing on its standard input and what it writes in `log`. Its exit code; throws
// Error{io} where it cannot be started and {internal} where a signal ended it, place: the program; Interrupted.
int run_child(const std::string& program, const std::vector<std::string>& arguments, const std::filesystem::path& log);

}  // namespace shadowbench::service
