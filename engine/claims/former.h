// The verdicts of the first report (2026-11-23) that were not "holds", and what became of them.
#pragma once

#include <span>
#include <string>

#include "claims/claim.h"

namespace shadowbench::claims {

struct Former {
    const char* paper;     // its id
    const char* place;     // how the place begins, then and now
    const char* claim;     // in few words
    const char* verdict;   // then
    const char* measured;  // then
    const char* now;       // how the claim begins that answers it in today's report
    const char* why;       // what is different in the experiment or the rule
};
std::span<const Former> former_verdicts();

// The table of those that belong to these reports, with today's verdicts; empty if there are none. Throws
// Error{internal} if a report has no claim, or several, that begin as a row says.
std::string former_table(std::span<const PaperReport> reports);

}  // namespace shadowbench::claims
