// A scenario in a request body, from text to what may be queued.
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

// The body is the scenario, or {"scenario": ..., "options": {"cache": "reuse"|"fresh", "pictures": true}}. The answer
// that says no, when it is neither.
std::variant<PostedScenario, ApiResponse> read_posted(const std::string& body);

// What the scenario is and costs (see helper_side.h), or the answer that says no: it is wrong, or costs too much.
std::variant<nlohmann::json, ApiResponse> examine_posted(Context& context, const PostedScenario& posted);

}  // namespace shadowbench::service
