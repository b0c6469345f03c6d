#include "scene/readers/header_fields.h"

#include <algorithm>
#include <charconv>
#include <system_error>

#include <fmt/format.h>

#include "base/error.h"
#include "scene/beside.h"
#include "scene/limits.h"
#include "scene/readers/text_lines.h"

namespace shadowbench::scene {
namespace {

constexpr std::size_t longest_line = 1 << 16;
constexpr std::uint64_t longest_header = 1 << 20;

// Of a value in messages, which may be as long as a line.
std::string_view shortened(std::string_view text) {
    constexpr std::size_t longest = 100;
    return text.substr(0, longest);
}

}  // namespace

std::optional<std::string> read_line(FileReader& file) {
    if (file.position() == file.size()) return std::nullopt;
    const std::uint64_t begin = file.position();
    if (begin > longest_header)
        file.fail(begin, fmt::format("the header is longer than {} bytes: its end is missing", longest_header));
    std::string line;
    while (file.position() < file.size()) {
        const char c = file.value<char>("header");
        if (c == '\n') break;
        line += c;
        if (line.size() > longest_line)
            file.fail(begin, fmt::format("a line of more than {} bytes, too long for a header", longest_line));
    }
    if (line.ends_with('\r')) line.pop_back();
    return line;
}

std::string_view trimmed(std::string_view text) {
    const std::size_t from = text.find_first_not_of(" \t");
    if (from == std::string_view::npos) return {};
    return text.substr(from, text.find_last_not_of(" \t") - from + 1);
}

void HeaderFields::add(const std::string& name, std::string_view value, std::uint64_t at) {
    if (!fields_.emplace(name, HeaderField{std::string(value), at}).second)
        file_.fail(at, fmt::format("the field \"{}\" is there twice", shortened(name)));
}

const HeaderField* HeaderFields::find(std::string_view name) const {
    const auto field = fields_.find(name);
    return field == fields_.end() ? nullptr : &field->second;
}

const HeaderField& HeaderFields::need(std::string_view name) const {
    const HeaderField* field = find(name);
    if (!field) file_.fail(file_.position(), fmt::format("the header ends here, without the field \"{}\"", name));
    return *field;
}

void HeaderFields::fail(const HeaderField& field, const std::string& message) const {
    file_.fail(field.at, message);
}

std::vector<std::int64_t> HeaderFields::integers(const HeaderField& field, std::size_t count) const {
    std::vector<std::int64_t> result;
    std::string_view rest = field.value;
    for (std::string_view word = next_word(rest); !word.empty() && result.size() <= count; word = next_word(rest)) {
        std::int64_t value = 0;
        const auto [end, fault] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (fault != std::errc() || end != word.data() + word.size())
            fail(field, fmt::format("\"{}\" is not a whole number", shortened(word)));
        result.push_back(value);
    }
    if (result.size() != count)
        fail(field, fmt::format("{} whole numbers are needed, not \"{}\"", count, shortened(field.value)));
    return result;
}

std::int64_t HeaderFields::integer(std::string_view name, std::int64_t least, std::int64_t absent) const {
    const HeaderField* field = find(name);
    if (!field) return absent;
    const std::int64_t value = integers(*field, 1)[0];
    constexpr std::int64_t most = std::int64_t{1} << 60;
    if (value < least || value > most) fail(*field, fmt::format("{} is not from {} to {}", value, least, most));
    return value;
}

std::vector<double> HeaderFields::numbers(const HeaderField& field, std::size_t count) const {
    std::vector<double> result;
    std::string_view rest = field.value;
    for (std::string_view word = next_word(rest); !word.empty() && result.size() <= count; word = next_word(rest)) {
        const std::optional<double> value = coordinate(word);
        if (!value)
            fail(field,
                 fmt::format("\"{}\" is not a number from -{} to {}", shortened(word), max_coordinate, max_coordinate));
        result.push_back(*value);
    }
    if (result.size() != count)
        fail(field, fmt::format("{} numbers are needed, not \"{}\"", count, shortened(field.value)));
    return result;
}

Vec3i size_of(const HeaderFields& header, const HeaderField& field, const std::vector<std::int64_t>& sides) {
    Vec3i size(0, 0, 0);
    for (int axis = 0; axis < 3; ++axis) {
        const std::int64_t side = sides[static_cast<std::size_t>(axis)];
        if (side < 1 || side > static_cast<std::int64_t>(max_voxels))
            header.fail(field, fmt::format("{} voxels along an axis; 1 to {} are read", side, max_voxels));
        size[axis] = static_cast<int>(side);
    }
    return size;
}

std::filesystem::path file_beside(const std::filesystem::path& header_file, const HeaderFields& header,
                                  const HeaderField& field) {
    const std::string shown(shortened(field.value));
    const Beside beside = find_beside(header_file, field.value);
    switch (beside.state) {
        case Beside::State::found: break;
        case Beside::State::not_a_name:
            header.fail(field,
                        fmt::format("the file of the values, \"{}\", must be a name in the folder of the header: not "
                                    "absolute, and without ..",
                                    shown));
        case Beside::State::missing:
            throw base::Error(base::ErrorCode::no_such_file, fmt::format("{}: byte {}", header_file.string(), field.at),
                              fmt::format("there is no file \"{}\" with the values beside the header", shown));
        case Beside::State::outside:
            header.fail(
                field, fmt::format("the file of the values, \"{}\", leads out of the folder of the header: copy it there",
                                   shown));
    }
    return beside.file;
}

}  // namespace shadowbench::scene
