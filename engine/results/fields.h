// Typed reads of JSON fields that nothing has checked before. Every error names the JSON pointer of its field.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include <nlohmann/json_fwd.hpp>

namespace shadowbench::results {

// A value and its place.
struct Field {
    const nlohmann::json& value;
    std::string where;  // "file: /variants/0"

    Field at(const char* key) const;  // throws if this is not an object or the key is missing
    bool has(const char* key) const;  // false also if this is not an object
    const nlohmann::json& array() const;
    const nlohmann::json& object() const;
    Field item(std::size_t index) const;  // an element of array()
    const std::string& text() const;
    double number() const;              // finite
    double at_least_zero() const;       // finite
    double number_or_infinity() const;  // null: +infinity
    std::uint64_t count() const;        // a whole number, at least 0
    bool truth() const;
    bool is_null() const;
};

// Throws Error{bad_input}.
[[noreturn]] void refuse(const std::string& where, const std::string& message);

// The root of a document. `origin`, the name of its file, begins every place; it may be empty.
Field top(const nlohmann::json& document, const std::string& origin);

}  // namespace shadowbench::results
