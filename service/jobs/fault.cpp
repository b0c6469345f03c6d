#include "service/jobs/fault.h"

#include <string.h>

#include <algorithm>
#include <filesystem>
#include <string_view>

#include <fmt/format.h>

#include "base/error.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t shown_lines = 3;
constexpr std::size_t shown_bytes = 500;

bool ends_path(char c) {
    return c == ' ' || c == '\n' || c == '\t' || c == '"' || c == '\'' || c == '(' || c == ')' || c == '`' || c == ',';
}

void add(std::vector<HiddenFolder>& folders, const std::string& path, const char* name) {
    const auto one = [&](fs::path form) {
        std::string text = form.lexically_normal().string();
        while (text.size() > 1 && text.back() == '/') text.pop_back();
        if (text.size() > 1) folders.push_back({text, name});
    };
    std::error_code failed;
    one(path);
    if (fs::path whole = fs::absolute(path, failed); !failed) one(whole);
    if (fs::path real = fs::weakly_canonical(path, failed); !failed) one(real);
}

// The last lines of a text that say anything.
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
    return shorten_paths(result);
}

std::string how_it_ended(const ChildReport& report, const JobLimits& limits) {
    switch (report.end) {
        case ChildEnd::out_of_time:
            return fmt::format(
                "the job ran longer than {:g} s, the limit of this server; fewer samples, techniques or "
                "values of sweeps take less",
                limits.seconds);
        case ChildEnd::out_of_memory:
            return fmt::format(
                "the job took more than {:.3g} GiB of memory, the limit of this server; a smaller map or "
                "fewer samples take less",
                static_cast<double>(limits.memory) / (1024.0 * 1024.0 * 1024.0));
        case ChildEnd::too_much_output:
            return "the job's process wrote without end";
        case ChildEnd::signalled: {
            const char* name = ::sigdescr_np(report.code);
            return fmt::format("the job's process was ended by signal {} ({})", report.code, name ? name : "unknown");
        }
        case ChildEnd::exited:
        case ChildEnd::told:
            break;
    }
    if (report.code == 0) return "the job's process ended without a result";
    return fmt::format("the job's process ended with exit code {}", report.code);
}

}  // namespace

std::vector<HiddenFolder> hidden_folders(const std::string& state, const std::vector<std::string>& data) {
    std::vector<HiddenFolder> folders;
    add(folders, state, "the server's folder");
    for (const std::string& folder : data) add(folders, folder, "the data folder");
    std::stable_sort(folders.begin(), folders.end(),
                     [](const HiddenFolder& a, const HiddenFolder& b) { return a.path.size() > b.path.size(); });
    return folders;
}

std::string hide(std::string text, const std::vector<HiddenFolder>& folders) {
    for (const HiddenFolder& folder : folders)
        for (std::size_t at = 0; (at = text.find(folder.path, at)) != std::string::npos;) {
            const std::size_t end = at + folder.path.size();
            const bool within = end < text.size() && text[end] == '/';
            const bool starts = at == 0 || ends_path(text[at - 1]);
            const bool ends = within || end == text.size() || ends_path(text[end]) || text[end] == ':' ||
                              text[end] == ';' || text[end] == '.';
            if (!starts || !ends) {  // a part of a longer name
                at = end;
                continue;
            }
            const std::string instead = within ? "" : folder.name;
            text.replace(at, end - at + (within ? 1 : 0), instead);
            at += instead.size();
        }
    return text;
}

std::string shorten_paths(const std::string& text) {
    std::string result;
    for (std::size_t at = 0; at < text.size();) {
        std::size_t end = at;
        while (end < text.size() && !ends_path(text[end])) ++end;
        std::string word = text.substr(at, end - at);
        if (word.size() > 1 && word[0] == '/') word = word.substr(word.find_last_of('/', word.size() - 2) + 1);
        result += word;
        if (end < text.size()) result += text[end++];
        at = end;
    }
    return result;
}

JobFault fault_of_end(const ChildReport& report, const JobLimits& limits) {
    const bool over_limit = report.end == ChildEnd::out_of_time || report.end == ChildEnd::out_of_memory;
    const base::ErrorCode code = over_limit ? base::ErrorCode::bad_input : base::ErrorCode::internal;
    std::string message = how_it_ended(report, limits);
    const bool died = report.end == ChildEnd::exited || report.end == ChildEnd::signalled;
    if (const std::string said = died ? last_lines(report.errors) : ""; !said.empty()) message += ": " + said;
    return {static_cast<int>(code), "", base::Error(code, "", message).message()};
}

}  // namespace shadowbench::service
