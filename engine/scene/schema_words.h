// Schemas and values in words, for messages.
#pragma once

#include <cstddef>
#include <string>

#include <nlohmann/json_fwd.hpp>

namespace shadowbench::scene {

// Describes what a schema asks for: "number in (0, 179)", "one of: regular, jittered".
std::string describe(const nlohmann::json& schema);

// Describes a value, cut if it is long: "string \"abc\"", "number 5".
std::string show(const nlohmann::json& value);
std::string shorten(const std::string& text);

// Whether the value has the type, or one of the types, that a schema names.
bool has_type(const nlohmann::json& value, const nlohmann::json& type);

// Matches a regular expression as JSON Schema does: anywhere in the text unless anchored.
bool matches(const std::string& text, const nlohmann::json& pattern);
bool matches_any(const std::string& text, const nlohmann::json& pattern_properties);

}  // namespace shadowbench::scene
