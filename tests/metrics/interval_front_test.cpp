#include "metrics/interval_front.h"

#include <gtest/gtest.h>

#include <vector>

#include "base/random.h"
#include "metrics/pareto.h"
#include "metrics/student.h"

namespace shadowbench::metrics {
namespace {

// Intervals of all differences, in both directions.
struct Table {
    std::size_t n;
    std::vector<Interval> cost, error;  // of a - b at [a * n + b]

    explicit Table(std::size_t choices) : n(choices), cost(n * n, {0, 0}), error(n * n, {0, 0}) {}
    void set(std::vector<Interval>& of, std::size_t a, std::size_t b, Interval difference) const {
        of[a * n + b] = difference;
        of[b * n + a] = {0.0 - difference.high, 0.0 - difference.low};
    }
    std::vector<OnFront> front() const {
        return front_of_intervals(
            n, [&](std::size_t a, std::size_t b) { return cost[a * n + b]; },
            [&](std::size_t a, std::size_t b) { return error[a * n + b]; });
    }
};

// The definition, word for word.
OnFront by_definition(const Table& table, std::size_t b) {
    bool beaten = false, maybe = false;
    for (std::size_t a = 0; a < table.n; ++a) {
        if (a == b) continue;
        const Interval c = table.cost[a * table.n + b], e = table.error[a * table.n + b];
        const bool certainly_worse_in_cost = c.low > 0, certainly_worse_in_error = e.low > 0;
        const bool not_worse_in_cost = c.high <= 0, not_worse_in_error = e.high <= 0;
        const bool better_in_cost = c.high < 0, better_in_error = e.high < 0;
        const bool equal_in_both = c.low == 0 && c.high == 0 && e.low == 0 && e.high == 0;
        beaten = beaten || (not_worse_in_cost && not_worse_in_error && (better_in_cost || better_in_error));
        maybe = maybe || !(certainly_worse_in_cost || certainly_worse_in_error || equal_in_both);
    }
    return beaten ? OnFront::no : maybe ? OnFront::perhaps : OnFront::certainly;
}

TEST(IntervalFront, matches_the_definition) {
    base::Random random(5);
    int marks[3] = {0, 0, 0};
    for (int round = 0; round < 3000; ++round) {
        Table table(1 + random.below(8));
        // Values on a few levels, so that there are ties and plateaus; widths from none to all.
        std::vector<double> cost, error;
        for (std::size_t i = 0; i < table.n; ++i) {
            cost.push_back(static_cast<double>(random.below(5)));
            error.push_back(static_cast<double>(random.below(5)));
        }
        const auto interval = [&](double difference) -> Interval {
            switch (random.below(4)) {
                case 0:
                    return {difference, difference};
                case 1:
                    return {difference - 1.0, difference + 1.0};  // may end at 0
                case 2:
                    return {difference - random.uniform(), difference + random.uniform()};
                default:
                    return {difference - 10.0, difference + 10.0};
            }
        };
        for (std::size_t a = 0; a < table.n; ++a)
            for (std::size_t b = a + 1; b < table.n; ++b) {
                table.set(table.cost, a, b, interval(cost[a] - cost[b]));
                table.set(table.error, a, b, interval(error[a] - error[b]));
            }
        const std::vector<OnFront> front = table.front();
        for (std::size_t b = 0; b < table.n; ++b) {
            ASSERT_EQ(front[b], by_definition(table, b)) << "round " << round << ", choice " << b;
            ++marks[static_cast<int>(front[b])];
        }
    }
    for (const int count : marks) EXPECT_GT(count, 1000);
}

TEST(IntervalFront, of_exact_values_is_the_pareto_front) {
    base::Random random(6);
    for (int round = 0; round < 300; ++round) {
        std::vector<CostAndError> choices;
        for (int i = 0; i < 12; ++i)
            choices.push_back({static_cast<double>(random.below(6)), static_cast<double>(random.below(6))});
        const auto difference = [&](double CostAndError::*value) -> Difference {
            return [&choices, value](std::size_t a, std::size_t b) -> Interval {
                return {choices[a].*value - choices[b].*value, choices[a].*value - choices[b].*value};
            };
        };
        const std::vector<OnFront> front =
            front_of_intervals(choices.size(), difference(&CostAndError::cost), difference(&CostAndError::error));
        const std::vector<bool> exact = pareto_front(choices);
        for (std::size_t i = 0; i < choices.size(); ++i)
            ASSERT_EQ(front[i], exact[i] ? OnFront::certainly : OnFront::no);
    }
}

TEST(IntervalFront, of_one_or_none_needs_no_interval) {
    const Difference never = [](std::size_t, std::size_t) -> Interval { throw "asked for a pair"; };
    EXPECT_TRUE(front_of_intervals(0, never, never).empty());
    EXPECT_EQ(front_of_intervals(1, never, never), std::vector<OnFront>{OnFront::certainly});
    EXPECT_NEAR(tail_of_front(1, 0.95), 0.025, 1e-15);
    EXPECT_NEAR(tail_of_front(7, 0.95), 0.025 / 42, 1e-15) << "21 pairs, two values each";
}

// Sampled values of known expectation, many of them tied or close: a front that says anything wrong is rare. Marks are
// compared with the exact front of the expectations.
TEST(IntervalFront, is_wrong_in_at_most_one_of_twenty_runs) {
    constexpr int rounds = 2000, seeds = 5;
    const std::vector<CostAndError> truth{{1, 4}, {1, 4.5}, {2, 4}, {3, 2}, {3.3, 2.1}, {5, 1}, {6, 1}};
    const std::vector<bool> exact = pareto_front(truth);
    const double tail = tail_of_front(truth.size(), 0.95);
    base::Random random(8);
    int wrong = 0, certain = 0;
    const auto noisy = [&](double value) {  // a sum of twelve uniform numbers is close to normal
        double noise = -6.0;
        for (int i = 0; i < 12; ++i) noise += random.uniform();
        return value + 0.05 * noise;
    };
    for (int round = 0; round < rounds; ++round) {
        std::vector<std::vector<double>> cost(truth.size()), error(truth.size());
        for (std::size_t i = 0; i < truth.size(); ++i)
            for (int s = 0; s < seeds; ++s) {
                cost[i].push_back(noisy(truth[i].cost));
                error[i].push_back(noisy(truth[i].error));
            }
        const auto difference = [&](const std::vector<std::vector<double>>& values) -> Difference {
            return [&values, tail](std::size_t a, std::size_t b) {
                std::vector<double> differences;
                for (int s = 0; s < seeds; ++s) differences.push_back(values[a][s] - values[b][s]);
                return mean_interval(mean_and_variance(differences), 0.0, tail);
            };
        };
        const std::vector<OnFront> front = front_of_intervals(truth.size(), difference(cost), difference(error));
        bool fault = false;
        for (std::size_t i = 0; i < truth.size(); ++i) {
            fault = fault || (front[i] == OnFront::certainly && !exact[i]) || (front[i] == OnFront::no && exact[i]);
            certain += front[i] != OnFront::perhaps;
        }
        wrong += fault;
    }
    EXPECT_LE(wrong, rounds / 20);
    EXPECT_GT(certain, rounds) << "and it says something";
}

}  // namespace
}  // namespace shadowbench::metrics
