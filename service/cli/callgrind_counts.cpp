#include "service/cli/callgrind_counts.h"

#include <charconv>
#include <fstream>
#include <optional>
#include <string_view>

#include "base/error.h"

namespace shadowbench::service {
namespace {

// The name and the count of a dump. They stand in its head, before the lines of functions.
struct Dump {
    std::string name;
    std::optional<std::uint64_t> instructions;
};

bool take(std::string_view line, std::string_view start, std::string_view& rest) {
    if (!line.starts_with(start)) return false;
    rest = line.substr(start.size());
    return true;
}

Dump read_dump(const std::filesystem::path& file) {
    Dump dump;
    std::ifstream stream(file);
    std::string_view rest;
    for (std::string line; !dump.instructions && std::getline(stream, line);) {
        if (take(line, "desc: Trigger: Client Request: ", rest)) dump.name = rest;
        if (!take(line, "summary: ", rest) && !take(line, "totals: ", rest)) continue;
        std::uint64_t count = 0;
        if (std::from_chars(rest.data(), rest.data() + rest.size(), count).ec == std::errc()) dump.instructions = count;
    }
    return dump;
}

}  // namespace

std::map<std::string, std::uint64_t> callgrind_counts(const std::filesystem::path& prefix) {
    std::map<std::string, std::uint64_t> counts;
    for (int part = 1;; ++part) {
        const std::filesystem::path file = prefix.string() + "." + std::to_string(part);
        if (!std::filesystem::exists(file)) return counts;
        const Dump dump = read_dump(file);
        if (!dump.instructions)
            throw base::Error(base::ErrorCode::bad_input, file.string(),
                              "not a dump of callgrind: it has no number of instructions");
        if (!dump.name.empty()) counts[dump.name] = *dump.instructions;
    }
}

}  // namespace shadowbench::service
