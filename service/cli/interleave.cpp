#include "service/cli/interleave.h"

#include <algorithm>
#include <map>
#include <sstream>
#include <tuple>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/read_text.h"
#include "base/temporary_folder.h"
#include "base/write_files.h"
#include "results/write_result.h"
#include "service/cli/child.h"
#include "service/cli/progress_bar.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;
using base::Error;
using base::ErrorCode;

// The last line that a process wrote. That is its error if it failed.
std::string last_line(const fs::path& log) {
    std::istringstream text(base::read_text(log));
    std::string last;
    for (std::string line; std::getline(text, line);)
        if (!line.empty()) last = line;
    const std::string own = "shadowbench: ";
    return last.rfind(own, 0) == 0 ? last.substr(own.size()) : last;
}

ErrorCode code_of_child(int code) {
    for (const ErrorCode known : {ErrorCode::usage, ErrorCode::bad_input, ErrorCode::no_such_file, ErrorCode::io})
        if (code == static_cast<int>(known)) return known;
    return ErrorCode::internal;
}

void run_once(const Turns& turns, bool is_b, int pair, const fs::path& folder) {
    const std::string& program = is_b ? turns.binary_b : turns.binary_a;
    const fs::path place = folder / (is_b ? "b" : "a") / fmt::format("{:04}", pair + 1);
    const fs::path log = folder / "log.txt";
    std::vector<std::string> arguments = turns.arguments;
    const fs::path result = turns.kernels ? fs::path(place.string() + ".json") : place / "result.json";
    if (turns.kernels) {
        arguments.push_back("--benchmark_out=" + result.string());
        arguments.push_back("--benchmark_out_format=json");
    } else {
        arguments.insert(arguments.end(), {"--out", place.string()});
    }
    const int code = run_child(program, arguments, log);
    constexpr int promise_broken = 2;  // it wrote a result
    const bool written = fs::exists(result);
    if (code != 0 && !(code == promise_broken && written))
        throw Error(code_of_child(code), fmt::format("{} ({}), exit code {}", program, is_b ? "B" : "A", code),
                    last_line(log));
    if (!written) throw Error(ErrorCode::internal, program, "ended with exit code 0 but wrote no result");
    if (turns.kernels && fs::file_size(result) == 0)  // Google Benchmark reports wrong filters so
        throw Error(ErrorCode::usage, program + " --kernels", last_line(log));
}

// The scenario of a result.json, as a file: older builds cannot run a result.json.
std::string scenario_of(const std::string& source, const fs::path& folder) {
    std::error_code failed;
    if (!fs::is_regular_file(source, failed)) return source;
    const nlohmann::json document = compare::read_json(source);
    if (!document.is_object() || !document.contains("scenario_hash") || !document.contains("scenario")) return source;
    const fs::path file = folder / "scenario.json";
    base::write_files({{file, document.at("scenario").dump()}});
    return file.string();
}

}  // namespace

void run_turns(const Turns& turns, const fs::path& folder, std::ostream& err) {
    check_program(turns.binary_a);
    check_program(turns.binary_b);
    for (const char* side : {"a", "b"})
        if (fs::exists(folder / side))
            throw Error(ErrorCode::usage, (folder / side).string(),
                        "already exists; choose a new folder, so that results do not mix");
    std::error_code failed;
    for (const char* side : {"a", "b"}) {
        fs::create_directories(folder / side, failed);
        if (failed) throw Error(ErrorCode::io, folder.string(), "cannot make the folder: " + failed.message());
    }
    ProgressBar bar(err);
    const auto total = static_cast<std::size_t>(turns.pairs) * 2;
    for (int pair = 0; pair < turns.pairs; ++pair)
        for (const bool second : {false, true}) {
            const bool is_b = second == (pair % 2 == 0);  // A and B take turns to go first
            bar.show({fmt::format("{} pair {}/{}", turns.what, pair + 1, turns.pairs), is_b ? "B" : "A",
                      static_cast<std::size_t>(pair) * 2 + second, total});
            run_once(turns, is_b, pair, folder);
        }
    fs::remove(folder / "log.txt", failed);
    base::write_files({{folder / compare::interleaved_mark, fmt::format("{{\"pairs\": {}}}\n", turns.pairs)}});
}

compare::Comparison compare_turns(const Turns& turns, const fs::path& folder, const compare::Options& options) {
    compare::Comparison comparison =
        compare::compare(compare::read(folder / "a"), compare::read(folder / "b"), options);
    comparison.baseline = turns.binary_a;
    comparison.current = turns.binary_b;
    return comparison;
}

void confirm_with_turns(compare::Comparison& first, Turns turns, const compare::Options& options, std::ostream& err) {
    // Cells that one process can run together. They come from one result, and so from one suite.
    struct Group {
        std::string suite;
        std::map<std::string, compare::Rerun> cells;
    };
    std::map<std::tuple<std::string, std::string, std::string>, Group> groups;
    for (const compare::Line& line : compare::suspicious(first)) {
        if (line.rerun.kernel != turns.kernels) continue;
        const std::string source = line.rerun.kernel ? "" : line.rerun.source;
        const std::string only = line.rerun.technique.empty() ? line.rerun.only : "";
        Group& group = groups[{source, line.rerun.sweeps, only}];
        group.suite = line.suite;
        group.cells[line.cell] = line.rerun;
    }
    // compare() corrects for the cells of one group (Holm); Bonferroni's correction covers all groups.
    compare::Options each = options;
    each.alpha /= static_cast<double>(std::max<std::size_t>(groups.size(), 1));
    compare::Comparison again;
    again.interleaved = true;
    int count = 0;
    for (const auto& [key, group] : groups) {
        const base::TemporaryFolder folder;
        std::vector<compare::Rerun> reruns;
        for (const auto& [name, rerun] : group.cells) reruns.push_back(rerun);
        if (!turns.kernels) reruns[0].source = scenario_of(reruns[0].source, folder.path());
        turns.arguments = compare::arguments_of(reruns);
        turns.what = fmt::format("confirming {}/{}", ++count, groups.size());
        run_turns(turns, folder.path(), err);
        compare::Comparison fresh = compare_turns(turns, folder.path(), each);
        again.enough = std::max(again.enough, fresh.enough);
        for (compare::Line& line : fresh.lines) {
            line.suite = group.suite;  // its name may carry a hash that tells it apart
            again.lines.push_back(std::move(line));
        }
    }
    compare::confirm(first, again);
}

}  // namespace shadowbench::service
