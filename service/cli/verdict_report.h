// What compare and ab share: options in, a report out.
#pragma once

#include <iosfwd>

#include "compare/compare.h"
#include "service/cli/gate_commands.h"

namespace shadowbench::service {

// Throws Error{usage}.
compare::Options verdict_options(const VerdictArguments& arguments);

// Prints and writes what was asked for; the exit code. Throws Error{usage} for a tolerance of a measure that nothing
// has, {io}.
int report_verdict(const compare::Comparison& comparison, const VerdictArguments& arguments, std::ostream& out);

}  // namespace shadowbench::service
