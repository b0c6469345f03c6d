// Says what is wrong with a value that a schema refused, in one line each.
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

// `path` leads from the document's root to the value that was refused. The messages are made from the schemas that
// apply there, and speak of the value itself: its type or range, its unknown keys (about `most` of them), those that
// are missing. Empty: the schemas do not tell.
std::vector<SchemaFault> explain_faults(const nlohmann::json& document, const nlohmann::json& schema,
                                        const std::vector<std::string>& path, std::size_t most);

}  // namespace shadowbench::scene
