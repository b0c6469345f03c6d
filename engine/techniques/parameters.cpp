#include "techniques/parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/json_pointer.h"
#include "base/nearest.h"
#include "base/table.h"

namespace shadowbench::techniques {
namespace {

using nlohmann::json;

bool takes_numbers(const Parameter& p) {
    return p.kind != ParameterKind::choice;
}
bool takes_words(const Parameter& p) {
    return p.kind == ParameterKind::choice || p.kind == ParameterKind::number_or_word;
}
bool standard_is_word(const Parameter& p) {
    return p.standard_word[0] != '\0';
}

// Says what a parameter accepts: "a number from 0 to 1 or one of "noise"".
std::string expectation(const Parameter& p) {
    std::string text;
    if (takes_numbers(p))
        text = fmt::format("{} from {:g} to {:g}", p.kind == ParameterKind::integer ? "a whole number" : "a number",
                           p.min, p.max);
    if (takes_words(p)) {
        if (!text.empty()) text += " or ";
        for (std::size_t i = 0; i < p.words.size(); ++i) text += fmt::format("{}\"{}\"", i ? ", " : "", p.words[i]);
    }
    return text;
}

ParameterValues::Value read(const Parameter& p, const json& value, const std::string& where) {
    if (takes_numbers(p) && value.is_number()) {
        const double number = value.get<double>();
        const bool whole = p.kind != ParameterKind::integer || number == std::floor(number);
        if (whole && number >= p.min && number <= p.max) return number;
    }
    if (takes_words(p) && value.is_string()) {
        const auto& word = value.get_ref<const std::string&>();
        if (std::any_of(p.words.begin(), p.words.end(), [&](const char* w) { return word == w; })) return word;
    }
    throw base::Error(base::ErrorCode::bad_input, where,
                      fmt::format("must be {}, not {}", expectation(p), value.dump()));
}

ParameterValues::Value standard(const Parameter& p) {
    if (standard_is_word(p)) return std::string(p.standard_word);
    return p.standard;
}

}  // namespace

const ParameterValues::Value& ParameterValues::at(std::string_view name) const {
    const auto found = values.find(name);
    if (found != values.end()) return found->second;
    std::string names;
    for (const auto& [there, value] : values) names += (names.empty() ? "" : ", ") + there;
    throw base::Error(base::ErrorCode::internal, name,
                      names.empty() ? "no such parameter: there are none" : "no such parameter; there are: " + names);
}

double ParameterValues::number(std::string_view name) const {
    const Value& value = at(name);
    if (const auto* number = std::get_if<double>(&value)) return *number;
    throw base::Error(base::ErrorCode::internal, name,
                      fmt::format("not a number but the word \"{}\"", std::get<std::string>(value)));
}
int ParameterValues::integer(std::string_view name) const {
    return static_cast<int>(number(name));
}
const std::string& ParameterValues::word(std::string_view name) const {
    const Value& value = at(name);
    if (const auto* word = std::get_if<std::string>(&value)) return *word;
    throw base::Error(base::ErrorCode::internal, name, fmt::format("not a word but {:g}", std::get<double>(value)));
}
bool ParameterValues::is_word(std::string_view name) const {
    return std::holds_alternative<std::string>(at(name));
}

ParameterValues read_parameters(std::span<const Parameter> declared, const json& object, const std::string& where) {
    ParameterValues result;
    for (const Parameter& p : declared) result.values.emplace(p.name, standard(p));
    for (const auto& [key, value] : object.items()) {
        if (key == "type") continue;
        const auto p = std::find_if(declared.begin(), declared.end(),
                                    [&name = key](const Parameter& d) { return name == d.name; });
        if (p == declared.end()) {
            std::vector<std::string> names;
            for (const Parameter& d : declared) names.push_back(d.name);
            throw base::Error(base::ErrorCode::bad_input, base::append_token(where, key),
                              names.empty() ? "unknown parameter: this technique takes none"
                                            : fmt::format("unknown parameter{}; there are: {}", base::perhaps(key, names),
                                                          fmt::join(names, ", ")));
        }
        result.values[key] = read(*p, value, base::append_token(where, key));
    }
    return result;
}

json to_json(const ParameterValues& values) {
    json object = json::object();
    for (const auto& [name, value] : values.values)
        std::visit(
            [&object, &name = name](const auto& v) {
                if constexpr (std::is_same_v<std::decay_t<decltype(v)>, double>) {
                    if (v == std::floor(v) && std::abs(v) < 1e15)
                        object[name] = static_cast<long long>(v);
                    else
                        object[name] = v;
                } else {
                    object[name] = v;
                }
            },
            value);
    return object;
}

json parameter_schema(const char* id, std::span<const Parameter> declared) {
    json properties = {{"type", {{"const", id}}}};
    for (const Parameter& p : declared) {
        json number = {
            {"type", p.kind == ParameterKind::integer ? "integer" : "number"}, {"minimum", p.min}, {"maximum", p.max}};
        json entry;
        if (!takes_words(p)) {
            entry = number;
        } else if (!takes_numbers(p)) {
            entry = {{"enum", p.words}};
        } else {
            entry = {{"anyOf", json::array({number, {{"enum", p.words}}})}};
        }
        entry["description"] = p.doc;
        std::visit([&](const auto& v) { entry["default"] = v; }, standard(p));
        properties[p.name] = entry;
    }
    return {{"type", "object"}, {"additionalProperties", false}, {"required", {"type"}}, {"properties", properties}};
}

namespace {

void append(std::string& text, std::string_view name, const ParameterValues::Value& value) {
    text += text.empty() ? "" : " ";
    if (const auto* number = std::get_if<double>(&value))
        text += fmt::format("{}={}", name, base::number_text(*number));
    else
        text += fmt::format("{}={}", name, std::get<std::string>(value));
}

}  // namespace

std::string to_string(const ParameterValues& values, std::span<const Parameter> declared, bool all) {
    std::string text;
    for (const Parameter& p : declared)
        if (const auto& value = values.at(p.name); all || value != standard(p)) append(text, p.name, value);
    return text;
}

std::string to_string(const ParameterValues& values, std::span<const Parameter> declared, const Named& named) {
    const auto among = [](const std::vector<std::string>& names, const Parameter& p) {
        return std::find(names.begin(), names.end(), p.name) != names.end();
    };
    std::string text;
    for (const std::string& name : named.first) append(text, name, values.at(name));
    for (const Parameter& p : declared) {
        if (among(named.first, p)) continue;
        if (const auto& value = values.at(p.name); value != standard(p) || among(named.in_place, p))
            append(text, p.name, value);
    }
    return text;
}

}  // namespace shadowbench::techniques
