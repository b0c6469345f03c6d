// Work on strangers' scenarios, in a child process of its own: one that runs away or crashes ends alone.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace shadowbench::service {

// A child that answers lines with lines.
class Helper {
public:
    virtual ~Helper() = default;
    // One line, without its end, to the child, and its answer. Throws Error{bad_input} when it takes more than
    // `seconds`, or ends without an answer, as one does that asks for more memory than it may have.
    virtual std::string ask(const std::string& line, double seconds) = 0;
};

// Starts a subcommand of this program.
using StartHelper = std::function<std::unique_ptr<Helper>(const std::vector<std::string>& arguments)>;

// `program arguments...` with a limit in bytes on its address space, killed when the Helper goes; its standard error is
// this process's. Throws as ChildProcess does.
std::unique_ptr<Helper> start_process(const std::string& program, const std::vector<std::string>& arguments,
                                      std::size_t memory);

}  // namespace shadowbench::service
