#include "scene/readers/ply_source.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>
#include <sstream>
#include <string_view>

#include <fmt/format.h>

#include "base/error.h"
#include "base/utf8.h"
#include "scene/limits.h"
#include "scene/readers/extension.h"

namespace shadowbench::scene {
namespace {

struct TypeName {
    std::string_view name;
    PlyType type;
};
// Both spellings that are in use.
constexpr std::array type_names{
    TypeName{"char", PlyType::int8},      TypeName{"int8", PlyType::int8},       TypeName{"uchar", PlyType::uint8},
    TypeName{"uint8", PlyType::uint8},    TypeName{"short", PlyType::int16},     TypeName{"int16", PlyType::int16},
    TypeName{"ushort", PlyType::uint16},  TypeName{"uint16", PlyType::uint16},   TypeName{"int", PlyType::int32},
    TypeName{"int32", PlyType::int32},    TypeName{"uint", PlyType::uint32},     TypeName{"uint32", PlyType::uint32},
    TypeName{"float", PlyType::float32},  TypeName{"float32", PlyType::float32}, TypeName{"double", PlyType::float64},
    TypeName{"float64", PlyType::float64}};

std::optional<PlyType> type_of(std::string_view name) {
    for (const TypeName& row : type_names)
        if (row.name == name) return row.type;
    return std::nullopt;
}

std::uint64_t size_of(PlyType type) {
    switch (type) {
        case PlyType::int8:
        case PlyType::uint8:
            return 1;
        case PlyType::int16:
        case PlyType::uint16:
            return 2;
        case PlyType::float64:
            return 8;
        default:
            return 4;
    }
}

template <typename T>
double as(const char* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    return static_cast<double>(value);
}

double decode(PlyType type, const char* bytes) {
    switch (type) {
        case PlyType::int8:
            return as<std::int8_t>(bytes);
        case PlyType::uint8:
            return as<std::uint8_t>(bytes);
        case PlyType::int16:
            return as<std::int16_t>(bytes);
        case PlyType::uint16:
            return as<std::uint16_t>(bytes);
        case PlyType::int32:
            return as<std::int32_t>(bytes);
        case PlyType::uint32:
            return as<std::uint32_t>(bytes);
        case PlyType::float32:
            return static_cast<double>(as<float>(bytes));
        case PlyType::float64:
            return as<double>(bytes);
    }
    return 0.0;
}

bool is_space(char c) {
    return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

}  // namespace

PlySource::PlySource(const std::filesystem::path& file)
    : file_(file.string()),
      reader_(file),
      packed_(extension_of(file) == ".gz"),
      size_(packed_ ? gzip_bytes(file) : reader_.size()),
      bytes_(reader_, 0, packed_ ? Packing::deflate : Packing::none) {
    bytes_.need(size_, "content");
    read_header();
}

void PlySource::fail(const std::string& message) const {
    const auto before = window_.begin() + static_cast<std::ptrdiff_t>(last_);
    throw base::Error(
        base::ErrorCode::bad_input,
        is_text() ? fmt::format("{}:{}", file_,
                                1 + lines_ + static_cast<std::uint64_t>(std::count(window_.begin(), before, line_end_)))
                  : fmt::format("{}: byte {}", file_, begin_ + position_),
        message);
}

bool PlySource::fill() {
    constexpr std::uint64_t most_at_once = 1 << 18;
    const std::uint64_t end = begin_ + window_.size();
    if (end == size_) return false;
    const std::size_t passed = is_text() ? last_ : position_;
    if (is_text())
        lines_ += static_cast<std::uint64_t>(
            std::count(window_.begin(), window_.begin() + static_cast<std::ptrdiff_t>(passed), line_end_));
    window_.erase(0, passed);
    begin_ += passed;
    position_ -= passed;
    last_ = 0;
    const std::size_t kept = window_.size(), more = static_cast<std::size_t>(std::min(size_ - end, most_at_once));
    window_.resize(kept + more);
    bytes_.read({reinterpret_cast<std::uint8_t*>(window_.data()) + kept, more}, "content");
    return true;
}

template <class Wanted>
std::size_t PlySource::find(const Wanted& wanted) {
    for (std::size_t searched = 0;;) {
        const auto from = window_.begin() + static_cast<std::ptrdiff_t>(position_ + searched);
        const auto found = std::find_if(from, window_.end(), wanted);
        searched = static_cast<std::size_t>(found - window_.begin()) - position_;
        if (found != window_.end() || !fill()) return position_ + searched;
    }
}

// The first line shows how lines end. Numbers in binary may begin with the byte of an LF, so a CR ends a line without
// a look at the byte that follows.
void PlySource::find_line_end() {
    const std::size_t end = find([](char c) { return c == '\r' || c == '\n'; });
    if (end + 1 == window_.size()) fill();  // nothing has been passed, so `end` stays its place
    if (end < window_.size() && window_[end] == '\r' && window_.compare(end, 2, "\r\n") != 0) line_end_ = '\r';
}

std::string PlySource::line() {
    last_ = position_;
    const std::size_t end = find([&](char c) { return c == line_end_; });
    if (end == window_.size()) fail("the file ends inside its header");
    std::string text = window_.substr(position_, end - position_);
    if (!text.empty() && text.back() == '\r') text.pop_back();
    position_ = end + 1;
    return text;
}

void PlySource::read_header() {
    fill();
    position_ = window_.size() - base::without_mark(window_, file_).size();
    if (window_.compare(position_, 3, "ply") != 0) fail("the file does not begin with ply");
    find_line_end();
    line();
    bool has_format = false;
    for (std::string text = line(); text != "end_header"; text = line()) {
        std::istringstream words(text);
        std::string keyword, name;
        words >> keyword >> name;
        if (keyword == "format") {
            has_format = true;
            if (name == "ascii")
                encoding_ = Encoding::ascii;
            else if (name == "binary_little_endian")
                encoding_ = Encoding::little_endian;
            else if (name == "binary_big_endian")
                encoding_ = Encoding::big_endian;
            else
                fail(fmt::format("the format \"{}\" is unknown", name));
        } else if (keyword == "element") {
            PlyElement element;
            element.name = name;
            if (!(words >> element.count)) fail("an element has no count");
            elements_.push_back(element);
        } else if (keyword == "property") {
            read_property(text);
        } else if (!elements_.empty() && !keyword.empty() && keyword != "comment" && keyword != "obj_info") {
            // Before the first element it is a comment without its keyword, as Blender 2.47 wrote.
            fail(fmt::format("the header line \"{}\" is unknown", keyword.substr(0, 40)));
        }
    }
    if (!has_format) fail("the header states no format");
    in_header_ = false;
}

// "property float x" or "property list uchar int vertex_indices".
void PlySource::read_property(const std::string& text) {
    if (elements_.empty()) fail("a property stands before the first element");
    std::istringstream words(text);
    std::string keyword, type, count_type;
    PlyProperty property;
    words >> keyword >> type;
    if (type == "list") {
        property.is_list = true;
        words >> count_type >> type;
        const std::optional<PlyType> known = type_of(count_type);
        if (!known || *known == PlyType::float32 || *known == PlyType::float64)
            fail(fmt::format("a list is counted by \"{}\", which is not an integer type", count_type));
        property.count_type = *known;
    }
    const std::optional<PlyType> known = type_of(type);
    if (!known || !(words >> property.name))
        fail(fmt::format("the property \"{}\" is not understood", text.substr(0, 60)));
    property.type = *known;
    elements_.back().properties.push_back(property);
}

std::uint64_t PlySource::least_bytes(PlyType type) const {
    // A digit and a separator; the last number of the file needs no separator.
    return encoding_ == Encoding::ascii ? 2 : size_of(type);
}

void PlySource::check_length(const PlyElement& element) const {
    std::uint64_t bytes = 0;
    for (const PlyProperty& property : element.properties)
        bytes += least_bytes(property.is_list ? property.count_type : property.type);
    if (element.count > max_mesh_elements)
        fail(fmt::format("{} elements \"{}\"; the limit is {}", element.count, element.name, max_mesh_elements));
    // The product of max_mesh_elements and the number of properties of a header in memory fits 64 bits.
    if (element.count * bytes > left() + 1)
        fail(fmt::format("the file is too short for {} elements \"{}\"", element.count, element.name));
}

std::uint64_t PlySource::most_of(const PlyElement& element, std::uint64_t items) const {
    std::uint64_t bytes = 0;
    for (const PlyProperty& property : element.properties)
        bytes += property.is_list ? least_bytes(property.count_type) + items * least_bytes(property.type)
                                  : least_bytes(property.type);
    return std::min(element.count, (left() + 1) / std::max<std::uint64_t>(bytes, 1));
}

double PlySource::value(PlyType type) {
    if (encoding_ == Encoding::ascii) {
        do {
            while (position_ < window_.size() && is_space(window_[position_])) ++position_;
            last_ = position_;
        } while (position_ == window_.size() && fill());
        const std::size_t after = find(is_space);
        const char* begin = window_.data() + position_;
        const char* end = window_.data() + after;
        if (begin == end) fail("the file ends inside its numbers");
        double result = 0.0;
        const auto [stop, fault] = std::from_chars(*begin == '+' ? begin + 1 : begin, end, result);
        if (fault != std::errc() || stop != end)
            fail(fmt::format("\"{}\" is not a number", std::string(begin, std::min(end, begin + 40))));
        position_ = after;
        return result;
    }
    const std::uint64_t size = size_of(type);
    while (window_.size() - position_ < size)
        if (!fill()) fail("the file ends inside its numbers");
    std::array<char, 8> raw{};
    std::memcpy(raw.data(), window_.data() + position_, size);
    if (encoding_ == Encoding::big_endian) std::reverse(raw.data(), raw.data() + size);
    position_ += size;
    return decode(type, raw.data());
}

std::uint64_t PlySource::list_size(const PlyProperty& property) {
    const double count = value(property.count_type);
    if (!(count >= 0.0) || count != std::floor(count) ||
        count * static_cast<double>(least_bytes(property.type)) > static_cast<double>(left() + 1))
        fail(fmt::format("the file is too short for a list of {} items", count));
    return static_cast<std::uint64_t>(count);
}

void PlySource::skip(const PlyProperty& property) {
    const std::uint64_t count = property.is_list ? list_size(property) : 1;
    for (std::uint64_t i = 0; i < count; ++i) value(property.type);
}

void PlySource::finish() {
    if (!packed_) return;
    do position_ = last_ = window_.size();
    while (fill());
    if (!bytes_.at_end()) bytes_.fail(size_, "more content than the end of the file states");
}

}  // namespace shadowbench::scene
