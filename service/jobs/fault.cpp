#include "service/jobs/fault.h"

#include <string.h>

#include <string_view>

#include <fmt/format.h>

#include "base/error.h"

namespace shadowbench::service {
namespace {

constexpr std::size_t shown_lines = 3;
constexpr std::size_t shown_bytes = 500;

// The last lines of a text that are not blank.
std::string last_lines(const std::string& text) {
    std::string result;
    std::size_t end = text.size();
    for (std::size_t lines = 0; lines < shown_lines && end > 0;) {
        const std::size_t before = text.rfind('\n', end - 1);
        const std::size_t start = before == std::string::npos ? 0 : before + 1;
        const std::string line = text.substr(start, end - start);
        if (line.find_first_not_of(" \t\r") != std::string::npos) {
            if (result.size() + line.size() > shown_bytes) break;
            result = result.empty() ? line : line + " / " + result;
            ++lines;
        }
        end = before == std::string::npos ? 0 : before;
    }
    return result;
}

std::string how_it_ended(const ChildReport& report, const JobLimits& limits) {
    switch (report.end) {
        case ChildEnd::out_of_time:
            return fmt::format(
                "the job ran longer than {:g} s, the limit of this server; use fewer samples, techniques or "
                "values of sweeps",
                limits.seconds);
        case ChildEnd::out_of_memory:
            return fmt::format(
                "the job took more than {:.3g} GiB of memory, the limit of this server; use a smaller map or "
                "fewer samples",
                static_cast<double>(limits.memory) / (1024.0 * 1024.0 * 1024.0));
        case ChildEnd::too_much_output:
            return "the job's process wrote too much output";
        case ChildEnd::signalled: {
            const char* name = ::sigdescr_np(report.code);
            return fmt::format("the job's process was ended by signal {} ({})", report.code, name ? name : "unknown");
        }
        case ChildEnd::lost:
            return fmt::format("the launcher ended with exit code {} before the job", report.code);
        case ChildEnd::exited:
        case ChildEnd::stopped:
            break;
    }
    if (report.code == 0) return "the job's process ended without a result";
    return fmt::format("the job's process ended with exit code {}", report.code);
}

}  // namespace

JobFault fault_of_end(const ChildReport& report, const JobLimits& limits, const std::vector<HiddenFolder>& folders) {
    const bool over_limit = report.end == ChildEnd::out_of_time || report.end == ChildEnd::out_of_memory;
    const base::ErrorCode code = over_limit ? base::ErrorCode::bad_input : base::ErrorCode::internal;
    std::string message = how_it_ended(report, limits);
    const bool died = report.end == ChildEnd::exited || report.end == ChildEnd::signalled ||
                      report.end == ChildEnd::lost;
    if (const std::string quote = died ? last_lines(report.errors) : ""; !quote.empty())
        message += ": " + hide(quote, folders, OtherPaths::last_part);
    return {static_cast<int>(code), "", base::Error(code, "", message).message()};
}

}  // namespace shadowbench::service
