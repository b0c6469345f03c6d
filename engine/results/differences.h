// How far the cells of one light differ: the intervals on which fronts and the words about a result rest. fronts.h says
// what they count.
#pragma once

#include <cstddef>
#include <vector>

#include "metrics/interval_front.h"
#include "results/result.h"

namespace shadowbench::results {

// The cells that a front may hold: not failed, and with a lookup error. `timed`: with times too.
std::vector<std::size_t> comparable(const LightResult& light, bool timed);

// Whether the machine was quiet enough for times to be compared.
bool times_count(const LightResult& light);

class Differences {
public:
    // `cells`: numbers of cells of the light, which must outlive this. All intervals hold together with
    // front_confidence.
    Differences(const LightResult& light, std::vector<std::size_t> cells);

    std::size_t size() const { return cells_.size(); }
    const Cell& cell(std::size_t i) const;

    // Of (choice a) - (choice b): of the mean squares of the errors, of the bytes, and of the logarithms of the times.
    // Without end where nothing is known; {0, 0} if both are equal.
    metrics::Interval errors(std::size_t a, std::size_t b) const;
    metrics::Interval bytes(std::size_t a, std::size_t b) const;
    metrics::Interval times(std::size_t a, std::size_t b) const;

    // The mean over the seeds of the rays.
    double mean_bytes(std::size_t i) const;

private:
    const LightResult& light_;
    std::vector<std::size_t> cells_;
    double tail_;
    std::vector<std::vector<double>> errors_, bytes_;  // seed by seed
    std::vector<bool> certain_;                        // of other rays
};

}  // namespace shadowbench::results
