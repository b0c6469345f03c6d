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

}  // namespace shadowbench::bench
