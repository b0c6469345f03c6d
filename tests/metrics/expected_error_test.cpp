#include "metrics/expected_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "base/random.h"

namespace shadowbench::metrics {
namespace {

double normal(base::Random& random) {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - random.uniform()));
    return radius * std::cos(2.0 * std::numbers::pi * random.uniform());
}

double mean_square(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values) sum += value * value;
    return sum / static_cast<double>(values.size());
}

// A technique with a known bias and noise for each query, judged by a truth that errs by a known amount.
struct Model {
    double bias, noise, truth;  // the largest of any query; each query has a share of them
    int seeds, queries;

    double share(int q) const { return 0.2 + 0.8 * q / (queries - 1.0); }
    double expected_square() const {
        double sum = 0.0;
        for (int q = 0; q < queries; ++q) sum += share(q) * share(q) * (bias * bias + noise * noise);
        return sum / queries;
    }
    std::vector<double> standard_error() const {
        std::vector<double> result;
        for (int q = 0; q < queries; ++q) result.push_back(truth * share(queries - 1 - q));
        return result;
    }
};

struct Measured {
    ErrorsOverSeeds errors;
    std::vector<double> squares;
};

Measured measure(const Model& model, base::Random& random) {
    const std::vector<double> standard_error = model.standard_error();
    std::vector<double> truth_error, errors(standard_error.size());
    for (const double se : standard_error) truth_error.push_back(se * normal(random));
    Measured measured;
    for (int s = 0; s < model.seeds; ++s) {
        for (int q = 0; q < model.queries; ++q) {
            const double sign = q % 3 ? 1.0 : -1.0;
            errors[q] = model.share(q) * (sign * model.bias + model.noise * normal(random)) - truth_error[q];
        }
        measured.errors.add(errors);
        measured.squares.push_back(mean_square(errors));
    }
    return measured;
}

TEST(ExpectedRms, interval_holds_as_often_as_it_says) {
    constexpr int rounds = 2000;
    const Model models[] = {
        {0.1, 0.05, 0.0, 5, 400},   // an exact truth
        {0.1, 0.05, 0.02, 5, 400},  // an ordinary one
        {0.1, 0.05, 0.1, 5, 400},   // one as bad as the technique
        {0.0, 0.05, 0.05, 5, 400},  // noise only
        {0.1, 0.02, 0.05, 3, 400},  // few seeds
        {0.1, 0.0, 0.05, 1, 400},   // rays that are not random
    };
    for (const Model& model : models) {
        base::Random random(11);
        const double expected = std::sqrt(model.expected_square());
        int held = 0;
        for (int round = 0; round < rounds; ++round) {
            const Measured measured = measure(model, random);
            const Interval interval =
                expected_rms(measured.squares, measured.errors.truth_noise(model.standard_error(), false));
            held += interval.low <= expected && expected <= interval.high;
        }
        EXPECT_GE(held, 0.93 * rounds) << model.bias << " " << model.truth << " " << model.seeds;
        EXPECT_LE(held, 0.97 * rounds) << model.bias << " " << model.truth << " " << model.seeds;
    }
}

// The standard deviations that the formulas state, against those of many truths for one technique without noise.
TEST(TruthNoise, is_what_many_truths_give) {
    constexpr int rounds = 20000;
    const Model model{0.1, 0.0, 0.05, 1, 40};
    base::Random random(3);
    double sum = 0.0, squares = 0.0, bias = 0.0, variance = 0.0;
    for (int round = 0; round < rounds; ++round) {
        const Measured measured = measure(model, random);
        sum += measured.squares[0];
        squares += measured.squares[0] * measured.squares[0];
        const TruthNoise noise = measured.errors.truth_noise(model.standard_error(), false);
        bias += noise.bias / rounds;
        variance += (noise.linear + noise.quadratic) / rounds;
    }
    const double mean = sum / rounds;
    EXPECT_NEAR(mean - bias, model.expected_square(), 0.01 * mean);
    EXPECT_NEAR(std::sqrt(variance), std::sqrt(squares / rounds - mean * mean), 0.02 * std::sqrt(variance));
}

// One seed, two queries, by hand: n = 2, e^2 = 4 and 1, se^2 = 1 and 0.25.
TEST(TruthNoise, is_that_of_the_formulas) {
    ErrorsOverSeeds errors;
    errors.add(std::vector<double>{2.0, -1.0});
    const TruthNoise noise = errors.truth_noise(std::vector<double>{1.0, 0.5}, false);
    EXPECT_DOUBLE_EQ(noise.bias, 0.625);
    EXPECT_DOUBLE_EQ(noise.linear, 4.0 * (1.0 * (4.0 - 1.0) + 0.25 * (1.0 - 0.25)) / 4.0);
    EXPECT_DOUBLE_EQ(noise.quadratic, 2.0 * (1.0 + 0.0625) / 4.0);
}

// A truth that may be as uncertain as it says, or exact: both ends hold.
TEST(ExpectedRms, counts_an_upper_bound_of_the_truths_error_on_one_side) {
    ErrorsOverSeeds errors;
    errors.add(std::vector<double>(100, 0.1));
    const std::vector<double> bounds(100, 0.08);
    const Interval interval = expected_rms(std::vector<double>{0.01}, errors.truth_noise(bounds, true));
    EXPECT_LT(interval.low, std::sqrt(0.01 - 0.0064));
    EXPECT_GT(interval.high, 0.1);
    EXPECT_LT(expected_rms(std::vector<double>{0.01}, errors.truth_noise(bounds, false)).high, 0.1);
}

TEST(ExpectedRms, is_never_below_0_and_exact_without_uncertainty) {
    const Interval none = expected_rms(std::vector<double>{0.01}, {});
    EXPECT_DOUBLE_EQ(none.low, 0.1);
    EXPECT_DOUBLE_EQ(none.high, 0.1);
    const Interval below = expected_rms(std::vector<double>{0.01}, {0.02, 0.02, 1e-6, 1e-6});
    EXPECT_EQ(below.low, 0.0);
    EXPECT_EQ(below.high, 0.0);
}

}  // namespace
}  // namespace shadowbench::metrics
