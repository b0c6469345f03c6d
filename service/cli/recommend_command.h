// The command that finds the cheapest settings at an error.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "service/cli/commands.h"

namespace shadowbench::service {

struct RecommendArguments : ScenarioArguments {
    double error = 0.0;
    std::string measure = "rms";                 // rms, max, p99 or curve
    bool measure_given = false;
    std::vector<std::string> cheapest, at_most;  // costs, all if none is given; cost=limit
    std::string budget = "5min";
    std::string light;  // a name, or a number, from 0; empty: the only one
    std::string out;    // folder; empty: results/recommendations/<scenario name>
    std::string from;   // folder of an earlier exploration or run; empty: explore SCENARIO
    std::string beside;  // folder of another, to compare that one with; empty: none
};

// Returns whether a setting reaches the error.
bool recommend_command(const RecommendArguments& arguments, std::ostream& out, std::ostream& err);

}  // namespace shadowbench::service
