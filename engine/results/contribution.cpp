#include "results/contribution.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "results/merge_cells.h"
#include "results/report.h"
#include "results/settled.h"

namespace shadowbench::results {
namespace {

bool is_machine_name(const std::string& name) {
    return !name.empty() && name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-") == std::string::npos;
}

nlohmann::json without_timing(nlohmann::json scenario) {
    scenario.erase("timing");
    return scenario;
}

// Whether a cell that did not fail has all its times.
bool is_timed(const Cell& cell) {
    return cell.status == CellStatus::failed ||
           (cell.times && cell.times->random_order.ns.raw.size() >= least_repetitions &&
            cell.times->image_order.ns.raw.size() >= least_repetitions);
}

void add_untimed(const Result& result, std::vector<std::string>& faults) {
    for (const VariantResult& variant : result.variants)
        for (const LightResult& light : variant.lights)
            for (const Cell& cell : light.cells)
                if (!is_timed(cell))
                    faults.push_back(fmt::format("light {}, {}: it has fewer than {} times", light.name, title(cell),
                                                 least_repetitions));
}

}  // namespace

std::vector<std::string> contribution_faults(const nlohmann::json& result, const nlohmann::json& baseline,
                                             const std::string& name, const std::string& date,
                                             const std::string& origin) {
    const Result read = from_json(result, origin);
    std::vector<std::string> faults;
    if (!is_machine_name(name))
        faults.push_back("the name of its folder must have small letters, digits and hyphens only");
    if (read.times.started.substr(0, read.times.started.find('T')) != date)
        faults.push_back(fmt::format("its file must be named after the day of the run, {}", read.times.started));
    if (read.machine.cpu.empty() || read.machine.cpu == several_machines || read.machine.logical_cores < 1)
        faults.push_back("it does not state its one machine");
    if (!read.only.empty()) faults.push_back("it is limited to some techniques (--only)");
    if (read.program.build_type != "Release")
        faults.push_back(fmt::format("it is of a {} build, not of a Release build", read.program.build_type));
    const nlohmann::json scenario = nlohmann::json::parse(read.document);
    if (without_timing(scenario) != without_timing(baseline.at("scenario"))) {
        faults.push_back("its scenario is not that of the baseline; change only its timing");
        return faults;
    }
    add_untimed(read, faults);
    if (const auto found = portable_disagreement(to_json(read), to_json(from_json(baseline, "baseline"))))
        faults.push_back(fmt::format("{} is {}, but {} in the baseline", found->measure, found->one, found->other));
    return faults;
}

}  // namespace shadowbench::results
