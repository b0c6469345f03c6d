#include <filesystem>
#include <ostream>

#include <fmt/format.h>

#include "base/error.h"
#include "base/temporary_folder.h"
#include "compare/compare.h"
#include "service/cli/child.h"
#include "service/cli/gate_commands.h"
#include "service/cli/interleave.h"
#include "service/cli/verdict_report.h"

namespace shadowbench::service {
namespace {

using base::Error;
using base::ErrorCode;

// The arguments of every run: "--set x --data y" of a scenario, "--benchmark_min_time=s" of kernels.
std::vector<std::string> run_options(const AbArguments& arguments) {
    if (!arguments.kernels.empty()) return {fmt::format("--benchmark_min_time={}", arguments.min_time)};
    std::vector<std::string> words;
    for (const std::string& assignment : arguments.set) words.insert(words.end(), {"--set", assignment});
    for (const std::string& folder : arguments.data) words.insert(words.end(), {"--data", folder});
    return words;
}

Turns turns_of(const AbArguments& arguments) {
    Turns turns{arguments.binary_a, arguments.binary_b, {}, !arguments.kernels.empty(), arguments.pairs, ""};
    if (turns.kernels == !arguments.scenario.empty())
        throw Error(ErrorCode::usage, "ab", "give a SCENARIO or --kernels, one of the two");
    if (turns.kernels)
        turns.arguments = {"--benchmark_filter=" + arguments.kernels};
    else
        turns.arguments = {"run", arguments.scenario};
    for (const std::string& word : run_options(arguments)) turns.arguments.push_back(word);
    for (const std::string& only : arguments.only) turns.arguments.insert(turns.arguments.end(), {"--only", only});
    return turns;
}

// The command in the report must name the scenario: the temporary results are deleted.
void name_the_source(compare::Comparison& comparison, const AbArguments& arguments) {
    for (compare::Line& line : comparison.lines) {
        if (line.rerun.source.empty()) continue;
        line.rerun.program = arguments.binary_b;
        line.rerun.given = run_options(arguments);
        if (!line.rerun.kernel) line.rerun.source = arguments.scenario;
    }
}

}  // namespace

int ab_command(const AbArguments& arguments, std::ostream& out, std::ostream& err) {
    const compare::Options options = verdict_options(arguments);
    Turns turns = turns_of(arguments);
    const EndingSignals signals;
    const base::TemporaryFolder temporary;
    const std::filesystem::path folder =
        arguments.out.empty() ? temporary.path() : std::filesystem::path(arguments.out);
    run_turns(turns, folder, err);
    compare::Comparison comparison = compare_turns(turns, folder, options);
    name_the_source(comparison, arguments);
    if (arguments.confirm && !compare::suspicious(comparison).empty()) {
        turns.pairs *= 2;
        confirm_with_turns(comparison, turns, options, err);
        name_the_source(comparison, arguments);
    }
    return report_verdict(comparison, arguments, out);
}

}  // namespace shadowbench::service
