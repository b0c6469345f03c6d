// Bytes that the program holds through operator new now.
#pragma once

#include <cstddef>

namespace shadowbench::techniques::testing {

std::size_t live_bytes();

// The most that it held at once since the last call of forget_peak().
std::size_t peak_bytes();
void forget_peak();

}  // namespace shadowbench::techniques::testing
