// JSON as all files of this project have it.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace shadowbench::scene {

// Parses JSON text, UTF-8 with or without a byte-order mark. Throws Error{bad_input} whose place is origin:line:column.
nlohmann::json parse_json(const std::string& text, const std::string& origin);

}  // namespace shadowbench::scene
