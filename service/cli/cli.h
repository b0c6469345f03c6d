// The command line: arguments in, text and an exit code out.
#pragma once

#include <iosfwd>
#include <string>

namespace shadowbench::service {

// Runs a command. Results go to `out`, errors (one line each) and progress to `err`. Returns the exit code: 0, 1 or 2
// as the command's --help says, or a value of base::ErrorCode. Throws nothing.
int cli_main(int argc, const char* const* argv, std::ostream& out, std::ostream& err);

// The message of wrong usage; empty where the arguments can be parsed. Runs nothing.
std::string usage_fault(int argc, const char* const* argv);

}  // namespace shadowbench::service
