// Two answers to the same question, held beside each other: the settings of both are measured again, in turns, by one
// program on one machine.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "bench/progress.h"
#include "bench/run.h"
#include "recommend/recommendation.h"

namespace shadowbench::recommend {

// The cheapest setting of one answer.
struct Rival {
    std::string text;      // as setting_text()
    std::string part;      // of a scenario, JSON: the same for the same setting
    Confirmed measured = {};  // anew
};

// One cost that is asked for, and that at least one answer has a setting for.
struct Contest {
    Cost cost = Cost::lookup;
    std::optional<Rival> ours, theirs;
    // Of both: our cost over theirs. Of lookups the 95 % interval of the median over rounds, each of which times both; else
    // from the two costs' intervals.
    std::optional<metrics::Interval> ratio;
};

// `document`: the scenario that our answer is of. Both answers must be of the same scene, light and receivers, and of
// footprints of the same size, and judged by the same measure; other keys may differ. `seconds`: about how long the measurement may take. Throws
// Error{bad_input}, place: the part of the scenario that differs, or of the setting that cannot be measured.
std::vector<Contest> hold_beside(const nlohmann::json& document, const bench::RunOptions& options,
                                 const Recommendation& ours, const nlohmann::json& their_document,
                                 const Recommendation& theirs, const Goal& goal, double seconds,
                                 const bench::ProgressCallback& progress);

// A few lines for each contest.
std::string to_text(const std::vector<Contest>& contests, const std::string& measure, double error);

}  // namespace shadowbench::recommend
