// Measures a scenario document in cells, of which each is one variant with one light: what run() measures at once.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "base/parallel.h"
#include "bench/progress.h"
#include "bench/run.h"
#include "bench/variant_runs.h"
#include "results/sweep_cell.h"

namespace shadowbench::bench {

struct CellOfDocument {
    results::CellPlace place;
    std::string title;  // "quickstart /rays/resolution=64 light key"
};

// All cells, in the order in which run() measures them. Reads no data files. Throws Error: bad_input, or usage for
// `only`.
std::vector<CellOfDocument> cells_of(const nlohmann::json& document, const std::vector<std::string>& only);

// While it lives, parallel loops have the threads of its options.
class CellRunner {
public:
    // Throws what cells_of() throws.
    CellRunner(const nlohmann::json& document, const RunOptions& options);

    // The same measures as those of run() for this variant and light, times aside. A cell of the variant before does
    // not load its scene again. Throws what run() throws; then other cells can still be measured.
    results::SweepCell measure(const results::CellPlace& place, const ProgressCallback& progress);

private:
    base::ThreadLimit threads_;
    VariantRuns runs_;
    const scene::Scenario* scenario_ = nullptr;
    std::optional<std::size_t> loaded_;  // the variant
    std::vector<std::string> notes_;     // on it
};

}  // namespace shadowbench::bench
