// The side of a technique's process: it opens a library and does what it is asked for on its standard input.
#pragma once

#include <string>

namespace shadowbench::service {

// Serves until the other side closes the connection, which is its standard input, a socket. What the library itself
// reads or prints goes to /dev/null. Throws Error{io} if that cannot be arranged. A file of another hash is not opened:
// its answers would count as those of the file that was described.
void host_techniques(const std::string& library, const std::string& hash);

}  // namespace shadowbench::service
