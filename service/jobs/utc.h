// Times as text: UTC, ISO 8601 with milliseconds, "2026-11-25T01:02:03.004Z".
#pragma once

#include <ctime>
#include <optional>
#include <string>

namespace shadowbench::service {

std::string utc_text(std::timespec moment);
std::string now_utc();

// Nothing where one of the two is no such time.
std::optional<double> seconds_between(const std::string& from, const std::string& to);

}  // namespace shadowbench::service
