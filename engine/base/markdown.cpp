#include "base/markdown.h"

namespace shadowbench::base {
namespace {

// Escapes bars, which would end the cell.
std::string cell(std::string text) {
    for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.replace(at, 1, "\\|");
    return text;
}

void add_row(std::string& out, const std::vector<std::string>& cells) {
    out += "|";
    for (const std::string& text : cells) out += " " + cell(text) + " |";
    out += "\n";
}

}  // namespace

std::string markdown_table(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows) {
    std::string out;
    add_row(out, header);
    add_row(out, std::vector<std::string>(header.size(), "---"));
    for (const auto& row : rows) add_row(out, row);
    return out + "\n";
}

std::string markdown_escaped(const std::string& text) {
    std::string result;
    for (const char c : text) {
        if (std::string("\\`*_|<>[]").find(c) != std::string::npos) result += '\\';
        result += c == '\n' ? ' ' : c;
    }
    return result;
}

}  // namespace shadowbench::base
