// The child process of a job: its lines and its limits.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace shadowbench::service {

struct ChildLimits {
    double seconds = 3600.0;
    std::size_t memory = std::size_t{16} << 30;  // bytes that are resident: see run_child
    std::size_t output = std::size_t{64} << 20;  // bytes on standard output and standard error together
    // Seconds that it may take to end once its standard input is closed, and as many after a SIGTERM then. Until then a
    // byte comes there every second, so that it knows that this process lives. 0: it has nothing on its standard input,
    // and is killed at once.
    double farewell = 0.0;
};

// lost: what became of the program is not known (launched.h).
enum class ChildEnd { exited, signalled, out_of_time, out_of_memory, too_much_output, stopped, lost };

struct ChildReport {
    ChildEnd end = ChildEnd::exited;
    int code = 0;        // exit code, or the signal's number
    std::string errors;  // the last of what it wrote to standard error
};

inline constexpr std::size_t longest_line = 8192;  // of standard output; longer ones are left out

// Runs the program with nothing on its standard input but what `farewell` says, and returns once it and all that it
// started have ended. `on_line` gets each whole line of its standard output, without its end. `should_end` is asked
// every 50 ms: the program is ended once it answers true, or goes beyond a limit.
//
// The memory limit watches the resident bytes of the process, by the same clock. Throws as ChildProcess does.
ChildReport run_child(const std::string& program, const std::vector<std::string>& arguments, const ChildLimits& limits,
                      const std::function<void(std::string_view line)>& on_line,
                      const std::function<bool()>& should_end);

}  // namespace shadowbench::service
