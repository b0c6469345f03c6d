#include "scene/json_text.h"

#include <cstddef>

#include <nlohmann/json.hpp>

namespace shadowbench::scene {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t longest_line = 100;

std::string scalar_text(const ordered_json& value) {
    return value.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

// What stands before a member: its key, or nothing in an array.
std::string key_text(const ordered_json& parent, const std::string& key) {
    return parent.is_object() ? scalar_text(key) + ": " : "";
}

std::string enclosed(const ordered_json& value, const std::string& members) {
    return value.is_object() ? "{" + members + "}" : "[" + members + "]";
}

// `lead`: the length of the key before the value, on its first line.
std::string lines_of(const ordered_json& value, std::size_t indent, std::size_t lead) {
    const std::string line = in_one_line(value);
    if (!value.is_structured() || indent + lead + line.size() < longest_line) return line;
    const std::string begin = "\n" + std::string(indent + 2, ' ');
    std::string members;
    for (const auto& [key, member] : value.items()) {
        const std::string name = key_text(value, key);
        members += (members.empty() ? "" : ",") + begin + name + lines_of(member, indent + 2, name.size());
    }
    return enclosed(value, members + "\n" + std::string(indent, ' '));
}

}  // namespace

std::string in_one_line(const ordered_json& value) {
    if (!value.is_structured()) return scalar_text(value);
    std::string members;
    for (const auto& [key, member] : value.items())
        members += (members.empty() ? "" : ", ") + key_text(value, key) + in_one_line(member);
    return enclosed(value, members);
}

std::string in_lines(const ordered_json& value) {
    return lines_of(value, 0, 0);
}

}  // namespace shadowbench::scene
