// Controls callgrind. If its header is missing at build time, running() is always false.
#pragma once

#include <string>

namespace shadowbench::kernels::callgrind {

bool running();

// Counts the instructions of this program from start() to stop(), which dumps the count under this name and resets it
// to 0.
void start();
void stop(const std::string& name);

}  // namespace shadowbench::kernels::callgrind
