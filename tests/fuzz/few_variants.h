// Excludes inputs that are valid but take too long to fuzz.
#pragma once

#include <algorithm>
#include <cstddef>

#include <nlohmann/json.hpp>

namespace shadowbench::fuzz {

// Whether the sweeps of a document make few scenarios and techniques in all.
inline bool few_variants(const nlohmann::json& document) {
    constexpr std::size_t most = 32;
    if (!document.is_object()) return true;
    std::size_t variants = 1;
    const auto count = [&](const nlohmann::json& list) {
        if (list.is_array()) variants *= std::clamp<std::size_t>(list.size(), 1, most + 1);
        return variants <= most;
    };
    if (const auto sweeps = document.find("sweeps"); sweeps != document.end() && sweeps->is_object())
        for (const nlohmann::json& values : *sweeps)
            if (!count(values)) return false;
    const auto techniques = document.find("techniques");
    if (techniques == document.end()) return true;
    if (techniques->is_array() &&
        std::any_of(techniques->begin(), techniques->end(), [](const nlohmann::json& technique) {
            return technique.is_object() &&
                   technique.value("type", nlohmann::json()) == "*";  // stands for about a dozen
        }))
        variants *= 12;
    return count(*techniques);
}

}  // namespace shadowbench::fuzz
