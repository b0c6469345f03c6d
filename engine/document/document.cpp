#include "document/document.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/json_pointer.h"
#include "base/nearest.h"
#include "base/utf8.h"
#include "document/pointer.h"
#include "scene/scenario.h"
#include "techniques/technique.h"

namespace shadowbench::document {
namespace {

using base::Error;
using base::ErrorCode;
using nlohmann::json;

json::json_pointer read_path(const std::string& path, const std::string& assignment) {
    std::string pointer = path;
    if (pointer.empty() || pointer[0] != '/') {
        for (char& c : pointer)
            if (c == '.') c = '/';
        pointer = '/' + pointer;
    }
    try {
        return json::json_pointer(pointer);
    } catch (const json::exception&) {
        throw Error(ErrorCode::usage, "--set " + assignment,
                    "the path is not a JSON pointer; write ~ as ~0 and / within a name as ~1");
    }
}

// A value that is set replaces a sweep over it.
void drop_sweep(json& document, const json::json_pointer& pointer) {
    const auto sweeps = document.find("sweeps");
    if (sweeps == document.end() || !sweeps->is_object() || sweeps->erase(pointer.to_string()) == 0) return;
    if (sweeps->empty()) document.erase("sweeps");
}

// {"if": {"type": id}, "then": the technique's own schema} for each technique.
json technique_choices() {
    json choices = json::array();
    for (const techniques::Technique& row : techniques::all())
        choices.push_back({{"if", {{"properties", {{"type", {{"const", row.id}}}}}}},
                           {"then", techniques::parameter_schema(row.id, row.parameters)}});
    choices.push_back({{"if", {{"properties", {{"type", {{"const", every_technique}}}}}}},
                       {"then", techniques::parameter_schema(every_technique, {})}});
    return choices;
}

// Checks the parameters of a technique, an object whose "type" is a string. Throws Error{bad_input}.
void check_technique(const json& technique, const std::string& where) {
    const std::string type = technique.at("type").get<std::string>();
    if (type != every_technique) {
        techniques::read_parameters(techniques::find(type, where + "/type").parameters, technique, where);
        return;
    }
    for (const auto& [key, value] : technique.items())
        if (key != "type")
            throw Error(ErrorCode::bad_input, base::append_token(where, key),
                        "\"*\" takes no parameters: it stands for techniques with their defaults. List the technique "
                        "that this parameter is for beside it");
}

constexpr std::size_t most_faults = 32;  // reported at a time

// The faults that a technique's declaration finds in it; none if its type is not known.
std::vector<Error> technique_faults(const json& technique, const std::string& where) {
    std::vector<Error> faults;
    if (!technique.is_object() || !technique.contains("type") || !technique["type"].is_string()) return faults;
    const auto check = [&](const json& part) {
        try {
            check_technique(part, where);
            return true;
        } catch (const Error& error) {
            faults.push_back(error);
            return false;
        }
    };
    const json& type = technique["type"];
    if (!check({{"type", type}})) return faults;
    for (const auto& [key, value] : technique.items())
        if (key != "type") check({{"type", type}, {key, value}});
    return faults;
}

}  // namespace

void set_value(json& document, const std::string& assignment) {
    const std::size_t equals = assignment.find('=');
    if (equals == std::string::npos || equals == 0)
        throw Error(ErrorCode::usage, "--set " + assignment, "expected path=value, as in rays.samples_per_pixel=64");
    if (!base::is_utf8(assignment)) throw Error(ErrorCode::usage, "--set " + assignment, "the text is not UTF-8");
    const std::string path = assignment.substr(0, equals), text = assignment.substr(equals + 1);
    const json::json_pointer pointer = read_path(path, assignment);

    json value;
    if (!text.empty() && (text.front() == '{' || text.front() == '[')) {
        value = scene::parse_json(text, "--set " + path);
    } else {
        value = json::parse(text, nullptr, false);
        if (value.is_discarded()) value = text;
    }

    json* place = find_place(document, pointer);
    if (!place)
        throw Error(ErrorCode::usage, "--set " + assignment,
                    fmt::format("the scenario has no {} to set a value in", pointer.parent_pointer().to_string()));
    *place = std::move(value);
    drop_sweep(document, pointer);
}

json full_schema() {
    json schema = scene::scenario_schema();
    json& technique = schema.at("definitions").at("technique");
    technique["allOf"] = technique_choices();
    return schema;
}

void check_document(const json& document, std::span<const std::string> technique_where) {
    scene::check_schema(document, scene::scenario_schema());
    // The techniques' own checks come first: their messages say more than the schema's.
    const json& items = document.at("techniques");
    for (std::size_t i = 0; i < items.size(); ++i) {
        const std::string where = technique_where.empty() ? fmt::format("/techniques/{}", i) : technique_where[i];
        check_technique(items[i], where);
    }
    scene::check_schema(document, full_schema());
}

std::vector<base::Error> all_faults(const json& document, const Error& first) {
    std::vector<Error> all{first};
    const auto add = [&all](const Error& fault) {
        const bool is_first = std::string_view(fault.what()) == all[0].what();
        if (!is_first && all.size() < most_faults) all.push_back(fault);
    };
    for (const Error& fault : scene::schema_faults(document, scene::scenario_schema(), most_faults)) add(fault);
    const auto techniques = document.find("techniques");
    if (techniques == document.end() || !techniques->is_array()) return all;
    for (std::size_t i = 0; i < techniques->size(); ++i)
        for (const Error& fault : technique_faults((*techniques)[i], fmt::format("/techniques/{}", i))) add(fault);
    return all;
}

void keep_only(Variant& variant, std::span<const std::string> types) {
    if (types.empty()) return;
    const json& items = variant.document->at("techniques");
    std::vector<std::string> present;
    const auto is_present = [&](const std::string& type) {
        return std::find(present.begin(), present.end(), type) != present.end();
    };
    for (const json& item : items)
        if (const std::string type = item.at("type").get<std::string>(); !is_present(type)) present.push_back(type);
    for (const std::string& type : types)
        if (!is_present(type))
            throw Error(ErrorCode::usage, "--only " + type,
                        "the scenario has no such technique" + base::perhaps(type, present) +
                            fmt::format("; it has: {}", fmt::join(present, " ")));

    json kept = json::array();
    std::vector<std::string> kept_where;
    std::vector<std::vector<std::string>> kept_swept;
    for (std::size_t i = 0; i < items.size(); ++i) {
        if (std::find(types.begin(), types.end(), items[i].at("type").get<std::string>()) == types.end()) continue;
        kept.push_back(items[i]);
        kept_where.push_back(variant.technique_where[i]);
        kept_swept.push_back(variant.swept[i]);
    }
    json document = *variant.document;
    document["techniques"] = std::move(kept);
    variant.document = std::make_shared<const json>(std::move(document));
    variant.technique_where = std::move(kept_where);
    variant.swept = std::move(kept_swept);
}

}  // namespace shadowbench::document
