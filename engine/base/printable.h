// Makes text that quotes a file fit to be shown. A file may hold any bytes; a terminal would obey some of them, and
// JSON refuses others.
#pragma once

#include <string>
#include <string_view>

namespace shadowbench::base {

// Replaces control characters by spaces and bytes that are not UTF-8 by '?'.
std::string printable(std::string_view text);

}  // namespace shadowbench::base
