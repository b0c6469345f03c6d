#include "results/fields.h"

#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/json_pointer.h"

namespace shadowbench::results {

void refuse(const std::string& where, const std::string& message) {
    throw base::Error(base::ErrorCode::bad_input, where, message);
}

Field top(const nlohmann::json& document, const std::string& origin) {
    return {document, origin.empty() ? "" : origin + ": "};
}

Field Field::at(const char* key) const {
    const auto found = object().find(key);
    if (found == value.end()) refuse(where, fmt::format("the key \"{}\" is missing", key));
    return {*found, base::append_token(where, key)};
}

bool Field::has(const char* key) const {
    return value.is_object() && value.contains(key);
}

const nlohmann::json& Field::array() const {
    if (!value.is_array()) refuse(where, fmt::format("must be an array, not {}", value.type_name()));
    return value;
}

const nlohmann::json& Field::object() const {
    if (!value.is_object()) refuse(where, fmt::format("must be an object, not {}", value.type_name()));
    return value;
}

Field Field::item(std::size_t index) const {
    return {array()[index], fmt::format("{}/{}", where, index)};
}

const std::string& Field::text() const {
    if (!value.is_string()) refuse(where, fmt::format("must be a text, not {}", value.type_name()));
    return value.get_ref<const std::string&>();
}

double Field::number() const {
    if (!value.is_number()) refuse(where, fmt::format("must be a number, not {}", value.type_name()));
    const double number = value.get<double>();
    if (!std::isfinite(number)) refuse(where, "must be a finite number");
    return number;
}

double Field::at_least_zero() const {
    const double number = this->number();
    if (number < 0.0) refuse(where, "must not be negative");
    return number;
}

double Field::number_or_infinity() const {
    return is_null() ? std::numeric_limits<double>::infinity() : number();
}

std::uint64_t Field::count() const {
    if (value.is_number_unsigned()) return value.get<std::uint64_t>();
    const double number = at_least_zero();
    if (number != std::floor(number) || number >= 0x1p64) refuse(where, "must be a whole number below 2^64");
    return static_cast<std::uint64_t>(number);
}

bool Field::truth() const {
    if (!value.is_boolean()) refuse(where, fmt::format("must be true or false, not {}", value.type_name()));
    return value.get<bool>();
}

bool Field::is_null() const {
    return value.is_null();
}

}  // namespace shadowbench::results
