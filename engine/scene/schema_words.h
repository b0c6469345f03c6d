// Schemas and values in words, for messages.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace shadowbench::scene {

// What a schema asks for: "number in (0, 179)", "one of: regular, jittered".
std::string describe(const nlohmann::json& schema);

// A value, cut where it is long: "string \"abc\"", "number 5".
std::string show(const nlohmann::json& value);
std::string shorten(const std::string& text);

// Whether the value has the type, or one of the types, that a schema names.
bool has_type(const nlohmann::json& value, const nlohmann::json& type);

// Regular expressions as JSON Schema has them: found anywhere unless anchored.
bool matches(const std::string& text, const nlohmann::json& pattern);
bool matches_any(const std::string& text, const nlohmann::json& pattern_properties);

// The name that was probably meant; empty when none is near (edit distance; Levenshtein 1966).
std::string closest(const std::string& word, const std::vector<std::string>& names);

}  // namespace shadowbench::scene
