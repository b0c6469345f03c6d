// What an exploration is asked, and what it found: plain values, so that they can be written and read back.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "recommend/lab.h"

namespace shadowbench::recommend {

// The error that a setting is judged by: of lookups against the truth, or the largest of the stored functions against
// their own light rays.
enum class Measure { rms, max, p99, curve };

struct Goal {
    double error = 0.0;                           // above 0; a setting is wanted whose error is at most this
    std::array<bool, costs> asked{true, true, true};  // the costs of which each is to be the least
    std::array<double, costs> at_most{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
                                      std::numeric_limits<double>::infinity()};
    double budget = std::numeric_limits<double>::infinity();  // seconds
};

struct Measured {
    Point point;
    Trial trial;
};

struct Answered {
    Point point;
    Confirmed confirmed;
};

enum class End {
    complete,
    budget,
    cancelled,
    given,  // nothing was searched: the points are those of a run
};

// What a budget left undone.
struct NextStep {
    double seconds = 0.0;  // that measuring it and confirming what is then the best would have taken
    double left = 0.0;     // of the budget at the end, which are fewer
};

struct Exploration {
    Goal goal;
    std::vector<Family> families;
    std::optional<std::size_t> scout;
    std::vector<Measured> measured;   // in the order of measuring, each point once
    std::vector<Answered> confirmed;  // each point once
    End end = End::complete;
    // Seconds that the host of a virtual machine took from all processors, over those that it took in all; absent if
    // unknown.
    std::optional<double> steal = {};
    double before = 0.0;                // seconds of the budget that were spent before: those of the truth
    std::optional<NextStep> next = {};  // if the budget ended with time left
};

}  // namespace shadowbench::recommend
