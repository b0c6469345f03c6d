// The side of a technique's process: it opens a library and does what it is asked for on its standard input.
#pragma once

#include <string>

namespace shadowbench::service {

// Serves until the other side closes the connection, which is its standard input, a socket. What the library itself
// reads or prints goes to /dev/null. Throws Error{io} if that cannot be arranged.
void host_techniques(const std::string& library);

}  // namespace shadowbench::service
