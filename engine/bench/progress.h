// The progress of a run. The engine never prints; the caller may pass a callback.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace shadowbench::bench {

struct Progress {
    std::string place;  // variant and light: "2/5 key"; empty if there is one of each
    const char* stage;  // "capture", "build", ...
    std::size_t done = 0, total = 0;
};

// Called between pieces of work, on the thread that runs. An exception from it ends the run.
using ProgressCallback = std::function<void(const Progress&)>;

}  // namespace shadowbench::bench
