// Writes reports of papers to files.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "claims/claim.h"

namespace shadowbench::claims {

struct Conditions {
    bool quick = false;
    std::string machine, build, date;
    std::string beside = {};  // the full report that a quick one stands beside, in words: see quick.h
};

// "The host took 0.4 % of the time": the line below the machine's. It names the papers during whose measurement the
// host took more than results::steal_limit. Empty if nothing is known.
std::string steal_line(std::span<const PaperReport> reports);

// The rule of the verdicts, then for each paper a row for each claim, its tables and its plots.
std::string to_markdown(std::span<const PaperReport> reports, const Conditions& conditions);
std::string to_json(std::span<const PaperReport> reports, const Conditions& conditions);

// The SVG text of a plot, drawn by gnuplot. Throws Error{internal} if gnuplot is missing or fails.
std::string to_svg(const Plot& plot);

// Writes <name>.md and <name>.json into this folder, the plots as SVG into its folder plots/, and the sheets into
// pictures/. Throws Error{io}.
void write_reports(const std::filesystem::path& folder, const std::string& name, std::span<const PaperReport> reports,
                   const Conditions& conditions);

}  // namespace shadowbench::claims
