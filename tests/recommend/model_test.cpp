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

TEST(Model, TrustsADoubtfulValueLess) {
    Model model({-0.3, 0.4, 0.02});
    const std::vector<std::vector<double>> positions{{0, 0}, {1, 1}, {6, 0}};
    model.fit(positions, std::vector<double>{0.0, -0.6, 1.0}, std::vector<double>{0.0, 0.0, 0.2});
    const Estimate there = model.at(std::vector<double>{6, 0});
    EXPECT_GT(there.sd, 0.05);
    EXPECT_LT(there.sd, 0.2);
    EXPECT_NEAR(there.mean, 1.0, 0.3);
    EXPECT_LT(model.at(std::vector<double>{0, 0}).sd, 0.03);
    Model without({-0.3, 0.4, 0.02});
    without.fit({{0, 0}, {1, 1}}, std::vector<double>{0.0, -0.6});
    EXPECT_GT(without.at(std::vector<double>{6, 0}).sd, 2.0 * there.sd);
    EXPECT_LT(without.at(std::vector<double>{6, 0}).mean, 0.0);
}

TEST(Model, SmoothsNoise) {
    // Values at one place that differ by as much as the noise may be: their mean, with the doubt of a mean.
    for (const std::size_t pairs : {1u, 2u, 8u}) {
        Model model({0.3, 0.4, 0.07});
        std::vector<double> values;
        for (std::size_t i = 0; i < pairs; ++i) values.insert(values.end(), {1.93, 2.07});
        model.fit(std::vector<std::vector<double>>(values.size(), {1, 1}), values);
        const Estimate estimate = model.at(std::vector<double>{1, 1});
        EXPECT_NEAR(estimate.mean, 2.0, 1e-6);
        EXPECT_NEAR(estimate.sd, 0.07 / std::sqrt(static_cast<double>(values.size())), 0.001) << values.size();
    }
}

}  // namespace
}  // namespace shadowbench::recommend
