#include <algorithm>
#include <system_error>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/read_text.h"
#include "compare/read_result.h"

namespace shadowbench::compare {
namespace {

namespace fs = std::filesystem;
using base::Error;
using base::ErrorCode;

constexpr int most_deep = 64;

// Merges another process of the same cell: its times are added. If exact measures differ, the worst counts.
void merge_cell(Cell& into, Cell&& from, std::vector<std::string>& unsteady) {
    if (from.failed && !into.failed) {
        into.failed = true;
        into.failure = from.failure;
    }
    into.degraded = into.degraded || from.degraded;
    for (const Exact& exact : from.exact) {
        const auto found = std::find_if(into.exact.begin(), into.exact.end(),
                                        [&](const Exact& other) { return other.name == exact.name; });
        if (found == into.exact.end()) {
            into.exact.push_back(exact);
        } else if (found->value != exact.value) {
            unsteady.push_back(into.name + ": " + exact.name);
            found->value = std::max(found->value, exact.value);
        }
    }
    for (Timed& timed : from.timed) {
        const auto found = std::find_if(into.timed.begin(), into.timed.end(), [&](const Timed& other) {
            return other.name == timed.name && other.unit == timed.unit;
        });
        if (found == into.timed.end())
            into.timed.push_back(std::move(timed));
        else
            found->processes.insert(found->processes.end(), timed.processes.begin(), timed.processes.end());
    }
}

void merge(Suite& into, Suite&& from, const std::string& origin, std::vector<std::string>& notes) {
    const bool same_machine = into.machine == from.machine;
    if (!same_machine)
        notes.push_back(fmt::format("{}: times left out: it ran on {}, earlier results of {} on {}", origin,
                                    from.machine, into.name, into.machine));
    if (into.program != from.program)
        notes.push_back(fmt::format("{}: written by program {}, earlier results of {} by {}", origin, from.program,
                                    into.name, into.program));
    std::vector<std::string> unsteady;
    ++into.results;
    if (same_machine) into.speed.insert(into.speed.end(), from.speed.begin(), from.speed.end());
    for (Cell& cell : from.cells) {
        if (!same_machine) cell.timed.clear();
        const auto found = std::find_if(into.cells.begin(), into.cells.end(), [&](const Cell& other) {
            return other.group == cell.group && other.name == cell.name;
        });
        if (found == into.cells.end())
            into.cells.push_back(std::move(cell));
        else
            merge_cell(*found, std::move(cell), unsteady);
    }
    if (!unsteady.empty())
        notes.push_back(fmt::format("{}: differs from earlier results of {} in {}{}; the worst value counts", origin,
                                    into.name, unsteady[0],
                                    unsteady.size() > 1 ? fmt::format(" and {} more", unsteady.size() - 1) : ""));
}

// Results of an interleaved comparison are in sibling folders, beside a file that marks them.
std::string interleaved_with(const fs::path& path) {
    std::error_code failed;
    const fs::path place = fs::canonical(path, failed);
    if (failed || !fs::is_directory(place, failed)) return "";
    const fs::path mark = place.parent_path() / interleaved_mark;
    return fs::is_regular_file(mark, failed) ? mark.string() : "";
}

}  // namespace

bool add(Measured& measured, const nlohmann::json& document, const std::string& origin) {
    const results::Field whole = results::top(document, origin);
    Suite suite;
    if (whole.has("schema_version") && whole.has("scenario_hash"))
        suite = read_result(whole, origin);
    else if (whole.has("benchmarks") && whole.has("context"))
        suite = read_kernels(whole);
    else
        return false;
    if (suite.cells.empty()) measured.notes.push_back(fmt::format("{}: holds no cell", origin));
    const auto found = std::find_if(measured.suites.begin(), measured.suites.end(), [&](const Suite& other) {
        return other.name == suite.name && other.hash == suite.hash;
    });
    if (found == measured.suites.end())
        measured.suites.push_back(std::move(suite));
    else
        merge(*found, std::move(suite), origin, measured.notes);
    return true;
}

nlohmann::json parse(const std::string& text, const std::string& origin) {
    // Copying a deeper document would overflow the stack.
    const auto limited = [&](int depth, nlohmann::json::parse_event_t, nlohmann::json&) {
        if (depth > most_deep)
            throw Error(ErrorCode::bad_input, origin, fmt::format("nested deeper than {} levels", most_deep));
        return true;
    };
    try {
        return nlohmann::json::parse(text, limited);
    } catch (const nlohmann::json::parse_error& error) {
        const std::size_t offset = std::min(text.size(), error.byte > 0 ? error.byte - 1 : 0);
        const auto end = text.begin() + static_cast<std::ptrdiff_t>(offset);
        const auto line = 1 + std::count(text.begin(), end, '\n');
        const std::size_t start = offset == 0 ? std::string::npos : text.rfind('\n', offset - 1);
        const std::size_t column = offset - (start == std::string::npos ? 0 : start + 1) + 1;
        throw Error(ErrorCode::bad_input, fmt::format("{}:{}:{}", origin, line, column),
                    offset >= text.size() ? "the file ends in the middle of its JSON: it was not written completely"
                                          : "is not JSON (which has no NaN or infinity)");
    } catch (const nlohmann::json::exception&) {
        throw Error(ErrorCode::bad_input, origin, "holds a number that is too large");
    }
}

nlohmann::json read_json(const fs::path& file) {
    return parse(base::read_text(file), file.string());
}

std::vector<fs::path> result_files(const fs::path& path) {
    std::error_code failed;
    if (!fs::exists(path, failed))
        throw Error(ErrorCode::no_such_file, path.string(), "there is no such file or folder");
    if (!fs::is_directory(path, failed)) return {path};
    std::vector<fs::path> files;
    fs::recursive_directory_iterator at(path, failed), end;
    for (; !failed && at != end; at.increment(failed)) {
        const std::string name = at->path().filename().string();
        std::error_code ignored;
        if (name.rfind(".", 0) == 0) {
            if (at->is_directory(ignored)) at.disable_recursion_pending();
        } else if (at->path().extension() == ".json" && at->is_regular_file(ignored)) {
            files.push_back(at->path());
        }
    }
    if (failed) throw Error(ErrorCode::io, path.string(), "cannot read the folder: " + failed.message());
    if (files.empty())
        throw Error(ErrorCode::bad_input, path.string(), "the folder holds no result.json or kernel file");
    std::sort(files.begin(), files.end());
    return files;
}

Measured read(const fs::path& path) {
    Measured measured;
    for (const fs::path& file : result_files(path)) {
        add(measured, read_json(file), file.string());
        measured.files.push_back(file.lexically_relative(path).string());
    }
    bool any = false;
    for (const Suite& suite : measured.suites) any = any || !suite.cells.empty();
    if (!any)
        throw Error(ErrorCode::bad_input, path.string(),
                    "holds no result of shadowbench run or of a kernel program (aggregates do not count)");
    measured.interleaved = interleaved_with(path);
    return measured;
}

}  // namespace shadowbench::compare
