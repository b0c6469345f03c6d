// Text that quotes a file, made fit to be shown: a file may hold any bytes, a terminal would obey some of them, and
// JSON would not take others.
#pragma once

#include <string>
#include <string_view>

namespace shadowbench::base {

// Control characters become spaces, and what is no UTF-8 '?'.
std::string printable(std::string_view text);

}  // namespace shadowbench::base
