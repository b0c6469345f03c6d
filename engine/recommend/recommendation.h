// From a scenario and a request to the answer, and back from the file that keeps it.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "bench/progress.h"
#include "bench/run.h"
#include "recommend/answer.h"
#include "recommend/exploration.h"
#include "recommend/request.h"
#include "recommend/search.h"
#include "results/result.h"

namespace shadowbench::recommend {

// An exploration and what it was of.
struct Recommendation {
    std::string scenario, light;  // names
    Measure measure = Measure::rms;
    std::optional<double> footprint_share;  // see Trials::footprint_share
    Exploration exploration;
    std::optional<double> truth_error = {};  // its standard error (RMS), if lookups are judged against it
};

struct Watch {
    bench::ProgressCallback measuring;                                        // the truth, and the steps of confirming
    std::function<void(const Progress& progress, double seconds)> exploring;  // seconds: since explore() was called
};

struct Explored {
    Recommendation recommendation;
    results::Result result;  // of every setting measured
    std::size_t taken = 0;   // of them, those that an earlier exploration had measured in the folder of the trials
    std::size_t others = 0;  // files in that folder that do not count: of another question, program or machine
};

// Explores a scenario. `request.only` takes the place of that of the options. `trials`: a folder of trials that are not
// measured again, to which new ones are added (trial_files.h); empty: none. Throws what Trials and TrialFiles throw,
// and Error{usage}, place --budget, if the budget ends before anything is measured.
Explored explore(const nlohmann::json& document, const bench::RunOptions& options, const Request& request,
                 const Watch& watch, const std::filesystem::path& trials = {});

// result.json: the result, with the recommendation as one more member.
nlohmann::ordered_json to_json(const Explored& explored);

// Whether this is such a document, and not the result of a run.
bool is_recommendation(const nlohmann::json& document);

// Reads it again. Throws Error{bad_input}, place: `origin`, the name of its file, and the JSON pointer.
Recommendation recommendation_from_json(const nlohmann::json& document, const std::string& origin);

// The part of the scenario that gives this setting, and asks it the same question.
nlohmann::ordered_json part_of_scenario(const Recommendation& recommendation, const Point& point);

// The answer for programs, with the parts of the scenario. results/README.md describes it.
nlohmann::ordered_json answer_json(const Recommendation& recommendation, const Goal& goal);

struct AnswerText {
    std::string text;      // the scenario, and to_text()
    bool reached = false;  // whether a setting reaches the goal's error
};

// `goal` may be another than the exploration's. `width`: characters of a line. `again`: see Wording.
AnswerText answer_text(const Recommendation& recommendation, const Goal& goal, std::size_t width = text_columns,
                       const std::function<std::string(double)>& again = {});

}  // namespace shadowbench::recommend
