#include "bench/ray_sets.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "bench/half_covered.h"
#include "bench/reference.h"

namespace shadowbench::bench {
namespace {

using techniques::Query;

TEST(RaySets, OfEqualNumbersGiveTheMeanOfTheirMeansAndItsStandardError) {
    base::Random random(4);
    for (int sets = 2; sets <= 15; ++sets) {
        std::vector<double> sums, means;
        double mean = 0.0, squares = 0.0;
        for (int k = 0; k < sets; ++k) {
            means.push_back(random.uniform());
            sums.push_back(means.back() * 50);
            mean += means.back() / sets;
        }
        for (const double m : means) squares += (m - mean) * (m - mean);
        const std::vector<std::uint64_t> counts(static_cast<std::size_t>(sets), 50);
        const Mean result = mean_of_sets(sums, counts);
        EXPECT_NEAR(result.value, mean, 1e-14);
        EXPECT_NEAR(result.standard_error, std::sqrt(squares / (sets - 1.0) / sets), 1e-14);
    }
}

TEST(RaySets, ThatSeeTheSameEverywhereLeaveNoError) {
    const std::uint64_t counts[] = {3, 1, 7, 2};
    const double sums[] = {3, 1, 7, 2};
    const Mean result = mean_of_sets(sums, counts);
    EXPECT_EQ(result.value, 1.0);
    EXPECT_EQ(result.standard_error, 0.0);
}

// Three rays, one in each of three sets of eight: Student's interval of two degrees of freedom.
TEST(RaySets, ThatMissTheFootprintWidenTheError) {
    const std::uint64_t counts[] = {0, 1, 0, 1, 0, 0, 1, 0};
    const double sums[] = {0, 0.50, 0, 0.52, 0, 0, 0.54, 0};
    const Mean result = mean_of_sets(sums, counts);
    EXPECT_NEAR(result.value, 0.52, 1e-15);
    EXPECT_NEAR(result.standard_error * 2.3646, 4.3027 * 0.02 / std::sqrt(3.0), 2e-6);  // t has five digits
}

TEST(RaySets, WithOneRayInAllAreUnsure) {
    const std::uint64_t counts[] = {0, 1, 0};
    const double sums[] = {0, 1, 0};
    EXPECT_EQ(mean_of_sets(sums, counts).value, 1.0);
    EXPECT_EQ(mean_of_sets(sums, counts).standard_error, 0.5);
}

// Footprints far narrower than a cell of a set: any bias of the value, and the interval, with few rays or none inside.
TEST(RaySets, AreNotBiasedInNarrowFootprints) {
    HalfCovered half = half_covered(0.1);  // 40 % of pixel column 4 lies under a layer that passes 40 %
    half.settings.samples_per_pixel = 128;
    double sum = 0.0, squares = 0.0;
    int held = 0, cases = 0;
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
        half.settings.seed = seed;
        std::vector<Query> queries;
        for (int row = 0; row < 8; ++row)
            queries.push_back({4.42f, static_cast<float>(row) + 0.37f, 2.0f, 0.2f});  // covered up to 4.4
        const Truth truth = reference_visibility(half.scene, half.view, half.settings, queries, {});
        for (std::size_t q = 0; q < queries.size(); ++q) {
            const double off = truth.value[q] - (1.0 - 0.4 * 0.6);
            sum += off;
            squares += off * off;
            held += std::abs(off) <= 2.3646 * truth.standard_error[q];
            ++cases;
        }
    }
    EXPECT_LT(std::abs(sum), 4.0 * std::sqrt(squares)) << "no bias beyond four standard errors of the mean";
    // About five rays in all, which see one of two values: in so few draws all see the same in 11 % of cases.
    EXPECT_GT(held, 0.8 * cases);
}

TEST(RaySets, UseAsManyRaysAsStated) {
    HalfCovered half = half_covered(0.1);
    const Query queries[] = {{4.5f, 4.5f, 2.0f, 1.0f}};
    struct Expected {
        int samples, used, degrees;
    };
    for (const Expected& e : {Expected{1, 1, 0}, Expected{2, 2, 1}, Expected{15, 15, 14}, Expected{16, 16, 7},
                              Expected{100, 96, 7}, Expected{400, 400, 7}, Expected{1001, 1000, 7}}) {
        half.settings.samples_per_pixel = e.samples;
        const Truth truth = reference_visibility(half.scene, half.view, half.settings, queries, {});
        EXPECT_EQ(truth.samples_per_pixel, e.used) << e.samples;
        EXPECT_EQ(truth.degrees, e.degrees) << e.samples;
    }
    half.settings.pattern = scene::Pattern::regular;
    const Truth truth = reference_visibility(half.scene, half.view, half.settings, queries, {});
    EXPECT_EQ(truth.degrees, 0);
    EXPECT_EQ(truth.samples_per_pixel, 1001);
}

}  // namespace
}  // namespace shadowbench::bench
