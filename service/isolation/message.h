// What a program and the process of a technique say to each other. Both are the same program, so values travel as they
// lie in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "base/error.h"

namespace shadowbench::service {

// A request begins with what is asked, its answer with whether it failed.
enum class Request : std::uint32_t {
    describe,
    error_bound,
    least_bytes,
    create,
    destroy,
    add,
    finish,
    lookup,
    bytes,
    nodes,
    stored
};
enum class ReplyKind : std::uint32_t { done, failed };

struct MessageHead {
    std::uint32_t kind = 0;  // a Request or a ReplyKind
    std::uint64_t size = 0;  // of the body, bytes
};

class MessageWriter {
public:
    template <class Value>
    void put(const Value& value) {
        static_assert(std::is_trivially_copyable_v<Value>);
        append(&value, sizeof value);
    }
    template <class Item>
    void put_list(std::span<const Item> items) {
        static_assert(std::is_trivially_copyable_v<Item>);
        put(static_cast<std::uint64_t>(items.size()));
        append(items.data(), items.size_bytes());
    }
    void put_text(const std::string& text) { put_list(std::span(text.data(), text.size())); }
    const std::string& body() const { return body_; }

private:
    void append(const void* from, std::size_t size) { body_.append(static_cast<const char*>(from), size); }

    std::string body_;
};

// Throws Error{internal} if the message is shorter than what is read from it.
class MessageReader {
public:
    explicit MessageReader(std::string body) : body_(std::move(body)) {}

    template <class Value>
    Value get() {
        static_assert(std::is_trivially_copyable_v<Value>);
        Value value;
        take(&value, sizeof value);
        return value;
    }
    template <class Item>
    void get_list(std::vector<Item>& items) {
        items.resize(count(sizeof(Item)));
        take(items.data(), items.size() * sizeof(Item));
    }
    std::string get_text() {
        std::string text(count(1), '\0');
        take(text.data(), text.size());
        return text;
    }
    // The number of items of a list whose items are read one by one, each at least one byte.
    std::size_t get_count() { return count(1); }

private:
    std::size_t count(std::size_t size_of_one) {
        const auto count = get<std::uint64_t>();
        if (count > (body_.size() - at_) / size_of_one) refuse();
        return static_cast<std::size_t>(count);
    }
    void take(void* to, std::size_t size) {
        if (size > body_.size() - at_) refuse();
        if (size > 0) std::memcpy(to, body_.data() + at_, size);
        at_ += size;
    }
    [[noreturn]] static void refuse() {
        throw base::Error(base::ErrorCode::internal, "", "a message of a technique's process is too short");
    }

    std::string body_;
    std::size_t at_ = 0;
};

}  // namespace shadowbench::service
