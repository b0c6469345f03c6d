#include "recommend/model.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

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

// Points are estimated side by side, in blocks and on several threads: each must get what it gets by itself.
TEST(Model, EstimatesManyPointsAsItDoesOne) {
    const std::vector<std::vector<double>> positions{{0, 0}, {2, 1}, {4, 4}, {1, 3}, {3, 0}};
    Model errors({-0.3, 0.4, 0.03}), times({0.3, 0.4, 0.07});
    errors.fit(positions, std::vector<double>{0.1, -1.0, -2.5, 0.4, -0.2});
    times.fit(positions, std::vector<double>{1.0, 1.4, 2.9, 2.1, 1.7});
    for (const std::size_t count : {1u, 7u, 8u, 9u, 300u, 1025u}) {
        std::vector<double> points;
        for (std::size_t p = 0; p < count; ++p) {
            points.push_back(0.125 * static_cast<double>(p % 41));
            points.push_back(0.25 * static_cast<double>(p / 41));
        }
        const std::array models{&std::as_const(errors), &std::as_const(times)};
        std::array<std::vector<Estimate>, 2> all;
        Model::at_all(models, points, 2, all);
        for (std::size_t m = 0; m < 2; ++m) {
            ASSERT_EQ(all[m].size(), count);
            for (std::size_t p = 0; p < count; ++p) {
                const Estimate one = models[m]->at(std::span(points).subspan(2 * p, 2));
                EXPECT_EQ(all[m][p].mean, one.mean);
                EXPECT_EQ(all[m][p].sd, one.sd);
            }
        }
    }
}

}  // namespace
}  // namespace shadowbench::recommend
