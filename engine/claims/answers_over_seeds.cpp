#include "claims/answers_over_seeds.h"

#include <algorithm>
#include <cmath>

#include "claims/intervals.h"
#include "metrics/statistics.h"

namespace shadowbench::claims {

void AnswersOverSeeds::add(std::span<const float> answers) {
    std::vector<double> off(answers.size());
    for (std::size_t q = 0; q < answers.size(); ++q) off[q] = answers[q] - truth_.value[q];
    errors_.add(off);
    const double rms = metrics::error_norms(off).rms;
    squares_.push_back(rms * rms);
}

metrics::TruthNoise AnswersOverSeeds::noise() const {
    return errors_.truth_noise(truth_.standard_error, truth_.degrees == 0);
}

Value AnswersOverSeeds::rms() const {
    const metrics::Interval interval = metrics::expected_rms(squares_, noise());
    return rms_between(interval.low, interval.high);
}

Value AnswersOverSeeds::over(const AnswersOverSeeds& other) const {
    const double bias = noise().bias;  // of the truth alone: the same for both
    const auto expected = [&](double square) { return std::max(0.0, square - bias); };
    std::vector<double> ratios;
    for (std::size_t seed = 0; seed < squares_.size(); ++seed)
        ratios.push_back(std::sqrt(expected(squares_[seed]) / expected(other.squares_[seed])));
    return mean_of(ratios);
}

}  // namespace shadowbench::claims
