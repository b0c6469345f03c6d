#include "service/jobs/utc.h"

#include <fmt/format.h>

namespace shadowbench::service {

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

}  // namespace shadowbench::service
