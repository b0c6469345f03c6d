// Answers with JSON: problems (RFC 9457) and values.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "base/error.h"
#include "service/api/message.h"

namespace shadowbench::service {

struct ProblemPart {
    std::string pointer, detail;  // JSON pointer into the scenario, or into the body
};

ApiResponse problem(int status, const std::string& detail, const std::vector<ProblemPart>& errors = {});
// The same with further members, such as "estimate".
ApiResponse problem(int status, const std::string& detail, const std::vector<ProblemPart>& errors,
                    const nlohmann::json& members);

inline constexpr const char* problem_type = "application/problem+json";
// Gives a problem the member "request_id".
void add_request_id(ApiResponse& problem, const std::string& id);

// The answer to an error of the engine: 422 with the pointer of its place for bad input, 400 for wrong usage. For a
// fault of the server 500 or 503, without its cause.
ApiResponse problem_of(const base::Error& error);
// The answer 422 to several errors in the input.
ApiResponse problem_of(const std::vector<base::Error>& faults);

ApiResponse json_answer(int status, const nlohmann::json& value);
ApiResponse json_answer(int status, const nlohmann::ordered_json& value);

// The reason phrase of a status.
const char* title_of(int status);

}  // namespace shadowbench::service
