// Answers that say no, as RFC 9457 has them, and answers of JSON.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "base/error.h"
#include "service/api/message.h"

namespace shadowbench::service {

struct ProblemPart {
    std::string pointer, detail;  // JSON pointer into the scenario
};

ApiResponse problem(int status, const std::string& detail, const std::vector<ProblemPart>& errors = {});
// With further members, as "estimate".
ApiResponse problem(int status, const std::string& detail, const std::vector<ProblemPart>& errors,
                    const nlohmann::json& members);

// What the engine says of an input, for strangers: 422 with the pointer of its place; 400 for usage; 500 or 503, and
// nothing of the cause, for faults of this side.
ApiResponse problem_of(const base::Error& error);
// Of several at once, all of inputs.
ApiResponse problem_of(const std::vector<base::Error>& faults);

ApiResponse json_answer(int status, const nlohmann::json& value);
ApiResponse json_answer(int status, const nlohmann::ordered_json& value);

// The reason phrase of a status.
const char* title_of(int status);

}  // namespace shadowbench::service
