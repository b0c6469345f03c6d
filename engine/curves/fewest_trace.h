// Shared by the search for the fewest vertices and by what chooses their values. Internal to fewest.cpp and
// fewest_trace.cpp.
#pragma once

#include <cstddef>

#include "curves/fewest.h"

namespace shadowbench::curves::fewest {

using Group = FewestScratch::Group;
using Knot = FewestScratch::Knot;
using Piece = FewestScratch::Piece;
using Reached = FewestScratch::Reached;
inline constexpr std::size_t none = FewestScratch::none;

// What the search is given.
struct Problem {
    double epsilon = 0.0, start = 0.0;  // the tolerance; the first value
    double slack = 0.0;                 // by which windows are wider than the tolerance
    std::size_t flat = 0;               // the last group whose front the function may reach level
    std::size_t budget = 0;             // vertices in all
};

// Whether two vertices may lie there.
inline bool has_step(const Group& group) {
    return group.after < group.before;
}

// No group before this one can do with so few more vertices.
inline std::size_t earliest(const FewestScratch& s, std::size_t vertices) {
    return vertices < s.earliest.size() ? s.earliest[vertices] : 0;
}

// The list of what is reached behind a group with so many vertices.
inline std::size_t first_piece(const FewestScratch& s, std::size_t vertices, std::size_t group) {
    const Reached& at = s.reached[group];
    return at.vertices != 0 && vertices - at.vertices <= 1 ? at.first[vertices - at.vertices] : none;
}

// Goes back from the last of so many vertices and writes them all to s.knots. Returns false if none fit, which only
// rounding could do.
bool trace(FewestScratch& s, const Problem& problem, std::size_t vertices, const Knot& last);

}  // namespace shadowbench::curves::fewest
