// What is asked of an exploration, in the words of the command line and of a request to the service.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "base/error.h"
#include "recommend/exploration.h"

namespace shadowbench::recommend {

// The words of the costs and of the measures, in the order of their enums.
inline constexpr const char* cost_words[costs] = {"lookup", "bytes", "build"};
inline constexpr const char* measure_words[] = {"rms", "max", "p99", "curve"};
inline constexpr double least_error = 1e-6, most_error = 1.0;  // that can be asked for
inline constexpr double usual_budget = 300.0;                  // seconds

// The goal's budget is finite.
struct Request {
    Goal goal;
    Measure measure = Measure::rms;
    std::string light;              // a name, or a number, from 0 on; empty: the only light
    std::vector<std::string> only;  // ids of techniques; empty: all
};

// Reads
//   {"error": 0.02, "measure": "rms", "cheapest": ["lookup", "bytes", "build"], "at_most": {"bytes": 4194304},
//    "budget": 300, "light": "key", "only": ["deep"]}
// Only "error" is required; "cheapest" may also be one cost, or "all". Limits are in ns, bytes and ms, the budget in
// seconds. Every fault is added to `faults` as Error{bad_input}, place: `where` and the JSON pointer from there.
Request read_request(const nlohmann::json& request, const std::string& where, std::vector<base::Error>& faults);

// With the default values written out. Requests that ask the same have the same text.
nlohmann::json to_json(const Request& request);

}  // namespace shadowbench::recommend
