#include "techniques/trades.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

namespace shadowbench::techniques {
namespace {

using Scale = Trade::Scale;

const Parameter* declared(const Technique& row, const std::string& name) {
    for (const Parameter& parameter : row.parameters)
        if (parameter.name == name) return &parameter;
    return nullptr;
}

std::vector<double> numbers_of(const Trade& trade, const Parameter& parameter) {
    std::vector<double> numbers;
    for (const auto& value : values_of(trade, std::span(&parameter, 1))) numbers.push_back(std::get<double>(value));
    return numbers;
}

// Every value of every trade is one that the technique reads, and one that it writes as it was.
TEST(Trades, OfEveryRowAreValuesOfItsOwnParameters) {
    for (const Technique& row : all()) {
        EXPECT_FALSE(row.traits.trades.empty()) << row.id;
        for (const Trade& trade : row.traits.trades) {
            SCOPED_TRACE(std::string(row.id) + " " + trade.parameter);
            ASSERT_NE(declared(row, trade.parameter), nullptr);
            const auto values = values_of(trade, row.parameters);
            ASSERT_FALSE(values.empty());
            for (const auto& value : values) {
                nlohmann::json object;
                std::visit([&](const auto& v) { object[trade.parameter] = v; }, value);
                ParameterValues read;
                ASSERT_NO_THROW(read = read_parameters(row.parameters, object, "")) << object;
                EXPECT_EQ(read.at(trade.parameter), value);
            }
        }
    }
}

TEST(Trades, OfARowNameEachParameterOnce) {
    for (const Technique& row : all()) {
        std::vector<std::string> names;
        for (const Trade& trade : row.traits.trades) names.push_back(trade.parameter);
        std::sort(names.begin(), names.end());
        EXPECT_EQ(std::adjacent_find(names.begin(), names.end()), names.end()) << row.id;
    }
}

// A search over all trades must not leave out what the technique does unasked.
TEST(Trades, WithSeveralChoicesHoldTheDefault) {
    for (const Technique& row : all())
        for (const Trade& trade : row.traits.trades) {
            if (trade.choices.size() < 2) continue;
            const ParameterValues standard = read_parameters(row.parameters, nlohmann::json::object(), "");
            EXPECT_THAT(trade.choices, ::testing::Contains(standard.at(trade.parameter)))
                << row.id << " " << trade.parameter;
        }
}

TEST(Trades, RunFromTheCheapestToTheMostAccurateValueInEvenRatios) {
    const Parameter number{"x", ParameterKind::number, "", 1, 0, 1};
    const std::vector<double> falling = numbers_of({"x", Scale::logarithmic, 0.2, 0.0005}, number);
    EXPECT_EQ(falling.front(), 0.2);
    EXPECT_EQ(falling.back(), 0.0005);
    for (std::size_t i = 1; i < falling.size(); ++i) {
        EXPECT_LT(falling[i], falling[i - 1]);
        EXPECT_NEAR(std::log2(falling[i - 1] / falling[i]), 0.25, 0.02);  // three digits of each
    }
}

TEST(Trades, OfWholeNumbersVisitEachOfTheSmallOnesOnce) {
    const Parameter whole{"n", ParameterKind::integer, "", 1, 1, 256};
    const std::vector<double> rising = numbers_of({"n", Scale::logarithmic, 1, 256}, whole);
    const std::vector<double> start(rising.begin(), rising.begin() + 6);
    EXPECT_EQ(start, (std::vector<double>{1, 2, 3, 4, 5, 6}));
    EXPECT_EQ(rising.back(), 256);
    EXPECT_EQ(numbers_of({"n", Scale::linear, 1, 4}, whole), (std::vector<double>{1, 2, 3, 4}));
}

TEST(Trades, AreWrittenInALine) {
    EXPECT_EQ(to_string(Trade{"tolerance", Scale::logarithmic, 0.2, 0.0005}), "tolerance 0.2 to 0.0005");
    EXPECT_EQ(to_string(Trade{.parameter = "filter", .choices = {"point", "bilinear"}}), "filter point|bilinear");
    EXPECT_EQ(to_string(Trade{.parameter = "min_size", .choices = {0.0}}), "min_size 0");
}

}  // namespace
}  // namespace shadowbench::techniques
