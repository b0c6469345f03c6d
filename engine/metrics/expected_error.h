// The root mean square error that is expected of a technique, and its interval. Two things make a measured one
// uncertain: the light rays, of which another seed gives others, and the truth, which is a mean of rays too.
//
// In seed s the answer to query q has the error e_sq = b_q + r_sq: a bias, and the noise of the rays. The truth of q
// has the error t_q, independent, of mean 0 and standard error se_q, and the same in all seeds. Over n queries and S
// seeds the measured mean square is
//     M_s = mean_q (e_sq - t_q)^2
//         = mean_q e_sq^2  -  2 mean_q e_sq t_q  +  mean_q t_q^2.
// What is asked for is E = expectation over seeds of mean_q e_sq^2.
//   - Expectation: E[M_s] = E + mean(se^2). So mean_s M_s - mean(se^2) estimates E.
//   - Given the truth, the M_s are independent. Their own spread gives the variance of their mean: s^2 / S.
//   - The truth moves all M_s together, by -2 mean_q b_q t_q + mean_q t_q^2. For normal t_q, independent between
//     queries, the two parts are uncorrelated and have the variances
//         linear    = 4 sum b_q^2 se_q^2 / n^2
//         quadratic = 2 sum se_q^4 / n^2.
//     With one seed, b is the whole error e; that is the case of rays that are not random.
//   - b_q^2 is estimated without bias by m_q^2 - v_q - se_q^2, where m_q is the mean over seeds of the measured errors
//     of q and v_q the variance of that mean (their sample variance over S).
// Both uncertainties are independent; mean_interval() joins them. An estimate of linear below 0 counts as 0. For
// hundreds of queries the interval holds as often as it says; for tens of them and a truth as uncertain as the
// technique, 95 % may be 97 %. Queries whose footprints share rays of the truth are not independent: where most do, the
// truth's part is too small.
#pragma once

#include <span>
#include <vector>

#include "metrics/statistics.h"

namespace shadowbench::metrics {

// What the truth's errors do to the mean square of errors against it.
struct TruthNoise {
    double bias = 0.0;        // mean(se^2)
    double least_bias = 0.0;  // the same, or 0 if the standard errors are upper bounds
    double linear = 0.0;      // variance of the part that depends on the technique
    double quadratic = 0.0;   // variance of the part that is equal for all techniques
};

// Errors of the same queries against one truth, seed by seed.
class ErrorsOverSeeds {
public:
    // All seeds must have the same queries, in the same order.
    void add(std::span<const double> errors);
    int seeds() const { return seeds_; }
    // There must be at least one seed, and a standard error for each query. `upper_bounds`: the standard errors are
    // upper bounds, so the truth may as well be exact.
    TruthNoise truth_noise(std::span<const double> standard_error, bool upper_bounds) const;

private:
    int seeds_ = 0;
    std::vector<double> sum_, squares_;  // of each query
};

// Interval of sqrt(E) from the mean squares M_s, at least one. One value has no spread: the interval then covers the
// truth's uncertainty only. E is never taken below 0. The lower end assumes the whole bias of the truth, the upper end
// the least.
Interval expected_rms(std::span<const double> mean_squares, const TruthNoise& truth, double confidence = 0.95);

}  // namespace shadowbench::metrics
