#include "scene/schema_words.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace shadowbench::scene {
namespace {

using nlohmann::json;

constexpr std::size_t longest_shown = 40;

std::string number(const json& value) {
    return value.is_null() ? "" : value.dump();
}

// "[0, 1]", "at least 0", or nothing.
std::string range(const json& schema) {
    const bool above = schema.contains("exclusiveMinimum");
    const bool below = schema.contains("exclusiveMaximum");
    const std::string low = number(schema.value(above ? "exclusiveMinimum" : "minimum", json()));
    const std::string high = number(schema.value(below ? "exclusiveMaximum" : "maximum", json()));
    if (!low.empty() && !high.empty())
        return fmt::format(" in {}{}, {}{}", above ? '(' : '[', low, high, below ? ')' : ']');
    if (!low.empty()) return (above ? " above " : " of at least ") + low;
    if (!high.empty()) return (below ? " below " : " of at most ") + high;
    return "";
}

std::string count(const json& schema, const char* minimum, const char* maximum, const char* unit) {
    const std::string low = number(schema.value(minimum, json()));
    const std::string high = number(schema.value(maximum, json()));
    if (low.empty() && high.empty()) return "";
    if (low == high) return fmt::format(" of {} {}", low, unit);
    if (high.empty()) return fmt::format(" of at least {} {}", low, unit);
    if (low.empty()) return fmt::format(" of at most {} {}", high, unit);
    return fmt::format(" of {} to {} {}", low, high, unit);
}

std::string describe_type(const std::string& type, const json& schema) {
    if (type == "number" || type == "integer") return type + range(schema);
    if (type == "array") {
        const json items = schema.value("items", json::object());
        return "array" + count(schema, "minItems", "maxItems", "items") +
               (items.contains("type") ? ", each " + describe(items) : "");
    }
    if (type == "string")
        return "string" + count(schema, "minLength", "maxLength", "characters") +
               (schema.contains("pattern") ? " that matches " + schema["pattern"].get<std::string>() : "");
    return type;
}

}  // namespace

std::string describe(const json& schema) {
    if (schema.contains("const")) return schema["const"].dump();
    std::string words;
    const auto join = [&](const std::string& part, const char* between) {
        words += (words.empty() ? "" : between) + part;
    };
    if (schema.contains("enum")) {
        for (const json& word : schema["enum"]) join(word.is_string() ? word.get<std::string>() : word.dump(), ", ");
        return schema["enum"].size() == 1 ? words : "one of: " + words;
    }
    if (schema.contains("type")) {
        const json& type = schema["type"];
        for (const json& name : type.is_array() ? type : json::array({type}))
            join(describe_type(name.get<std::string>(), schema), " or ");
        return words;
    }
    for (const char* alternatives : {"anyOf", "oneOf"})
        if (schema.contains(alternatives))
            for (const json& part : schema[alternatives]) join(describe(part), " or ");
    return words.empty() ? "another value" : words;
}

std::string shorten(const std::string& text) {
    return text.size() <= longest_shown ? text : text.substr(0, longest_shown) + "...";
}

std::string show(const json& value) {
    // Arrays and objects may be long, and their contents do not help.
    if (value.is_structured()) return fmt::format("{} of {} items", value.type_name(), value.size());
    const std::string text = value.dump(-1, ' ', true, json::error_handler_t::replace);
    return value.is_null() ? text : fmt::format("{} {}", value.type_name(), shorten(text));
}

bool has_type(const json& value, const json& type) {
    if (type.is_array())
        return std::any_of(type.begin(), type.end(), [&](const json& one) { return has_type(value, one); });
    const std::string name = type.get<std::string>();
    if (name == "integer") return value.is_number_integer();
    return name == value.type_name();
}

}  // namespace shadowbench::scene
