#include "service/jobs/launched.h"

#include <poll.h>
#include <unistd.h>

#include <charconv>
#include <chrono>
#include <limits>
#include <optional>
#include <ostream>

#include <fmt/format.h>

namespace shadowbench::service {
namespace {

using std::chrono::steady_clock;

// The lines of the guard: "guard started", and in the end "guard exited 2", with a word for each ChildEnd.
constexpr std::string_view guard_line = "guard ", guard_started = "started";
constexpr std::pair<ChildEnd, std::string_view> end_words[] = {{ChildEnd::exited, "exited "},
                                                               {ChildEnd::signalled, "signalled "},
                                                               {ChildEnd::out_of_time, "out_of_time "},
                                                               {ChildEnd::out_of_memory, "out_of_memory "},
                                                               {ChildEnd::too_much_output, "too_much_output "}};

constexpr double launcher_farewell = 3.0;  // seconds
constexpr double late = 60.0;              // seconds that the guard may take beyond the time limit, which it enforces

// What the guard says of the job's end; nothing for any other text.
std::optional<ChildReport> read_end(std::string_view text) {
    for (const auto& [end, word] : end_words) {
        if (!text.starts_with(word)) continue;
        ChildReport report;
        report.end = end;
        const char* const last = text.data() + text.size();
        const auto [rest, failed] = std::from_chars(text.data() + word.size(), last, report.code);
        if (failed == std::errc() && rest == last) return report;
    }
    return std::nullopt;
}

// Reads the signs of life on standard input, as they come.
class SignsOfLife {
public:
    explicit SignsOfLife(double silence) : silence_(silence) {}

    // Whether the other end is closed, or silent for too long.
    bool have_ended() {
        const auto now = steady_clock::now();
        pollfd waiting{STDIN_FILENO, POLLIN, 0};
        if (::poll(&waiting, 1, 0) > 0) {
            char bytes[256];
            if (::read(STDIN_FILENO, bytes, sizeof bytes) <= 0) return true;
            heard_ = now;
        }
        return now - heard_ > silence_;
    }

private:
    std::chrono::duration<double> silence_;
    steady_clock::time_point heard_ = steady_clock::now();
};

}  // namespace

ChildReport run_launched(const std::string& launcher, const std::string& guard, const std::string& program,
                         const std::vector<std::string>& arguments, const ChildLimits& limits,
                         const std::function<void(std::string_view line)>& on_line,
                         const std::function<bool()>& should_end) {
    std::vector<std::string> words{"-c", "exec " + launcher + " \"$@\"", "sh", guard, "guard"};
    words.insert(words.end(),
                 {"--seconds", fmt::format("{}", limits.seconds), "--memory", std::to_string(limits.memory),
                  "--silence", fmt::format("{}", longest_silence_of_server), "--", program});
    words.insert(words.end(), arguments.begin(), arguments.end());

    ChildLimits of_launcher = limits;
    of_launcher.seconds = 1e9;
    of_launcher.memory = std::numeric_limits<std::size_t>::max();
    of_launcher.farewell = launcher_farewell;
    std::optional<ChildReport> end;
    std::optional<steady_clock::time_point> started;
    bool out_of_time = false;
    ChildReport report = run_child(
        "/bin/sh", words, of_launcher,
        [&](std::string_view line) {
            if (!line.starts_with(guard_line)) return on_line(line);
            const std::string_view says = line.substr(guard_line.size());
            if (says == guard_started) started = steady_clock::now();
            if (const auto read = read_end(says)) end = read;
        },
        [&] {
            out_of_time =
                started && steady_clock::now() - *started > std::chrono::duration<double>(limits.seconds + late);
            return out_of_time || should_end();
        });
    if (report.end == ChildEnd::stopped && out_of_time) report.end = ChildEnd::out_of_time;
    if (report.end != ChildEnd::exited && report.end != ChildEnd::signalled) return report;
    if (end) {
        end->errors = std::move(report.errors);
        return *std::move(end);
    }
    if (report.end == ChildEnd::signalled) report.code += 128;
    report.end = ChildEnd::lost;
    return report;
}

void guard_job(const std::string& program, const std::vector<std::string>& arguments, const ChildLimits& limits,
               double silence, std::ostream& out, std::ostream& err) {
    out << guard_line << guard_started << '\n' << std::flush;
    SignsOfLife signs(silence);
    const ChildReport report = run_child(
        program, arguments, limits, [&](std::string_view line) { out << line << '\n'
                                                                     << std::flush; },
        [&] { return signs.have_ended(); });
    err << report.errors << std::flush;
    for (const auto& [end, word] : end_words)
        if (end == report.end) out << guard_line << word << report.code << '\n' << std::flush;
}

}  // namespace shadowbench::service
