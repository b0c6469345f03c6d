// Reports of papers -> files.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "claims/claim.h"

namespace shadowbench::claims {

struct Conditions {
    bool quick = false;
    std::string machine, build, date;
};

// How the verdicts are given, then for each paper a row a claim, its tables and its plots.
std::string to_markdown(std::span<const PaperReport> reports, const Conditions& conditions);
std::string to_json(std::span<const PaperReport> reports, const Conditions& conditions);

// SVG text of a plot, drawn by gnuplot. Throws Error{internal} when gnuplot is not there or refuses.
std::string to_svg(const Plot& plot);

// <name>.md and <name>.json in this folder, the plots as SVG in its folder plots/, and the sheets in pictures/. Throws
// Error{io}.
void write_reports(const std::filesystem::path& folder, const std::string& name, std::span<const PaperReport> reports,
                   const Conditions& conditions);

}  // namespace shadowbench::claims
