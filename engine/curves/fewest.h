// Compression to the fewest vertices that a tolerance allows: the bound that other compressions are measured against.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <vector>

#include "curves/curve.h"
#include "curves/funnel.h"

namespace shadowbench::curves {

// FewestScratch::most_steps where only the number of vertices is wanted, of many functions: some thousandths of a
// second.
inline constexpr std::size_t steps_of_a_bound = std::size_t{1} << 18;

// The memory of compress_to_fewest(), reused from call to call; each thread has its own.
struct FewestScratch {
    static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

    // All vertices at one depth, and the values that the tolerance leaves there.
    struct Group {
        double z, before, after;  // of the input: the depth, and the values on both sides
        double low, high;         // of a value that serves on both sides; low > high if none does
        double front, behind;     // the greatest value on the near side; the least one on the far side
    };
    // Values that are reached behind a group, all between two ends.
    struct Piece {
        double low, high;
        std::size_t next;  // in `pieces`
    };
    // What is reached behind a group with its least number of vertices, and with one more.
    struct Reached {
        std::size_t vertices = 0;  // the least number; 0: nothing is reached
        std::array<std::size_t, 2> first{none, none};
    };
    struct Knot {
        std::size_t group;
        double value;
    };

    std::vector<Group> groups;
    std::vector<std::size_t> earliest;  // [n]: no group before this one can do with n more vertices
    std::vector<Reached> reached;       // for each group
    std::vector<Piece> pieces;
    std::vector<Knot> knots;
    std::vector<Vertex> plain;  // what compress() makes of the function
    Funnel funnel;
    std::size_t most_steps = std::size_t{1} << 24;  // the search gives up after so many
    bool complete = true;                           // false: in the last call it did

    std::size_t bytes() const;
};

// As compress() of compress.h, whose guarantees hold here too, apart from the last segment's aim and the costs: of all
// functions with these properties
//  - the exact first value of the input; values that do not increase and stay in [0, 1];
//  - within the tolerance of the input at every depth, on both sides of steps;
//  - vertices only at depths of the input,
// the output has the fewest vertices, and it ends as near to the exact last value as those allow. It steps only where
// the input does. Where compress() has no more, the output is the same as its output. Ties within 2^-46 of the first
// value count as within the tolerance.
//
// For n depths of which the output keeps k, about n times those that one segment spans, so O(n^2 / k) steps, and O(n)
// memory; far less where compress() is proven to have the fewest at once. After `most_steps`, some tenths of a second,
// the search gives up, and the output is that of compress(). That takes thousands of depths and few vertices.
std::size_t compress_to_fewest(CurveView curve, float tolerance, FewestScratch& scratch, Vertex* out);

Curve compress_to_fewest(CurveView curve, float tolerance);

}  // namespace shadowbench::curves
