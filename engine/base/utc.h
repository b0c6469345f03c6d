// The time of day in results.
#pragma once

#include <string>

namespace shadowbench::base {

// Now, in UTC, ISO 8601 to the second: "2026-11-29T13:45:00Z".
std::string now_utc();

}  // namespace shadowbench::base
