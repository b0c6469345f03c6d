#include "claims/direct_sum.h"

#include <gtest/gtest.h>

#include "base/random.h"

namespace shadowbench::claims {
namespace {

TEST(DirectSum, OfStepsAndSlopes) {
    const curves::Curve step{{1, 1}, {1, 0.5f}}, slope{{0.5f, 1}, {2.5f, 0}}, lit{};
    const curves::WeightedCurve terms[] = {{step, 0.25}, {slope, 0.5}, {lit, 0.25}};
    std::vector<float> depths;
    curves::Curve sum{{9, 9}};
    direct_sum(terms, depths, sum);
    const curves::Curve expected{{0.5f, 1}, {1, 0.875f}, {1, 0.75f}, {2.5f, 0.375f}};
    EXPECT_EQ(sum, expected);
    direct_sum({}, depths, sum);
    EXPECT_TRUE(sum.empty()) << "lit everywhere";
}

TEST(DirectSum, IsThatOfTheSweep) {
    base::Random random(1);
    std::vector<curves::Curve> functions(20);
    for (curves::Curve& function : functions) {
        float z = 0.0f, value = 1.0f;
        for (int i = 0; i < 6; ++i) {
            if (i % 3 != 2) z += static_cast<float>(random.uniform(0.1, 1.0));  // else a step
            function.push_back({z, value});
            value = static_cast<float>(random.uniform(0.0, static_cast<double>(value)));
        }
    }
    std::vector<curves::WeightedCurve> terms;
    for (const curves::Curve& function : functions) terms.push_back({function, 1.0 / 20.0});
    std::vector<float> depths;
    curves::SweepScratch scratch;
    curves::Curve direct, swept;
    direct_sum(terms, depths, direct);
    curves::weighted_sum(terms, scratch, swept);
    EXPECT_GT(direct.size(), 80u);
    for (int i = 0; i < 200; ++i) {
        const auto z = static_cast<float>(random.uniform(-0.5, 5.0));
        EXPECT_NEAR(curves::evaluate(direct, z), curves::evaluate(swept, z), 2e-6);
    }
    for (const float z : depths) {
        EXPECT_NEAR(curves::evaluate(direct, z), curves::evaluate(swept, z), 2e-6);
        EXPECT_NEAR(curves::evaluate_behind(direct, z), curves::evaluate_behind(swept, z), 2e-6);
    }
}

}  // namespace
}  // namespace shadowbench::claims
