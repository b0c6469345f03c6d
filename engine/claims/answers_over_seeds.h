// Errors that are expected over seeds of the light rays: for maps that no run measures, as error_of() is for its cells.
#pragma once

#include <span>
#include <vector>

#include "bench/reference.h"
#include "claims/value.h"
#include "metrics/expected_error.h"

namespace shadowbench::claims {

// What a map answers with each seed, against one truth, which must outlive it.
class AnswersOverSeeds {
public:
    explicit AnswersOverSeeds(const bench::Truth& truth) : truth_(truth) {}

    void add(std::span<const float> answers);  // of the next seed, one for each value of the truth
    Value rms() const;                         // without the noise of the truth; see metrics/expected_error.h
    // The mean over seeds of the ratio of this map's RMS to the other's, both without the noise of the truth. What a
    // seed does to both is not in it.
    Value over(const AnswersOverSeeds& other) const;

private:
    metrics::TruthNoise noise() const;

    const bench::Truth& truth_;
    metrics::ErrorsOverSeeds errors_;
    std::vector<double> squares_;  // the mean square of each seed
};

}  // namespace shadowbench::claims
