// JSON pointers (RFC 6901) that set values in a scenario document.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace shadowbench::document {

// Where a value of this pointer goes: an element that is there, or a member of an object that is there. A part of the
// scenario that the document leaves out (such as "timing") is added first. Null when the parent is not there or is no
// object, or when an array has no such element.
nlohmann::json* find_place(nlohmann::json& document, const nlohmann::json_pointer<std::string>& pointer);

}  // namespace shadowbench::document
