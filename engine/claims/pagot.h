// The parts of Pagot, Comba, Oliveira, Multiple-Depth Shadow Maps, 2004. Each adds its claims, tables and plots to
// context.report.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "claims/paper.h"

namespace shadowbench::claims::pagot {

inline constexpr const char* flat = "pagot2004_flat";
inline constexpr const char* curved = "pagot2004_curved";

// A kernel of side x side cells on n depths a cell; beside its own, 2-SM keeps the maximum of 3 x 3 cells, and 3-SM the
// maximum and the minimum.
struct Kernel {
    int n, side;

    bool operator==(const Kernel&) const = default;
};
std::string title(const Kernel& kernel);    // "3-SM with 2 x 2"
std::string request(const Kernel& kernel);  // as JSON of a scenario

// What selecting depths costs and what a fragment saves by it, and the fragments a cell from which on it pays.
struct Crossing {
    double selection, saved, fragments;
};
inline constexpr double never = 1e6;  // fragments a cell

// Of the straight line through differences in time, by least squares: those of the kernel on more depths less those of
// the other one, over the fragments a cell. At least two different numbers of fragments.
Crossing crossing_of(std::span<const std::pair<double, double>> differences);

// The fragments a cell of the crossings of several rounds, with their interval, measured in images of up to `most`. A
// crossing beyond them is not seen: then the interval begins at `most`, or before it, and ends at `never`.
Value crossing_within(const std::vector<Crossing>& crossings, double most);

void pictures(const Context& context);  // figures 1, 6 and 7
void crossing(const Context& context);  // section 6, equations 5 and 6
void costs(const Context& context);     // sections 4.3, 4.4 and 6

}  // namespace shadowbench::claims::pagot
