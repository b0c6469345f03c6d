// Results that others measured on their machines, and send to be kept: results/machines/<name>/<date>.json.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace shadowbench::results {

// What keeps a result from being added, in words; empty if nothing does. It must be the whole of a run, with times of
// all techniques and the machine that took them, of the scenario of a portable baseline (portable.h) apart from its
// timing, and agree with it in every exact measure. `name` and `date` are those of its file. Throws Error{bad_input},
// place: `origin`, for what is no result.
std::vector<std::string> contribution_faults(const nlohmann::json& result, const nlohmann::json& baseline,
                                             const std::string& name, const std::string& date,
                                             const std::string& origin);

}  // namespace shadowbench::results
