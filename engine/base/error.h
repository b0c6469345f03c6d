// The one exception of shadowbench. It is caught in two places only: main (exit code) and the HTTP handler.
#pragma once

#include <exception>
#include <string>
#include <string_view>

namespace shadowbench::base {

// Values are the process exit codes (sysexits.h numbering).
enum class ErrorCode {
    usage = 64,         // the command line is wrong
    bad_input = 65,     // a scenario, a file's content or a parameter is wrong, or over a limit
    no_such_file = 66,  // a named file does not exist
    internal = 70,      // a fault of the program
    io = 74,            // reading or writing failed
};

// `where` is a JSON pointer ("/lights/0/angle"), "file", "file:offset" (bytes) or "file:line"; it may be empty. what()
// is one line: "where: message". All three are printable UTF-8: control characters become spaces, and bytes that are
// not UTF-8 become '?'.
class Error : public std::exception {
public:
    Error(ErrorCode code, std::string_view where, std::string_view message);

    const char* what() const noexcept override { return line_.c_str(); }
    ErrorCode code() const { return code_; }
    const std::string& where() const { return where_; }
    const std::string& message() const { return message_; }

private:
    ErrorCode code_;
    std::string where_;
    std::string message_;
    std::string line_;
};

}  // namespace shadowbench::base
