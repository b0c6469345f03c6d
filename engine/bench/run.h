// Runs a scenario document and returns its result. Everything else in this folder is a step of this.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "bench/memory.h"
#include "bench/progress.h"
#include "bench/work.h"
#include "results/result.h"
#include "scene/scenario.h"

namespace shadowbench::bench {

struct RunOptions {
    scene::SearchPath data;
    std::vector<std::string> only;  // technique ids; empty: all
    int threads = 0;                // 0: all processors
    MemoryLimits limits;
    bool times = true;  // whether builds and lookups are timed; cells have no times otherwise
};

// Expands the document, then captures, checks and times every variant, light and technique. Throws Error: bad_input,
// no_such_file, io, or usage for `only`. A failed technique is not an error; its cell says so.
results::Result run(const nlohmann::json& document, const RunOptions& options, const ProgressCallback& progress);

struct Validated {
    std::string name;
    std::size_t variants = 0, lights = 0, techniques = 0;  // lights and techniques: of the first variant
    std::vector<std::string> blind;                        // lights that certainly see no caster
    std::vector<std::string> notes;                        // of the file readers: see scene::read_notes
    std::vector<std::string> files;                        // see scene::file_lines
    int largest_side = 0, most_samples = 0;                // of the maps: pixels; rays a pixel, including the truth's
    double least_bytes = 0.0;                              // of the variant that needs the most
    double seconds = 0.0;                                  // estimate for the whole run: see estimate.h
    double budget = 0.0;                                   // seconds that are asked for, on whatever machine
};

// Called with the first variant.
using FirstVariant = std::function<void(const VariantWork& variant)>;

// Makes all checks that run() makes before it works: the document, its files, what its lights see, the memory limit,
// and whether the techniques can take a deep image. The progress is that of loading.
Validated validate(const nlohmann::json& document, const RunOptions& options, const ProgressCallback& progress = {},
                   const FirstVariant& first = {});

}  // namespace shadowbench::bench
