// Answers held against openapi.json.
#pragma once

#include <string>

#include "service/api/message.h"

namespace shadowbench::service {

// Fails the test when the status of the answer is not documented for its route, or its JSON is not of the documented
// form. The answer to an unknown route must be a problem.
void check_documented(const ApiRequest& request, const ApiResponse& response, const std::string& body);

}  // namespace shadowbench::service
