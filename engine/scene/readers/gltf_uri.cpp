#include "scene/readers/gltf_uri.h"

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <system_error>

#include <fmt/format.h>

#include "base/error.h"
#include "scene/beside.h"

namespace shadowbench::scene {
namespace {

namespace fs = std::filesystem;
using base::Error;
using base::ErrorCode;

constexpr std::string_view scheme = "data:", encoding = ";base64";

// The six bits of a digit (RFC 4648, sections 4 and 5), or -1.
int bits_of(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    if (c == '+' || c == '-') return 62;
    if (c == '/' || c == '_') return 63;
    return -1;
}

std::optional<std::vector<char>> from_base64(std::string_view text) {
    while (text.ends_with('=')) text.remove_suffix(1);
    if (text.size() % 4 == 1) return std::nullopt;
    std::vector<char> bytes;
    bytes.reserve(text.size() / 4 * 3 + 2);
    std::uint32_t value = 0;
    int bits = 0;
    for (const char c : text) {
        const int digit = bits_of(c);
        if (digit < 0) return std::nullopt;
        value = (value << 6 | static_cast<std::uint32_t>(digit)) & 0xffffu;
        bits += 6;
        if (bits < 8) continue;
        bits -= 8;
        bytes.push_back(static_cast<char>((value >> bits) & 0xffu));
    }
    return bytes;
}

// "%20" -> " ". A percent sign that two hexadecimal digits do not follow stands for itself.
std::string without_percent(std::string_view uri) {
    std::string name;
    for (std::size_t at = 0; at < uri.size(); ++at) {
        unsigned code = 0;
        if (uri[at] == '%' && at + 2 < uri.size()) {
            const char* const end = uri.data() + at + 3;
            const auto [next, fault] = std::from_chars(uri.data() + at + 1, end, code, 16);
            if (fault == std::errc() && next == end) {
                name += static_cast<char>(code);
                at += 2;
                continue;
            }
        }
        name += uri[at];
    }
    return name;
}

}  // namespace

bool is_data_uri(std::string_view uri) {
    return uri.starts_with(scheme);
}

std::optional<std::vector<char>> data_of_uri(std::string_view uri) {
    const std::size_t comma = uri.find(',');
    if (!is_data_uri(uri) || comma == std::string_view::npos || !uri.substr(0, comma).ends_with(encoding))
        return std::nullopt;
    return from_base64(uri.substr(comma + 1));
}

fs::path file_of_uri(const fs::path& gltf, const std::string& uri, const std::string& where) {
    if (uri.find("://") != std::string::npos)
        throw Error(ErrorCode::bad_input, where, "an address in a network is not read: put the file beside this one");
    const std::string name = without_percent(uri);
    const Beside beside = find_beside(gltf, name);
    if (beside.state == Beside::State::found) return beside.file;
    const bool missing = beside.state == Beside::State::missing;
    throw Error(missing ? ErrorCode::no_such_file : ErrorCode::bad_input, where,
                fmt::format("{} \"{}\"; what a glTF file names must lie in its own folder",
                            missing ? "there is no file" : "the name leads out of the folder:", name));
}

}  // namespace shadowbench::scene
