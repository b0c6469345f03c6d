// When timed passes stop, and whether the intervals that they leave behind hold the median often enough. The times are
// synthetic.
#include "bench/repeat.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "base/random.h"
#include "bench/clock.h"
#include "results/settled.h"

namespace shadowbench::bench {
namespace {

const auto narrow = [] { return true; };
const auto wide = [] { return false; };

std::size_t rounds_of(const RepeatRule& rule, const std::function<bool()>& all_narrow) {
    std::vector<std::size_t> rounds;
    repeat(
        rule, [&](std::size_t r) { rounds.push_back(r); }, all_narrow);
    for (std::size_t i = 0; i < rounds.size(); ++i) EXPECT_EQ(rounds[i], i);
    return rounds.size();
}

TEST(Repeat, KeepsToItsLimits) {
    EXPECT_EQ(rounds_of({9, 9, 1e9}, wide), 9u) << "a fixed number";
    EXPECT_EQ(rounds_of({1, 1, 1e9}, narrow), 1u);
    EXPECT_EQ(rounds_of({5, 31, 1e9}, wide), 31u);
    EXPECT_EQ(rounds_of({5, 31, 0.0}, wide), 5u) << "no time beyond the least ones";
    EXPECT_EQ(rounds_of({40, 40, 0.0}, narrow), 40u);
}

TEST(Repeat, StopsAtLooksOnly) {
    EXPECT_EQ(rounds_of({5, 31, 1e9}, narrow), 7u);
    EXPECT_EQ(rounds_of({7, 31, 1e9}, narrow), 7u);
    EXPECT_EQ(rounds_of({9, 31, 1e9}, narrow), 11u);
    std::vector<std::size_t> looks;
    for (std::size_t done = 7; done < 31; ++done)
        goes_on({7, 31, 1e9}, done, 0.0, [&] {
            looks.push_back(done);
            return false;
        });
    EXPECT_EQ(looks, (std::vector<std::size_t>{7, 11, 15, 19, 23, 27}));
}

TEST(Repeat, StopsWhenItsTimeIsOver) {
    EXPECT_TRUE(goes_on({7, 31, 2.0}, 8, 1.9, wide));
    EXPECT_FALSE(goes_on({7, 31, 2.0}, 8, 2.0, wide));
    EXPECT_TRUE(goes_on({7, 31, 2.0}, 6, 3.0, narrow)) << "the least rounds are always made";
}

// A round of a minute does not follow if five seconds are allowed.
TEST(Repeat, MakesNoRoundThatIsLongerThanTheTimeLeft) {
    std::size_t rounds = 0;
    repeat(
        {5, 31, 1e-3},
        [&](std::size_t) {
            for (const Stopwatch stopwatch; stopwatch.seconds() < 2e-3;) {
            }
            ++rounds;
        },
        wide);
    EXPECT_EQ(rounds, 5u);
}

// A part whose intervals are narrow is left out of further rounds; the others go on to their own end.
TEST(Repeat, PartsEndByThemselves) {
    std::vector<std::size_t> first, second;
    const RoundPart parts[] = {{[&](std::size_t r) { first.push_back(r); }, [&] { return first.size() >= 10; }},
                               {[&](std::size_t r) { second.push_back(r); }, [&] { return second.size() >= 18; }}};
    repeat({7, 31, 1e9}, parts);
    EXPECT_EQ(first.size(), 11u) << "looked at after 7 and 11 rounds";
    EXPECT_EQ(second.size(), 19u);
    for (std::size_t i = 0; i < second.size(); ++i) EXPECT_EQ(second[i], i);
}

// Times with a known median. `median` takes the number of rounds made: for a machine that slows down, it is that of the
// mixture of their distributions.
struct Noise {
    std::string name;
    std::function<double(base::Random&, std::size_t round)> time;
    std::function<double(std::size_t rounds)> median;
};

double normal(base::Random& random) {
    return std::sqrt(-2.0 * std::log(1.0 - random.uniform())) * std::cos(6.283185307179586 * random.uniform());
}

double one(std::size_t) {
    return 1.0;
}

Noise lognormal(double deviation) {
    return {"lognormal", [=](base::Random& random, std::size_t) { return std::exp(deviation * normal(random)); }, one};
}

// A ratio of normal values: tails as heavy as those of Cauchy's distribution.
Noise heavy(double scale) {
    return {"heavy tails",
            [=](base::Random& random, std::size_t) {
                return std::exp(scale * std::clamp(normal(random) / normal(random), -20.0, 20.0));
            },
            one};
}

// Never early, sometimes late.
Noise late(double scale) {
    return {"late", [=](base::Random& random, std::size_t) { return 1.0 - scale * std::log(1.0 - random.uniform()); },
            [=](std::size_t) { return 1.0 + scale * std::log(2.0); }};
}

Noise drifting(double slower, double deviation) {
    const auto pace = [=](std::size_t round) { return 1.0 + slower * static_cast<double>(round) / 30.0; };
    return {"drift",
            [=](base::Random& random, std::size_t round) { return pace(round) * std::exp(deviation * normal(random)); },
            [=](std::size_t rounds) {
                double low = 0.5, high = 2.0;
                for (int i = 0; i < 60; ++i) {
                    const double middle = 0.5 * (low + high);
                    double below = 0.0;
                    for (std::size_t r = 0; r < rounds; ++r)
                        below += 0.5 * std::erfc(-std::log(middle / pace(r)) / (deviation * std::sqrt(2.0)));
                    (below < 0.5 * static_cast<double>(rounds) ? low : high) = middle;
                }
                return low;
            }};
}

// The share of series whose interval holds the median after the rule stopped.
double coverage(const Noise& noise, const RepeatRule& rule, double goal, std::uint64_t seed) {
    constexpr int series = 2500;
    base::Random random(base::hash(seed));
    std::vector<double> medians(rule.most + 1);
    for (std::size_t n = rule.least; n <= rule.most; ++n) medians[n] = noise.median(n);
    int held = 0;
    for (int i = 0; i < series; ++i) {
        std::vector<double> times;
        // As lookups of 100 ns: is_narrow() takes any interval of 0.01 ns as narrow.
        repeat(
            rule, [&](std::size_t round) { times.push_back(100.0 * noise.time(random, round)); },
            [&] { return results::is_narrow(results::summarise(times), goal); });
        const metrics::Interval interval = results::summarise(times).interval;
        const double median = 100.0 * medians[times.size()];
        held += interval.low <= median && median <= interval.high;
    }
    return static_cast<double>(held) / series;
}

std::vector<Noise> all_noises() {
    return {lognormal(0.03), lognormal(0.06),     lognormal(0.1),      lognormal(0.2),
            heavy(0.01),     heavy(0.03),         late(0.03),          late(0.07),
            late(0.15),      drifting(0.1, 0.04), drifting(0.3, 0.04), drifting(0.3, 0.1)};
}

// 2,500 series put the measured coverage within 1 % of the true one (two standard deviations).
TEST(Repeat, IntervalsHoldTheMedianInMoreThan93PercentAfterStopping) {
    std::uint64_t seed = 0;
    for (const Noise& noise : all_noises())
        for (const double goal : {0.02, 0.03, 0.05, 0.1})
            for (const std::size_t least : {5u, 7u, 9u})
                EXPECT_GE(coverage(noise, {least, 31, 1e9}, goal, ++seed), 0.93)
                    << noise.name << ", series " << seed << ", goal " << goal << ", least " << least;
}

// The rule of the lookups that the papers' claims compare.
TEST(Repeat, IntervalsOfMoreRoundsHoldItAsOften) {
    std::uint64_t seed = 1000;
    for (const Noise& noise : all_noises())
        for (const double goal : {0.03, 0.05, 0.1})
            EXPECT_GE(coverage(noise, {15, 39, 1e9}, goal, ++seed), 0.93)
                << noise.name << ", series " << seed << ", goal " << goal;
}

}  // namespace
}  // namespace shadowbench::bench
