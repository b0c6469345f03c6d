// Says in one line what is wrong with a value that a schema refused.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace shadowbench::scene {

struct SchemaFault {
    std::string pointer;  // JSON pointer
    std::string message;
};

// `path` leads from the document's root to the value that was refused. The message is made from the schemas that apply
// there; `fallback` is used where they do not tell.
SchemaFault explain_fault(const nlohmann::json& document, const nlohmann::json& schema,
                          const std::vector<std::string>& path, const std::string& fallback);

}  // namespace shadowbench::scene
