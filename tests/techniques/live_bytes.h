// Bytes that the program holds through operator new just now.
#pragma once

#include <cstddef>

namespace shadowbench::techniques::testing {

std::size_t live_bytes();

}  // namespace shadowbench::techniques::testing
