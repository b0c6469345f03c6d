// Reads the options that compare and ab share, and reports their verdicts.
#pragma once

#include <iosfwd>

#include "compare/compare.h"
#include "service/cli/gate_commands.h"

namespace shadowbench::service {

// Throws Error{usage} for a wrong --tolerance, and for two reports with the same file.
compare::Options verdict_options(const VerdictArguments& arguments);

// Prints and writes the reports that the arguments ask for and returns the exit code. Throws Error{usage} for a
// tolerance of a measure that no cell has, {io}.
int report_verdict(const compare::Comparison& comparison, const VerdictArguments& arguments, std::ostream& out);

}  // namespace shadowbench::service
