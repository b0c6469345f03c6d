#include <ostream>

#include "base/error.h"
#include "compare/compare.h"
#include "service/cli/child.h"
#include "service/cli/gate_commands.h"
#include "service/cli/interleave.h"
#include "service/cli/this_program.h"
#include "service/cli/verdict_report.h"

namespace shadowbench::service {

int compare_command(const CompareArguments& arguments, std::ostream& out, std::ostream& err) {
    const compare::Options options = verdict_options(arguments);
    if (arguments.confirm && arguments.binary_a.empty())
        throw base::Error(base::ErrorCode::usage, "--confirm",
                          "needs --binary-a, the build of BASELINE: fresh processes beside old ones would differ by "
                          "the time that lies between them");
    compare::Comparison comparison =
        compare::compare(compare::read(arguments.baseline), compare::read(arguments.current), options);
    comparison.baseline = arguments.baseline;
    comparison.current = arguments.current;
    const std::vector<compare::Line> suspects = compare::suspicious(comparison);
    if (arguments.confirm && !suspects.empty()) {
        for (compare::Line& line : comparison.lines) {
            if (line.rerun.kernel) continue;
            for (const std::string& folder : arguments.data)
                line.rerun.given.insert(line.rerun.given.end(), {"--data", folder});
        }
        const EndingSignals signals;
        Turns turns;
        turns.binary_a = arguments.binary_a;
        turns.binary_b = arguments.binary_b.empty() ? this_program() : arguments.binary_b;
        turns.pairs = arguments.pairs;
        // Programs of one kind: those of the scenarios where there are any.
        turns.kernels = suspects[0].rerun.kernel;
        for (const compare::Line& line : suspects) turns.kernels = turns.kernels && line.rerun.kernel;
        confirm_with_turns(comparison, turns, options, err);
    }
    return report_verdict(comparison, arguments, out);
}

}  // namespace shadowbench::service
