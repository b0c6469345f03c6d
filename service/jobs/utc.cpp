#include "service/jobs/utc.h"

#include <cstdio>

#include <fmt/format.h>

namespace shadowbench::service {
namespace {

// Since 1970.
std::optional<double> seconds_of(const std::string& text) {
    std::tm fields{};
    const char* const rest = ::strptime(text.c_str(), "%Y-%m-%dT%H:%M:%S", &fields);
    int milliseconds = 0;
    if (!rest || std::sscanf(rest, ".%3dZ", &milliseconds) != 1) return std::nullopt;
    return static_cast<double>(::timegm(&fields)) + milliseconds / 1000.0;
}

}  // namespace

std::string utc_text(std::timespec moment) {
    std::tm parts{};
    gmtime_r(&moment.tv_sec, &parts);
    char text[32];
    std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S", &parts);
    return fmt::format("{}.{:03}Z", text, moment.tv_nsec / 1000000);
}

std::string now_utc() {
    std::timespec now{};
    std::timespec_get(&now, TIME_UTC);
    return utc_text(now);
}

std::optional<double> seconds_between(const std::string& from, const std::string& to) {
    const std::optional<double> begin = seconds_of(from), end = seconds_of(to);
    return begin && end ? std::optional(*end - *begin) : std::nullopt;
}

}  // namespace shadowbench::service
