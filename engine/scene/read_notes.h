// What a reader passed over, clamped or took for something else without refusing the file, in words for people.
#pragma once

#include <string>
#include <vector>

namespace shadowbench::scene {

// Each line is one kind of thing with its count: "1 of 4096 densities below 0 taken as 0, the least -1e-06". A line may
// quote the file: show it through base::printable.
struct ReadNotes {
    std::vector<std::string> lines;
};

}  // namespace shadowbench::scene
