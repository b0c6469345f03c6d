// Only valijson decides whether a document is valid; this file finds words for its verdict.
#include "scene/schema_fault.h"

#include <cstddef>
#include <optional>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/nearest.h"
#include "scene/schema_words.h"

namespace shadowbench::scene {
namespace {

using nlohmann::json;
using Schemas = std::vector<const json*>;

// The schemas that apply to one value, with references, allOf and conditions resolved.
class Applicable {
public:
    explicit Applicable(const json& root) : root_(root) {}

    void add(const json& schema, const json& value, Schemas& out, int depth = 0) const {
        if (!schema.is_object() || depth > 32) return;
        if (const auto reference = schema.find("$ref"); reference != schema.end()) {
            const std::string target = reference->get<std::string>();
            const json::json_pointer pointer(target.substr(target.find('#') + 1));
            if (root_.contains(pointer)) add(root_.at(pointer), value, out, depth + 1);
            return;
        }
        out.push_back(&schema);
        if (const auto all = schema.find("allOf"); all != schema.end())
            for (const json& part : *all) add(part, value, out, depth + 1);
        if (const auto condition = schema.find("if"); condition != schema.end()) {
            const char* branch = holds(*condition, value) ? "then" : "else";
            if (schema.contains(branch)) add(schema[branch], value, out, depth + 1);
        }
    }

    // One step down the document, to the child of this name or index.
    Schemas below(const Schemas& schemas, const std::string& step, const json& child, bool in_array) const {
        Schemas out;
        for (const json* schema : schemas) {
            if (in_array) {
                if (schema->contains("items")) add((*schema)["items"], child, out);
                continue;
            }
            const auto properties = schema->find("properties");
            if (properties != schema->end() && properties->contains(step))
                add((*properties)[step], child, out);
            else if (const auto patterns = schema->find("patternProperties"); patterns != schema->end())
                for (const json& pattern : *patterns) add(pattern, child, out);
        }
        return out;
    }

private:
    // Decides conditions of the one form used here: a key that is required and has a constant value.
    static bool holds(const json& condition, const json& value) {
        if (!value.is_object() || !condition.contains("properties")) return false;
        for (const auto& [name, wanted] : condition["properties"].items()) {
            if (!value.contains(name)) return false;
            if (wanted.contains("const") && wanted["const"] != value[name]) return false;
        }
        return true;
    }

    const json& root_;
};

std::string names_of(const json& properties) {
    std::string names;
    for (const auto& [name, unused] : properties.items()) names += (names.empty() ? "" : ", ") + name;
    return names;
}

// Keys that the schema does not have; their own pointers name their place.
void unknown_keys(const json& schema, const json& value, const json::json_pointer& at, std::size_t most,
                  std::vector<SchemaFault>& out) {
    if (!value.is_object() || schema.value("additionalProperties", json(true)) != json(false)) return;
    const json properties = schema.value("properties", json::object());
    const json patterns = schema.value("patternProperties", json::object());
    for (const auto& [key, unused] : value.items()) {
        if (properties.contains(key) || matches_any(key, patterns)) continue;
        if (out.size() >= most) return;
        std::vector<std::string> names;
        for (const auto& [name, also_unused] : properties.items()) names.push_back(name);
        std::string message = fmt::format("unknown key \"{}\"{}", shorten(key), base::perhaps(key, names));
        if (!properties.empty()) message += "; the keys here are: " + names_of(properties);
        if (!patterns.empty()) message += "; keys here match: " + names_of(patterns);
        out.push_back({(at / key).to_string(), message});
    }
}

void missing_keys(const json& schema, const json& value, const json::json_pointer& at, std::vector<SchemaFault>& out) {
    if (!value.is_object() || !schema.contains("required")) return;
    for (const json& name : schema["required"]) {
        const std::string key = name.get<std::string>();
        if (value.contains(key)) continue;
        std::string message = fmt::format("\"{}\" is missing", key);
        if (schema.contains("properties") && schema["properties"].contains(key)) {
            const json& property = schema["properties"][key];
            if (property.contains("enum")) message += "; it is " + describe(property);
            if (property.contains("description"))
                message += fmt::format(" ({})", property["description"].get<std::string>());
        }
        out.push_back({at.to_string(), message});
    }
}

bool in_range(const json& schema, double value) {
    const auto bound = [&](const char* name) { return schema.contains(name) && schema[name].is_number(); };
    return !(bound("minimum") && value < schema["minimum"].get<double>()) &&
           !(bound("maximum") && value > schema["maximum"].get<double>()) &&
           !(bound("exclusiveMinimum") && value <= schema["exclusiveMinimum"].get<double>()) &&
           !(bound("exclusiveMaximum") && value >= schema["exclusiveMaximum"].get<double>());
}

bool has_count(const json& schema, const json& value) {
    if (value.is_array())
        return value.size() >= schema.value("minItems", std::size_t{0}) &&
               value.size() <= schema.value("maxItems", value.size());
    if (!value.is_string()) return true;
    const std::size_t length = value.get_ref<const std::string&>().size();
    return length >= schema.value("minLength", std::size_t{0}) && length <= schema.value("maxLength", length);
}

std::optional<std::string> wrong_value(const json& schema, const json& value) {
    const auto expected = [&] { return fmt::format("expected {}, got {}", describe(schema), show(value)); };
    if (schema.contains("type") && !has_type(value, schema["type"])) return expected();
    if (schema.contains("const") && schema["const"] != value)
        return fmt::format("expected {}, got {}", show(schema["const"]), show(value));
    if (schema.contains("enum")) {
        std::vector<std::string> words;
        bool found = false;
        for (const json& word : schema["enum"]) {
            if (word.is_string()) words.push_back(word.get<std::string>());
            found = found || word == value;
        }
        if (!found) {
            return expected() + (value.is_string() ? base::perhaps(value.get<std::string>(), words) : "");
        }
    }
    if (value.is_number() && !in_range(schema, value.get<double>())) return expected();
    if (!has_count(schema, value)) return expected();
    if (value.is_string() && schema.contains("pattern") && !matches(value.get<std::string>(), schema["pattern"]))
        return expected();
    return std::nullopt;
}

}  // namespace

std::vector<SchemaFault> explain_faults(const json& document, const json& schema, const std::vector<std::string>& path,
                                        std::size_t most) {
    const Applicable applicable(schema);
    const json* value = &document;
    json::json_pointer at;
    Schemas schemas;
    applicable.add(schema, document, schemas);
    for (const std::string& step : path) {
        const bool in_array = value->is_array();
        value = in_array ? &value->at(std::stoul(step)) : &value->at(step);
        in_array ? at /= std::stoul(step) : at /= step;
        schemas = applicable.below(schemas, step, *value, in_array);
    }
    for (const json* part : schemas)
        if (const auto message = wrong_value(*part, *value)) return {{at.to_string(), *message}};
    std::vector<SchemaFault> faults;
    for (const json* part : schemas) unknown_keys(*part, *value, at, most, faults);
    for (const json* part : schemas) missing_keys(*part, *value, at, faults);
    if (!faults.empty()) return faults;
    for (const json* part : schemas)
        for (const char* alternatives : {"anyOf", "oneOf"})
            if (part->contains(alternatives))
                return {{at.to_string(), fmt::format("expected {}, got {}", describe(*part), show(*value))}};
    return {};
}

}  // namespace shadowbench::scene
