// The command line: arguments in, text and an exit code out.
#pragma once

#include <iosfwd>

namespace shadowbench::service {

// Results go to `out`, errors (one line each) and progress to `err`. Returns the exit code: 0, or a value of
// base::ErrorCode. Throws nothing.
int cli_main(int argc, const char* const* argv, std::ostream& out, std::ostream& err);

}  // namespace shadowbench::service
