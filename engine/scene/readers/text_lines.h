// Lines, words and numbers of text formats.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace shadowbench::scene {

// Takes the next line of a text, without its end: LF, CR LF or CR.
std::string_view next_line(std::string_view& text);

// Takes the next word of a line, up to a space or tab; empty at the line's end.
std::string_view next_word(std::string_view& line);

// The number that a word is, if it is finite and at most max_coordinate on both sides of 0. Takes a plus sign off the
// front of the word.
std::optional<double> coordinate(std::string_view& word);

// With the letters A to Z as a to z.
std::string lower_case(std::string_view text);

}  // namespace shadowbench::scene
