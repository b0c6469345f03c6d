// Reads and checks the scenario in a request body.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "base/error.h"
#include "service/api/context.h"
#include "service/api/message.h"

namespace shadowbench::service {

struct PostedScenario {
    std::string text;       // JSON on one line
    std::string recommend;  // a recommend::Request as JSON on one line; empty: none, or a wrong one
    bool pictures = true, reuse = true;
    std::vector<std::string> labels = {};
    int priority = 0;
    std::vector<base::Error> faults;  // of the body outside of the scenario
};

// The body is a scenario, or {"scenario": ..., "options": {"cache": "reuse"|"fresh", "pictures": true, "labels": ["a"],
// "priority": 0}}. Returns the answer that refuses any other body.
std::variant<PostedScenario, ApiResponse> read_posted(const std::string& body);

// The body is {"scenario": ..., "recommend": ..., "options": ...}, with all options but pictures: see
// recommend/request.h. Wrong parts become faults. Returns the answer that refuses a body without a scenario.
std::variant<PostedScenario, ApiResponse> read_posted_recommendation(const std::string& body);

// The facts and the estimated cost of the scenario (helper_side.h), or the answer that refuses a body with faults, or a
// wrong or too costly scenario.
std::variant<nlohmann::json, ApiResponse> examine_posted(Context& context, const PostedScenario& posted);

}  // namespace shadowbench::service
