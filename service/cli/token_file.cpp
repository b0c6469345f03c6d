#include "service/cli/token_file.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <set>
#include <sstream>
#include <string_view>

#include <sys/stat.h>

#include <fmt/format.h>

#include "base/error.h"
#include "base/read_text.h"

namespace shadowbench::service {
namespace {

using base::Error;
using base::ErrorCode;

constexpr std::size_t shortest_token = 16;

// "12", and where a unit may follow, "12M".
std::optional<std::uint64_t> read_amount(std::string_view text, bool with_unit) {
    std::uint64_t amount = 0;
    const auto [rest, failed] = std::from_chars(text.data(), text.data() + text.size(), amount);
    if (failed != std::errc()) return std::nullopt;
    const std::string_view unit(rest, static_cast<std::size_t>(text.data() + text.size() - rest));
    if (unit.empty()) return amount;
    const std::size_t power = std::string_view("KMGT").find(unit[0]);
    if (!with_unit || unit.size() > 1 || power == std::string_view::npos || amount >> 23 != 0) return std::nullopt;
    return amount << (10 * (power + 1));
}

bool read_limit(std::string_view word, OwnerLimits& limits) {
    const std::string_view name = word.substr(0, word.find('='));
    if (name.size() == word.size()) return false;
    const auto amount = read_amount(word.substr(name.size() + 1), name == "bytes");
    if (!amount) return false;
    if (name == "queued")
        limits.queued = *amount;
    else if (name == "running")
        limits.running = *amount;
    else if (name == "bytes")
        limits.bytes = *amount;
    else
        return false;
    return true;
}

bool is_name(const std::string& text) {
    return text.size() <= 64 && std::all_of(text.begin(), text.end(), [](char c) {
               return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
                      c == '_' || c == '.';
           });
}

NamedToken read_line_of_tokens(const std::string& line, const std::string& where) {
    std::istringstream stream(line);
    std::vector<std::string> words;
    for (std::string word; stream >> word;) words.push_back(word);
    NamedToken read;
    if (words.size() > 1) read.name = words[0];
    read.token = words.size() > 1 ? words[1] : words[0];
    if (read.token.size() < shortest_token)
        throw Error(ErrorCode::bad_input, where,
                    fmt::format("a token must be one word of at least {} characters", shortest_token));
    if (!is_name(read.name))
        throw Error(ErrorCode::bad_input, where,
                    "a name must be at most 64 letters, digits and any of \"-_.\"; a line is NAME TOKEN");
    for (std::size_t i = 2; i < words.size(); ++i)  // a wrong word may be a secret, so that no message has it
        if (!read_limit(words[i], read.limits))
            throw Error(
                ErrorCode::bad_input, where,
                fmt::format("word {} is no limit; a line is NAME TOKEN, then any of queued=N, running=N and bytes=N, "
                            "as bytes=2G",
                            i + 1));
    return read;
}

// The rights that nobody but the owner may have. A credential of systemd may belong to root, and an ACL lets the
// service read it: the group's rights are then the mask of the ACL.
mode_t rights_of_others(const std::string& file) {
    const char* const credentials = std::getenv("CREDENTIALS_DIRECTORY");
    const bool credential = credentials && std::filesystem::path(file).parent_path() == credentials;
    return credential ? S_IRWXO : S_IRWXG | S_IRWXO;
}

}  // namespace

std::vector<NamedToken> read_tokens(const std::string& file) {
    const std::string text = base::read_text(file);
    struct stat status {};
    if (::stat(file.c_str(), &status) == 0 && (status.st_mode & rights_of_others(file)) != 0)
        throw Error(ErrorCode::bad_input, file, "others can read the token; run chmod 600 on the file");
    std::vector<NamedToken> tokens;
    std::set<std::string> names, secrets;
    std::istringstream stream(text);
    int number = 0;
    for (std::string line; std::getline(stream, line);) {
        ++number;
        const std::size_t first = line.find_first_not_of(" \t\r\v\f");
        if (first == std::string::npos || line[first] == '#') continue;
        const std::string where = fmt::format("{}:{}", file, number);
        tokens.push_back(read_line_of_tokens(line, where));
        if (!names.insert(tokens.back().name).second || !secrets.insert(tokens.back().token).second)
            throw Error(ErrorCode::bad_input, where,
                        "a second line with this name or this token; each line needs a name and a token of its own");
    }
    if (tokens.empty())
        throw Error(ErrorCode::bad_input, file,
                    "there is no token in this file; write lines of TOKEN, or of NAME TOKEN, into it");
    return tokens;
}

std::string read_token(const std::string& file) {
    return read_tokens(file).front().token;
}

}  // namespace shadowbench::service
