#include "metrics/pareto.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "base/random.h"

namespace shadowbench::metrics {
namespace {

std::vector<bool> front_of(const std::vector<CostAndError>& choices) {
    return pareto_front(choices);
}

TEST(ParetoFront, KeepsChoicesThatNoneBeats) {
    EXPECT_TRUE(front_of({}).empty());
    EXPECT_EQ(front_of({{1, 3}, {2, 2}, {3, 1}, {3, 3}}), (std::vector<bool>{true, true, true, false}));
}

TEST(ParetoFront, EqualInOneValueAndWorseInTheOtherIsBeaten) {
    EXPECT_EQ(front_of({{1, 1}, {1, 2}, {2, 1}}), (std::vector<bool>{true, false, false}));
}

TEST(ParetoFront, EqualChoicesDoNotBeatEachOther) {
    EXPECT_EQ(front_of({{1, 1}, {1, 1}}), (std::vector<bool>{true, true}));
}

// A failed technique has no error, and comparisons with NaN would break the sort.
TEST(ParetoFront, AChoiceThatIsNotFiniteIsNeitherOnItNorBeatsAnother) {
    const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(front_of({{nan, 0}, {0, nan}, {-infinity, 0}, {1, infinity}, {5, 5}}),
              (std::vector<bool>{false, false, false, false, true}));
}

TEST(ParetoFront, MatchesTheDefinition) {
    base::Random random(2);
    for (int round = 0; round < 200; ++round) {
        std::vector<CostAndError> choices;
        for (int i = 0; i < 30; ++i)  // few different values, so that there are ties
            choices.push_back({static_cast<double>(random.below(12)), static_cast<double>(random.below(12))});
        const auto front = pareto_front(choices);
        for (std::size_t i = 0; i < choices.size(); ++i) {
            bool beaten = false;
            for (const CostAndError& other : choices)
                beaten = beaten || (other.cost <= choices[i].cost && other.error <= choices[i].error &&
                                    (other.cost < choices[i].cost || other.error < choices[i].error));
            ASSERT_EQ(front[i], !beaten);
        }
    }
}

}  // namespace
}  // namespace shadowbench::metrics
