// Text from outside may be any bytes; JSON, and a terminal, take UTF-8 alone.
#pragma once

#include <cstddef>
#include <string_view>

namespace shadowbench::base {

// Bytes of the well-formed sequence at the front of a text that is not empty; 0 where there is none. The Unicode
// Standard 15, table 3-7.
std::size_t utf8_sequence(std::string_view text);

bool is_utf8(std::string_view text);

// Text as files hold it, without the byte-order mark of UTF-8 that it may begin with. Throws Error{bad_input}, place
// `where`, for the mark of UTF-16 or UTF-32.
std::string_view without_mark(std::string_view text, std::string_view where);

}  // namespace shadowbench::base
