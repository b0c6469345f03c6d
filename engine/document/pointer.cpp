#include "document/pointer.h"

#include <nlohmann/json.hpp>

#include "scene/scenario.h"

namespace shadowbench::document {
namespace {

bool part_left_out(const nlohmann::json& document, const nlohmann::json::json_pointer& part) {
    return !part.empty() && part.parent_pointer().empty() && !document.contains(part) &&
           scene::scenario_schema().at("properties").contains(part.back());
}

}  // namespace

nlohmann::json* find_place(nlohmann::json& document, const nlohmann::json_pointer<std::string>& pointer) {
    if (pointer.empty() || !document.is_object()) return nullptr;
    try {
        if (document.contains(pointer)) return &document.at(pointer);
        const auto parent = pointer.parent_pointer();
        if (part_left_out(document, parent)) document[parent] = nlohmann::json::object();
        if (!document.contains(parent) || !document.at(parent).is_object()) return nullptr;
        return &document.at(parent)[pointer.back()];
    } catch (const nlohmann::json::out_of_range&) {  // an index too large for an integer
        return nullptr;
    }
}

}  // namespace shadowbench::document
