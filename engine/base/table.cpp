#include "base/table.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <utility>

#include <fmt/format.h>

namespace shadowbench::base {
namespace {

constexpr std::size_t least_width = 20;

// Without the colours, each of which is an escape sequence that ends with an m.
std::size_t visible_size(const std::string& text) {
    std::size_t size = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '\x1b')
            i = std::min(text.find('m', i), text.size());
        else
            ++size;
    }
    return size;
}

// Where to break a word: before the character of UTF-8 that holds this byte.
std::size_t within_word(const std::string& line, std::size_t at) {
    std::size_t cut = at;
    while (cut > at - 3 && (static_cast<unsigned char>(line[cut]) & 0xc0) == 0x80) --cut;
    return cut;
}

}  // namespace

Table::Table(std::vector<std::string> header) {
    rows_.push_back(std::move(header));
}

void Table::add(std::vector<std::string> row) {
    rows_.push_back(std::move(row));
}

std::string Table::text(const std::string& indent) const {
    std::vector<std::size_t> widths(rows_[0].size(), 0);
    for (const auto& row : rows_)
        for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], visible_size(row[c]));
    std::string text;
    for (const auto& row : rows_) {
        std::string line = indent;
        for (std::size_t c = 0; c < row.size(); ++c) {
            const bool left = c == 0 || c + 1 == row.size();
            if (c > 0) line += "  ";
            const std::string padding(widths[c] - visible_size(row[c]), ' ');
            line += left ? row[c] + padding : padding + row[c];
        }
        text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
    }
    return text;
}

std::string wrapped(const std::string& text, std::size_t width) {
    width = std::max(width, least_width);
    std::string result;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        const std::size_t first = std::min(line.find_first_not_of(' '), line.size());
        const std::string indent(std::min(first + 2, width / 2), ' ');
        while (line.size() > width) {
            std::size_t cut = line.rfind(' ', width);
            if (cut == std::string::npos || line.find_first_not_of(' ') >= cut) cut = within_word(line, width);
            result += line.substr(0, cut) + "\n";
            const std::size_t rest = line.find_first_not_of(' ', cut);
            line = rest == std::string::npos ? "" : indent + line.substr(rest);
        }
        result += line + "\n";
    }
    return result;
}

std::string coloured(const std::string& text, Colour colour) {
    if (colour == Colour::none || text.empty()) return text;
    const char* const codes[] = {"0", "1", "31", "32", "33"};
    return fmt::format("\x1b[{}m{}\x1b[0m", codes[static_cast<std::size_t>(colour)], text);
}

std::string number_text(double value) {
    std::string text = fmt::format("{:g}", value);
    return std::strtod(text.c_str(), nullptr) == value ? text : fmt::format("{}", value);
}

std::string error_text(double value) {
    return std::isfinite(value) ? fmt::format("{:.2g}", value) : "-";
}

std::string bytes_text(std::size_t bytes) {
    const char* const units[] = {"B", "KiB", "MiB", "GiB", "TiB"};
    double value = static_cast<double>(bytes);
    std::size_t unit = 0;
    for (; value >= 1024.0 && unit + 1 < std::size(units); ++unit) value /= 1024.0;
    if (unit == 0) return fmt::format("{} B", bytes);
    return value < 999.5 ? fmt::format("{:.3g} {}", value, units[unit]) : fmt::format("{:.0f} {}", value, units[unit]);
}

}  // namespace shadowbench::base
