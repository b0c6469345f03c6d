#include "service/http/chunks.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include "service/http/head.h"

namespace shadowbench::service {
namespace {

using Read = std::function<long(char*, std::size_t)>;
using Take = std::function<bool(const char*, std::size_t)>;

constexpr std::size_t longest_size_line = 1024;  // the size of a chunk with its extensions
constexpr std::size_t most_trailers = 8 * 1024;

// Reads a line, without its CR and LF. Nothing for a line that is longer than `most` or has other control characters.
std::optional<std::string> read_line(const Read& read, std::size_t most) {
    std::string line;
    bool returned = false;  // CR was the last character
    for (char c = 0; read(&c, 1) == 1;) {
        if (returned) return c == '\n' ? std::optional(line) : std::nullopt;
        returned = c == '\r';
        if (returned) continue;
        if (is_control(c) || line.size() == most) return std::nullopt;
        line += c;
    }
    return std::nullopt;
}

// "1f" or "1F ; name=value" -> 31.
std::optional<std::uint64_t> read_size(const std::string& line) {
    std::uint64_t size = 0;
    const char* const end = line.data() + line.size();
    const auto [rest, fault] = std::from_chars(line.data(), end, size, 16);
    if (fault != std::errc()) return std::nullopt;
    const std::string_view extensions(rest, static_cast<std::size_t>(end - rest));
    const std::size_t first = extensions.find_first_not_of(" \t");
    if (!extensions.empty() && (first == std::string_view::npos || extensions[first] != ';')) return std::nullopt;
    return size;
}

bool read_data(const Read& read, const Take& take, std::uint64_t size) {
    char piece[16384];
    while (size > 0) {
        const long n = read(piece, static_cast<std::size_t>(std::min<std::uint64_t>(size, sizeof piece)));
        if (n <= 0 || !take(piece, static_cast<std::size_t>(n))) return false;
        size -= static_cast<std::uint64_t>(n);
    }
    const std::optional<std::string> end = read_line(read, 0);
    return end.has_value();
}

bool skip_trailers(const Read& read) {
    for (std::size_t left = most_trailers;;) {
        const std::optional<std::string> line = read_line(read, left);
        if (!line) return false;
        if (line->empty()) return true;
        left -= line->size();
    }
}

}  // namespace

bool read_chunks(const Read& read, const Take& take) {
    for (;;) {
        const std::optional<std::string> line = read_line(read, longest_size_line);
        const std::optional<std::uint64_t> size = line ? read_size(*line) : std::nullopt;
        if (!size) return false;
        if (*size == 0) return skip_trailers(read);
        if (!read_data(read, take, *size)) return false;
    }
}

}  // namespace shadowbench::service
