// Where a proxy shows the server below its host.
#pragma once

#include <optional>
#include <string>

#include "service/api/message.h"

namespace shadowbench::service {

// "/lab", "/tools/lab": segments of letters, digits and "-._~", none of them "." or "..", 200 bytes at most.
bool is_prefix(const std::string& path);

// Sets the prefix of a request: its X-Forwarded-Prefix, or else `base_path`, which may be empty. Takes `base_path` off
// the path if the proxy left it there. Returns the answer that leads from the prefix to its page, which lies below it.
std::optional<ApiResponse> take_prefix(ApiRequest& request, const std::string& base_path);

}  // namespace shadowbench::service
