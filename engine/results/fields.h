// Reads fields of JSON that nothing has checked. Every fault names its place.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include <nlohmann/json_fwd.hpp>

namespace shadowbench::results {

// A value and where it stands.
struct Field {
    const nlohmann::json& value;
    std::string where;  // "file: /variants/0"

    Field at(const char* key) const;  // of an object, which has it
    bool has(const char* key) const;  // false where this is no object
    const nlohmann::json& array() const;
    const nlohmann::json& object() const;
    Field item(std::size_t index) const;  // of array()
    const std::string& text() const;
    double number() const;              // finite
    double at_least_zero() const;       // finite
    double number_or_infinity() const;  // null: +infinity
    std::uint64_t count() const;        // a whole number from 0 on
    bool truth() const;
    bool is_null() const;
};

// Throws Error{bad_input}.
[[noreturn]] void refuse(const std::string& where, const std::string& message);

// The document's top. `origin` may be empty.
Field top(const nlohmann::json& document, const std::string& origin);

}  // namespace shadowbench::results
