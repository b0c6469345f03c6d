// Finds, for every cost asked, the cheapest setting whose error is at most the one asked, with few measurements.
//
// 1. Every family climbs from its cheapest to its most accurate setting, all axes together, by coarse steps, until it
//    reaches the error or gets no better. All families meet the same light rays on the way. This gives each technique's
//    curve of cost against error, and the first settings that are good enough.
//    A faithful family then probes light rays to both sides of the climbs, and families with several axes of their own
//    probe each of these.
// 2. A model of each family (kriging of the logarithms: constrained expected improvement after Schonlau, Welch and Jones
//    1998) says where a cheaper setting may be good enough. The point with the most expected gain for its effort is
//    measured next, first among points that are coarse steps apart, then among all, until no point is left that has a
//    chance and is worth its effort. Bounds from measured points rule out the rest: see knowledge.h. The neighbours of
//    the best settings are measured in any case, and so are its variants with other words of the technique.
// 3. The lookups that trials hardly tell from the fastest are timed again, in turns.
// 4. The best settings, those within noise of them, and the runner-up of another technique are confirmed together. If
//    one turns out to err too much, step 2 goes on with what was learned.
#pragma once

#include <cstddef>
#include <functional>

#include "recommend/exploration.h"
#include "recommend/lab.h"

namespace shadowbench::recommend {

enum class Stage { climbing, refining, confirming };

struct Progress {
    Stage stage = Stage::climbing;
    std::size_t measured = 0;
    std::size_t open = 0;  // families that climb, points that have a chance, or points that are being confirmed
};

struct Hooks {
    std::function<double()> seconds;                // of the budget that are spent; needed only if there is a budget
    std::function<void(const Progress&)> progress;  // may be empty
    std::function<bool()> cancelled;                // may be empty; asked before every measurement
};

// Throws Error usage if no cost is asked, or none that techniques without a map have where all are such, or if the error
// or the budget is not above 0.
Exploration explore(Lab& lab, const Goal& goal, const Hooks& hooks);

}  // namespace shadowbench::recommend
