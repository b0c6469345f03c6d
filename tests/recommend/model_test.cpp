#include "recommend/model.h"

#include <gtest/gtest.h>

#include <cmath>

namespace shadowbench::recommend {
namespace {

TEST(Model, FollowsWhatItWasGivenAndIsSureThere) {
    Model model({-0.3, 0.4, 0.01});
    const std::vector<std::vector<double>> positions{{0, 0}, {2, 1}, {4, 4}, {1, 3}};
    const std::vector<double> values{0.1, -1.0, -2.5, 0.4};
    model.fit(positions, values);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const Estimate estimate = model.at(positions[i]);
        EXPECT_NEAR(estimate.mean, values[i], 0.02);
        EXPECT_LT(estimate.sd, 0.011);
    }
    EXPECT_GT(model.at(std::vector<double>{4, 0}).sd, 0.1);
}

TEST(Model, ExtendsAPlaneAlongItsSlopes) {
    Model model({0.4, 0.5, 0.01});
    std::vector<std::vector<double>> positions;
    std::vector<double> values;
    for (const double x : {0.0, 1.0, 2.0})
        for (const double y : {0.0, 1.0, 2.0}) {
            positions.push_back({x, y});
            values.push_back(3.0 + 0.7 * x + 0.05 * y);
        }
    model.fit(positions, values);
    const Estimate beyond = model.at(std::vector<double>{4, 3});
    EXPECT_NEAR(beyond.mean, 3.0 + 2.8 + 0.15, 0.1);
    EXPECT_LT(std::abs(beyond.mean - 5.95), 3.0 * beyond.sd);
}

TEST(Model, SmoothsNoise) {
    // Two values at one place that differ by the noise: the mean of both, and less doubt than of one.
    Model once({0.3, 0.4, 0.07}), twice({0.3, 0.4, 0.07});
    once.fit({{1, 1}}, std::vector<double>{2.0});
    twice.fit({{1, 1}, {1, 1}}, std::vector<double>{1.95, 2.05});
    EXPECT_NEAR(twice.at(std::vector<double>{1, 1}).mean, 2.0, 1e-6);
    EXPECT_LT(twice.at(std::vector<double>{1, 1}).sd, 0.8 * once.at(std::vector<double>{1, 1}).sd);
}

}  // namespace
}  // namespace shadowbench::recommend
