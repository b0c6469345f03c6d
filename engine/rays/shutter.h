// Chooses the time at which each ray of a pixel sees the scene, and permutes strata. Internal to light_rays.cpp.
//
// A pixel of s x n sample cells, s <= n, has N = s n rays, one in each of N equal parts of the shutter. A Latin square,
// an orthogonal array of strength 2 (Owen, Orthogonal Arrays for Computer Experiments, Integration and Visualization,
// 1992), deals the parts out, so that positions and times are stratified together:
//  - Each column of cells has one ray in each of the n long stretches of s parts. Column number k and row number r get
//    the stretch (floor(k n / s) + r) modulo n, so the s rays of a row are n / s stretches apart, rounded: for s = n
//    there is one in each stretch too.
//  - k and r are the column and row permuted by `scatter`: neighbouring cells are far apart in time, and any 2^l
//    neighbouring cells of a column lie in different ones of 2^l equal parts of the shutter, rounded and rotated.
//  - The s rays of one stretch, one of each column, take its parts in the order of their k, rotated at random.
// Every cell has its ray in every part with the same probability, so no mean over the shutter is biased.
#pragma once

#include <cstdint>

namespace shadowbench::rays {

// The position of `index` in a permutation of [0, count): the radical inverse, extended to any count by repeated
// halving (even numbers go to one half, odd ones to the other), scrambled by choosing at random which half comes first
// (Owen, Randomly Permuted (t, m, s)-Nets and (t, s)-Sequences, 1995) and rotated. Every position is equally likely.
// O(log count).
std::uint32_t scatter(std::uint32_t index, std::uint32_t count, std::uint64_t key);

// Which of samples_x * samples_y equal parts of the shutter the ray in cell (column, row) of a pixel has.
std::uint32_t shutter_part(int samples_x, int samples_y, int column, int row, std::uint64_t key);

}  // namespace shadowbench::rays
