// Reads and checks the scenario in a request body.
#pragma once

#include <string>
#include <variant>

#include <nlohmann/json_fwd.hpp>

#include "service/api/context.h"
#include "service/api/message.h"

namespace shadowbench::service {

struct PostedScenario {
    std::string text;  // JSON on one line
    bool pictures = true, reuse = true;
};

// The body is a scenario, or {"scenario": ..., "options": {"cache": "reuse"|"fresh", "pictures": true}}. Returns the
// answer that refuses any other body.
std::variant<PostedScenario, ApiResponse> read_posted(const std::string& body);

// The facts and the estimated cost of the scenario (helper_side.h), or the answer that refuses a wrong or too costly
// one.
std::variant<nlohmann::json, ApiResponse> examine_posted(Context& context, const PostedScenario& posted);

}  // namespace shadowbench::service
