// What becomes of measured scenarios, for run and merge: their folders, and the verdicts over all of them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "results/report_verdicts.h"
#include "service/cli/output.h"

namespace shadowbench::service {

// The folder of a scenario's results. `out`: the folder that was asked for; empty: results/runs. Each of several
// scenarios has a folder of its name there; so has a single one in results/runs.
std::filesystem::path results_folder(const std::string& out, bool several, const nlohmann::json& document);

// The file of the verdicts; empty: none.
std::filesystem::path verdicts_file(const std::string& given, const std::string& out, bool several);

// The outcome of a scenario that has no result.
results::ScenarioOutcome without_result(const nlohmann::json& document, const std::string& why);

// Prints the verdicts over several scenarios, writes them to a file if it is not empty, and says which times are
// unsettled.
void report_outcomes(const std::vector<results::ScenarioOutcome>& outcomes, bool several,
                     const std::filesystem::path& verdicts, Output& output);

// What is to be said of the pictures of a result.
struct PicturesSaid {
    std::string fault;    // why they could not be drawn now; empty: they were, or nobody asked
    std::string command;  // that draws them; empty: none can, or it is not known
};

// Prints what the table of a result means, which files hold it, and in the last line where its pictures are: those in
// the folder or those of render, if they show this scenario, else what is to be said of them.
void conclude(const results::Result& result, const std::filesystem::path& folder, const PicturesSaid& said,
              Output& output);

}  // namespace shadowbench::service
