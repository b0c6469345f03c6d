#include "compare/fields.h"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"

namespace shadowbench::compare {

void refuse(const std::string& where, const std::string& message) {
    throw base::Error(base::ErrorCode::bad_input, where, message);
}

Field top(const nlohmann::json& document, const std::string& origin) {
    return {document, origin.empty() ? "" : origin + ": "};
}

Field Field::at(const char* key) const {
    const auto found = object().find(key);
    if (found == value.end()) refuse(where, fmt::format("the key \"{}\" is missing", key));
    return {*found, fmt::format("{}/{}", where, key)};
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

bool Field::is_null() const {
    return value.is_null();
}

}  // namespace shadowbench::compare
