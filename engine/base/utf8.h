// Checks UTF-8. Text from outside may be any bytes, but JSON and terminals take only UTF-8.
#pragma once

#include <cstddef>
#include <string_view>

namespace shadowbench::base {

// The length in bytes of the well-formed sequence at the front of a text, which must not be empty; 0 if there is none.
// The Unicode Standard 15, table 3-7.
std::size_t utf8_sequence(std::string_view text);

bool is_utf8(std::string_view text);

// Drops the byte-order mark of UTF-8 from the front of a text. Throws Error{bad_input}, place `where`, for the mark of
// UTF-16 or UTF-32.
std::string_view without_mark(std::string_view text, std::string_view where);

}  // namespace shadowbench::base
