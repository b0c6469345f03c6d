#include "bench/result.h"

#include <utility>

namespace shadowbench::bench {

Sample summarise(std::vector<double> raw) {
    Sample sample;
    if (raw.empty()) return sample;
    sample.raw = std::move(raw);
    sample.median = metrics::median(sample.raw);
    sample.interval = metrics::median_interval(sample.raw);
    return sample;
}

bool any_failed(const Result& result) {
    for (const VariantResult& variant : result.variants)
        for (const LightResult& light : variant.lights)
            for (const Cell& cell : light.cells)
                if (cell.status == CellStatus::failed) return true;
    return false;
}

}  // namespace shadowbench::bench
