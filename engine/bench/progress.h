// How far a run is. The engine never prints: whoever starts a run may watch it.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace shadowbench::bench {

struct Progress {
    std::string place;  // which variant and light: "2/5 key"; empty when there is one of each
    const char* stage;  // "capture", "build", ...
    std::size_t done = 0, total = 0;
};

// Called on the thread that runs, between pieces of work. An exception thrown from it ends the run.
using ProgressCallback = std::function<void(const Progress&)>;

}  // namespace shadowbench::bench
