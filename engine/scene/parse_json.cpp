// JSON text -> document. RFC 8259 leaves duplicate keys to the reader. Here they are an error, since one of the two
// values would be lost silently.
#include <algorithm>
#include <cstddef>
#include <iterator>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/utf8.h"
#include "scene/parse_json.h"

namespace shadowbench::scene {
namespace {

using base::Error;
using base::ErrorCode;

// Deeper documents would overflow the stack of recursive readers.
constexpr std::size_t max_depth = 64;
constexpr std::size_t excerpt_side = 30;

// Walks over the text and counts how much of it the parser has read.
struct CountingIterator {
    using difference_type = std::ptrdiff_t;
    using value_type = char;
    using pointer = const char*;
    using reference = const char&;
    using iterator_category = std::input_iterator_tag;

    const char* at;
    const char** furthest;

    reference operator*() const { return *at; }
    CountingIterator& operator++() {
        ++at;
        *furthest = std::max(*furthest, at);
        return *this;
    }
    bool operator==(const CountingIterator& other) const { return at == other.at; }
    bool operator!=(const CountingIterator& other) const { return at != other.at; }
};

[[noreturn]] void fail_at(const std::string& text, std::size_t offset, const std::string& origin,
                          const std::string& message) {
    offset = std::min(offset, text.size());
    const std::size_t line = 1 + static_cast<std::size_t>(std::count(text.begin(), text.begin() + offset, '\n'));
    const std::size_t break_before = offset == 0 ? std::string::npos : text.rfind('\n', offset - 1);
    const std::size_t line_begin = break_before == std::string::npos ? 0 : break_before + 1;
    const std::size_t line_end = std::min(text.find('\n', offset), text.size());
    const std::size_t from = std::max(line_begin, offset - std::min(offset, excerpt_side));
    const std::size_t to = std::min(line_end, offset + excerpt_side);
    std::string excerpt = text.substr(from, to - from);
    for (char& c : excerpt)
        if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) > 0x7e) c = ' ';
    throw Error(
        ErrorCode::bad_input, fmt::format("{}:{}:{}", origin, line, offset - line_begin + 1),
        fmt::format("{}; near `{}{}{}`", message, from > line_begin ? "..." : "", excerpt, to < line_end ? "..." : ""));
}

// A first pass over the text: builds nothing and throws Error at the first fault.
class Check : public nlohmann::json_sax<nlohmann::json> {
public:
    Check(const std::string& text, const std::string& origin, const char* const* position)
        : text_(text), origin_(origin), position_(position) {}

    bool null() override { return true; }
    bool boolean(bool) override { return true; }
    bool number_integer(number_integer_t) override { return true; }
    bool number_unsigned(number_unsigned_t) override { return true; }
    bool number_float(number_float_t, const string_t&) override { return true; }
    bool string(string_t&) override { return true; }
    bool binary(binary_t&) override { return true; }
    bool start_object(std::size_t) override { return open(); }
    bool end_object() override { return close(); }
    bool start_array(std::size_t) override { return open(); }
    bool end_array() override { return close(); }

    bool key(string_t& name) override {
        if (!names_.back().insert(name).second) {
            // The parser stands just after the closing quote of the key, and a key holds no unescaped quote.
            std::size_t quote = offset() - 1;
            do quote = text_.rfind('"', quote - 1);
            while (escaped(quote));
            fail_at(text_, quote, origin_, fmt::format("the key \"{}\" occurs twice in this object", name));
        }
        return true;
    }

    bool parse_error(std::size_t position, const std::string&, const nlohmann::json::exception& fault) override {
        // "[json.exception.parse_error.101] parse error at line 1, column 5: syntax error while ..."
        std::string message = fault.what();
        for (const char* mark : {"] ", "column "}) {
            const std::size_t at = message.find(mark);
            if (at != std::string::npos) message.erase(0, at + std::char_traits<char>::length(mark));
        }
        if (const std::size_t colon = message.find(": "); colon != std::string::npos && colon < 8)
            message.erase(0, colon + 2);
        // The excerpt, which shows what was read last, is short.
        const std::size_t last = message.find("; last read: "), expected = message.rfind("; expected ");
        if (last < expected) message.erase(last, expected == std::string::npos ? expected : expected - last);
        fail_at(text_, position > 0 ? position - 1 : 0, origin_, message);
    }

private:
    std::size_t offset() const { return static_cast<std::size_t>(*position_ - text_.data()); }

    bool escaped(std::size_t quote) const {
        std::size_t slashes = 0;
        while (slashes < quote && text_[quote - 1 - slashes] == '\\') ++slashes;
        return slashes % 2 == 1;
    }

    bool open() {
        names_.emplace_back();
        if (names_.size() > max_depth)
            fail_at(text_, offset() - 1, origin_, fmt::format("nested deeper than {} levels", max_depth));
        return true;
    }

    bool close() {
        names_.pop_back();
        return true;
    }

    const std::string& text_;
    const std::string& origin_;
    const char* const* position_;
    std::vector<std::set<std::string>> names_;
};

nlohmann::json parse_unmarked(const std::string& text, const std::string& origin) {
    const char* position = text.data();
    Check check(text, origin, &position);
    nlohmann::json::sax_parse(CountingIterator{text.data(), &position},
                              CountingIterator{text.data() + text.size(), &position}, &check);
    return nlohmann::json::parse(text);
}

}  // namespace

nlohmann::json parse_json(const std::string& text, const std::string& origin) {
    const std::string_view unmarked = base::without_mark(text, origin);
    return unmarked.size() == text.size() ? parse_unmarked(text, origin)
                                          : parse_unmarked(std::string(unmarked), origin);
}

}  // namespace shadowbench::scene
