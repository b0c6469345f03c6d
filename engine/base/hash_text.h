// Hashes a text, to name it briefly.
#pragma once

#include <string>

namespace shadowbench::base {

// 64-bit FNV-1a (Fowler, Noll, Vo 1991) of a text, as 16 hexadecimal digits.
std::string hash_text(const std::string& text);

}  // namespace shadowbench::base
