// GCC 12 reports uninitialised members in std::regex if a sanitizer is on (GCC bug 105562).
#ifndef __clang__
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

#include <regex>

#include <nlohmann/json.hpp>

#include "scene/schema_words.h"

namespace shadowbench::scene {

bool matches(const std::string& text, const nlohmann::json& pattern) {
    return std::regex_search(text, std::regex(pattern.get<std::string>()));
}

bool matches_any(const std::string& text, const nlohmann::json& pattern_properties) {
    for (const auto& [pattern, unused] : pattern_properties.items())
        if (matches(text, nlohmann::json(pattern))) return true;
    return false;
}

}  // namespace shadowbench::scene
