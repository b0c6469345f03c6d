// Quotes words of commands that a message prints.
#pragma once

#include <string>

namespace shadowbench::base {

// The text as one word of a POSIX shell, in quotes if it needs them.
std::string shell_word(const std::string& text);

}  // namespace shadowbench::base
