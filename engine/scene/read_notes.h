// Notes of a reader, in words for people: what it passed over, clamped or reinterpreted without refusing the file.
#pragma once

#include <string>
#include <vector>

namespace shadowbench::scene {

// Each line is one kind of thing with its count: "1 of 4096 densities below 0 taken as 0, the least -1e-06". A line may
// quote the file, so show it through base::printable.
struct ReadNotes {
    std::vector<std::string> lines;
};

}  // namespace shadowbench::scene
