// JSON pointers (RFC 6901) that set values in a scenario document.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace shadowbench::document {

// The place of the value that a pointer sets: an element that exists, or a member of an object that exists. A part of
// the scenario that the document leaves out (such as "timing") is added first. Null if the parent does not exist or is
// not an object, or if an array has no such element.
nlohmann::json* find_place(nlohmann::json& document, const nlohmann::json_pointer<std::string>& pointer);

}  // namespace shadowbench::document
