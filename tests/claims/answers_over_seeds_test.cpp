#include "claims/answers_over_seeds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/random.h"

namespace shadowbench::claims {
namespace {

constexpr std::size_t queries = 4000;

// A truth of 0.5 everywhere that is known with this standard error.
bench::Truth truth_of(double standard_error) {
    base::Random random(11);
    bench::Truth truth;
    truth.degrees = 7;
    truth.standard_error.assign(queries, standard_error);
    for (std::size_t q = 0; q < queries; ++q)
        truth.value.push_back(0.5 + standard_error * std::sqrt(3.0) * random.uniform(-1.0, 1.0));
    return truth;
}

std::vector<float> answers_of(double noise, base::Random& random) {
    std::vector<float> answers;
    for (std::size_t q = 0; q < queries; ++q)
        answers.push_back(static_cast<float>(0.5 + noise * std::sqrt(3.0) * random.uniform(-1.0, 1.0)));
    return answers;
}

TEST(AnswersOverSeeds, HoldNoNoiseOfTheTruth) {
    const bench::Truth truth = truth_of(0.03);
    base::Random random(5);
    AnswersOverSeeds small(truth), large(truth);
    for (int seed = 0; seed < 3; ++seed) {
        small.add(answers_of(0.02, random));
        large.add(answers_of(0.04, random));
    }
    EXPECT_NEAR(small.rms().value, 0.02, 0.002);
    EXPECT_LT(small.rms().low, small.rms().value);
    EXPECT_GT(small.rms().high, small.rms().value);
    EXPECT_NEAR(large.over(small).value, 2.0, 0.2);
}

// What seeds do to both maps changes their errors, and not the ratio.
TEST(AnswersOverSeeds, ARatioIsThatOfEachSeed) {
    const bench::Truth truth = truth_of(0.0);
    AnswersOverSeeds one(truth), other(truth);
    for (const float noise : {0.01f, 0.05f, 0.1f}) {
        one.add(std::vector<float>(queries, 0.5f + 3.0f * noise));
        other.add(std::vector<float>(queries, 0.5f + noise));
    }
    EXPECT_NEAR(one.over(other).low, 3.0, 1e-3);
    EXPECT_NEAR(one.over(other).high, 3.0, 1e-3);
    EXPECT_GT(one.rms().high, 1.3 * one.rms().value);
}

}  // namespace
}  // namespace shadowbench::claims
