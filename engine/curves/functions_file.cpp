#include "curves/functions_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <random>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "base/error.h"
#include "base/limits.h"
#include "base/read_text.h"

namespace shadowbench::curves {

namespace {

using base::Error;
using base::ErrorCode;

std::string_view trimmed(std::string_view text) {
    const std::size_t begin = text.find_first_not_of(" \t\r");
    if (begin == std::string_view::npos) return {};
    return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

// The lines of a file that are neither empty nor comments, and their numbers.
class Lines {
public:
    Lines(std::string name, std::string_view text) : name_(std::move(name)), rest_(text) {}

    // Reads the next such line; returns false at the end.
    bool next(std::string_view& line) {
        while (!rest_.empty()) {
            const std::size_t end = rest_.find('\n');
            line = trimmed(rest_.substr(0, end));
            rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
            ++number_;
            if (!line.empty() && line.front() != '#') return true;
        }
        return false;
    }
    std::size_t characters_left() const { return rest_.size(); }
    [[noreturn]] void fail(std::string message) const {
        throw Error(ErrorCode::bad_input, fmt::format("{}:{}", name_, number_), std::move(message));
    }

private:
    std::string name_;
    std::string_view rest_;
    std::size_t number_ = 0;
};

// A line as shown in a message: the file may be binary, with bytes that a terminal would obey.
std::string shown(std::string_view line) {
    constexpr std::size_t most = 60;
    std::string text(line.substr(0, most));
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c < 0x20 || c > 0x7e; }, '?');
    return line.size() > most ? text + "..." : text;
}

std::from_chars_result parse(const char* begin, const char* end, std::size_t& number) {
    return std::from_chars(begin, end, number);
}

// std::from_chars refuses numbers too small for a float as well as numbers too large; only the latter is a fault.
std::from_chars_result parse(const char* begin, const char* end, float& number) {
    std::from_chars_result result = std::from_chars(begin, end, number);
    if (result.ec != std::errc::result_out_of_range) return result;
    const double value = std::strtod(std::string(begin, result.ptr).c_str(), nullptr);
    if (std::abs(value) > 1.0) return result;
    number = static_cast<float>(value);
    result.ec = {};
    return result;
}

// Reads a number at the front of `text` and removes it, with the white space behind it.
template <class Number>
bool take(std::string_view& text, Number& number) {
    const auto [end, error] = parse(text.data(), text.data() + text.size(), number);
    if (error != std::errc{}) return false;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    if (!text.empty() && text.front() != ' ' && text.front() != '\t') return false;
    text = trimmed(text);
    return true;
}

Vertex parse_vertex(std::string_view line, const Lines& lines) {
    Vertex vertex;
    std::string_view text = line;
    if (!take(text, vertex.z) || !take(text, vertex.value) || !text.empty())
        lines.fail(fmt::format("expected two numbers `z T`, found `{}`", shown(line)));
    if (!std::isfinite(vertex.z)) lines.fail(fmt::format("depth {} is not finite", vertex.z));
    if (std::abs(vertex.z) > static_cast<float>(base::max_coordinate))
        lines.fail(fmt::format("depth {} is beyond {}: scale the depths down", vertex.z, base::max_coordinate));
    if (!(vertex.value >= 0.0f && vertex.value <= 1.0f))
        lines.fail(fmt::format("transmittance {} is outside [0, 1]", vertex.value));
    return vertex;
}

Curve parse_record(std::string_view header, Lines& lines) {
    std::size_t count = 0;
    std::string_view text = header;
    if (!take(text, count) || !text.empty())
        lines.fail(fmt::format("expected the number of vertices of a function, found `{}`", shown(header)));
    // Checked before memory is reserved for it. A vertex takes several characters.
    if (count > lines.characters_left())
        lines.fail(fmt::format("the header states {} vertices, but only {} characters follow", count,
                               lines.characters_left()));
    Curve curve;
    curve.reserve(count);
    for (std::string_view line; curve.size() < count;) {
        if (!lines.next(line))
            lines.fail(fmt::format("the header states {} vertices, but only {} follow", count, curve.size()));
        const Vertex vertex = parse_vertex(line, lines);
        if (!curve.empty() && vertex.z < curve.back().z)
            lines.fail(fmt::format("depth decreases from {} to {}", curve.back().z, vertex.z));
        if (!curve.empty() && vertex.value > curve.back().value)
            lines.fail(fmt::format("transmittance rises from {} to {}", curve.back().value, vertex.value));
        curve.push_back(vertex);
    }
    return curve;
}

void append(std::string& text, float number, char end) {
    char digits[32];
    text.append(digits, std::to_chars(digits, digits + sizeof digits, number).ptr);
    text += end;
}

}  // namespace

std::vector<Curve> read_functions(const std::filesystem::path& file) {
    const std::string text = base::read_text(file);
    std::vector<Curve> functions;
    Lines lines(file.string(), text);
    for (std::string_view line; lines.next(line);) functions.push_back(parse_record(line, lines));
    return functions;
}

void write_functions(const std::filesystem::path& file, const std::vector<Curve>& functions) {
    std::string text;
    for (const Curve& function : functions) {
        text += fmt::format("{}\n", function.size());
        for (const Vertex& vertex : function) {
            append(text, vertex.z, ' ');
            append(text, vertex.value, '\n');
        }
    }
    std::filesystem::path temporary = file;
    temporary += fmt::format(".{:08x}.tmp", std::random_device{}());
    std::ofstream stream(temporary, std::ios::binary);
    stream.write(text.data(), static_cast<std::streamsize>(text.size()));
    stream.close();
    std::error_code error;
    if (stream) std::filesystem::rename(temporary, file, error);
    if (stream && !error) return;
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw Error(ErrorCode::io, file.string(), error ? "cannot be replaced: " + error.message() : "cannot be written");
}

}  // namespace shadowbench::curves
