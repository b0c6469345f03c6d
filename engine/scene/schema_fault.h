// Explains in one line each what is wrong with a value that a schema refused.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace shadowbench::scene {

struct SchemaFault {
    std::string pointer;  // JSON pointer
    std::string message;
};

// `path` leads from the document's root to the refused value. The messages are made from the schemas that apply there
// and describe the value itself: its type or range, its unknown keys (about `most` of them), its missing keys. Returns
// nothing if the schemas do not explain the fault.
std::vector<SchemaFault> explain_faults(const nlohmann::json& document, const nlohmann::json& schema,
                                        const std::vector<std::string>& path, std::size_t most);

}  // namespace shadowbench::scene
