#include "claims/value.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/random.h"
#include "metrics/expected_error.h"

namespace shadowbench::claims {
namespace {

TEST(Value, RatiosTakeTheWidestIntervalTheirPartsAllow) {
    const Value ratio = Value{10, 8, 12} / Value{2, 1, 4};
    EXPECT_DOUBLE_EQ(ratio.value, 5.0);
    EXPECT_DOUBLE_EQ(ratio.low, 2.0);
    EXPECT_DOUBLE_EQ(ratio.high, 12.0);
    const Value difference = Value{10, 8, 12} - Value{2, 1, 4};
    EXPECT_DOUBLE_EQ(difference.low, 4.0);
    EXPECT_DOUBLE_EQ(difference.high, 11.0);
}

TEST(Value, AnAbsoluteValueMayReachZero) {
    EXPECT_DOUBLE_EQ(absolute({-1, -3, 2}).low, 0.0);
    EXPECT_DOUBLE_EQ(absolute({-1, -3, 2}).high, 3.0);
    EXPECT_DOUBLE_EQ(absolute({-2, -3, -1}).low, 1.0);
    EXPECT_DOUBLE_EQ(absolute({-2, -3, -1}).high, 3.0);
}

TEST(Value, ValuesThatDoNotVaryHaveNoInterval) {
    EXPECT_EQ(to_text(exactly(1.5)), "1.5");
    EXPECT_EQ(to_text({14.2, 13.9, 14.6}), "14.2 [13.9, 14.6]");
}

TEST(Value, AnErrorHasTheIntervalOverSeeds) {
    results::Cell cell;
    cell.lookup.emplace().norms.rms = 0.03;
    EXPECT_EQ(error_of(cell).low, 0.03);
    cell.lookup->interval = results::RmsInterval{0.028, 0.031, true};
    EXPECT_NEAR(error_of(cell).value, std::sqrt(0.5 * (0.028 * 0.028 + 0.031 * 0.031)), 1e-15)
        << "not the error of one run, which has the truth's noise in it";
    EXPECT_EQ(error_of(cell).low, 0.028);
    EXPECT_EQ(error_of(cell).high, 0.031);
}

// Errors with a bias, the noise of the rays and that of the truth, each of any size: see metrics/expected_error.h.
TEST(Value, AnErrorLiesInItsIntervalAndHasNoNoiseOfTheTruth) {
    base::Random random(3);
    const auto any_size = [&] { return std::pow(10.0, random.uniform(-5.0, -1.0)); };
    int exact = 0, from_zero = 0;
    for (int draw = 0; draw < 600; ++draw) {
        const bool upper_bounds = draw % 3 == 0;
        const double bias = any_size(), of_rays = any_size(), of_truth = any_size();
        const std::size_t queries = 40;
        const int seeds = 1 + draw % 4;
        std::vector<double> truth(queries), standard_error(queries, of_truth), mean_squares;
        for (double& error : truth) error = of_truth * std::sqrt(3.0) * random.uniform(-1.0, 1.0);
        metrics::ErrorsOverSeeds over_seeds;
        results::Cell cell;
        cell.lookup.emplace();
        double mean_square = 0.0;
        for (int seed = 0; seed < seeds; ++seed) {
            std::vector<double> errors;
            for (const double off : truth)
                errors.push_back(bias + of_rays * std::sqrt(3.0) * random.uniform(-1.0, 1.0) - off);
            over_seeds.add(errors);
            cell.lookup->norms = metrics::error_norms(errors);
            mean_squares.push_back(cell.lookup->norms.rms * cell.lookup->norms.rms);
            mean_square += mean_squares.back() / seeds;
        }
        const metrics::TruthNoise noise = over_seeds.truth_noise(standard_error, upper_bounds);
        const metrics::Interval interval = metrics::expected_rms(mean_squares, noise);
        cell.lookup->interval = results::RmsInterval{interval.low, interval.high, true};
        const Value error = error_of(cell);
        EXPECT_LE(error.low, error.value) << "draw " << draw;
        EXPECT_LE(error.value, error.high) << "draw " << draw;
        from_zero += interval.low == 0.0;
        if (interval.low == 0.0 || upper_bounds) continue;
        ++exact;
        EXPECT_NEAR(error.value * error.value, mean_square - noise.bias, 1e-9 * mean_square) << "draw " << draw;
    }
    EXPECT_GT(exact, 100);
    EXPECT_GT(from_zero, 50);
}

}  // namespace
}  // namespace shadowbench::claims
