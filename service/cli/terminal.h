// What a terminal can show.
#pragma once

#include <cstddef>
#include <iosfwd>
#include <string>

#include "results/report.h"

namespace shadowbench::service {

// Whether this is standard output, and a terminal.
bool is_terminal(const std::ostream& stream);

// Characters of a line: $COLUMNS, or the width of the terminal, or 100 where there is none.
std::size_t line_width(const std::ostream& stream);

// The text, in lines of the terminal's width where the stream is one. Elsewhere, lines stay whole for other programs.
std::string terminal_lines(const std::string& text, const std::ostream& stream);

// Only for a terminal that can show colours (TERM is not "dumb"), and unless NO_COLOR is set (no-color.org).
bool shows_colour(const std::ostream& stream);

results::TableStyle table_style(const std::ostream& stream);

}  // namespace shadowbench::service
