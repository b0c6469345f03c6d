#include "service/cli/terminal.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <charconv>
#include <cstdlib>
#include <iostream>
#include <string_view>

#include "base/table.h"

namespace shadowbench::service {
namespace {

constexpr std::size_t standard_width = 100, most_width = 1000;

std::string_view variable(const char* name) {
    const char* value = std::getenv(name);
    return value ? value : "";
}

}  // namespace

bool is_terminal(const std::ostream& stream) {
    return &stream == &std::cout && isatty(STDOUT_FILENO) == 1;
}

std::size_t line_width(const std::ostream& stream) {
    const std::string_view columns = variable("COLUMNS");
    const char* const end = columns.data() + columns.size();
    std::size_t characters = 0;
    const auto [rest, fault] = std::from_chars(columns.data(), end, characters);
    if (fault == std::errc() && rest == end && characters > 0 && characters <= most_width) return characters;
    winsize size{};
    if (is_terminal(stream) && ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
    return standard_width;
}

std::string terminal_lines(const std::string& text, const std::ostream& stream) {
    return is_terminal(stream) ? base::wrapped(text, line_width(stream)) : text;
}

bool shows_colour(const std::ostream& stream) {
    return is_terminal(stream) && variable("NO_COLOR").empty() && variable("TERM") != "dumb";
}

results::TableStyle table_style(const std::ostream& stream) {
    return {line_width(stream), shows_colour(stream)};
}

}  // namespace shadowbench::service
