// A first look, at smaller sizes, beside the full report: it may say less, but nothing else.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <string>

#include "claims/claim.h"

namespace shadowbench::claims {

using ClaimKey = std::array<std::string, 3>;  // the id of its paper, its place, and what it says

struct FullReport {
    std::string date;
    std::map<ClaimKey, std::string> verdicts;  // in words
};

// Reads what to_json() wrote. Throws Error, place the file: bad_input if it is something else, and what reading throws.
FullReport read_full_report(const std::filesystem::path& file);

// Sets every verdict of a quick report that is not that of the full one to undecided. Its reason then says so, or that
// the full report has no such claim.
void stand_beside(const FullReport& full, PaperReport& quick);

}  // namespace shadowbench::claims
