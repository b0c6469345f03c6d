// Verdicts of claims of several parts.
#include <gtest/gtest.h>

#include <cstddef>
#include <iterator>
#include <set>
#include <vector>

#include "claims/rules.h"

namespace shadowbench::claims {
namespace {

Verdict verdict(const Judged& judged) {
    return judged.verdict;
}

TEST(JoinedRules, TwoHalvesAreAsGoodAsTheWorse) {
    const Judged good = judge_fit(exactly(0.01)), shape = judge_fit(exactly(0.03)),
                 open = judge_fit({0.02, 0.01, 0.03}), bad = judge_fit(exactly(0.1));
    EXPECT_EQ(verdict(both(good, shape)), Verdict::in_shape);
    EXPECT_EQ(verdict(both(open, good)), Verdict::undecided);
    EXPECT_EQ(verdict(both(open, shape)), Verdict::in_shape) << "the open one holds or is in shape";
    EXPECT_EQ(verdict(both(bad, open)), Verdict::fails);
    EXPECT_EQ(verdict(both(good, not_comparable())), Verdict::not_comparable);
    EXPECT_EQ(both(good, good).limits, good.limits);
    EXPECT_EQ(both(good, judge_constant(exactly(1))).rule, "fit, constant");
}

TEST(JoinedRules, MostAndAllCountCases) {
    const Judged good = judge_fit(exactly(0.01)), shape = judge_fit(exactly(0.03)),
                 open = judge_fit({0.02, 0.01, 0.03}), bad = judge_fit(exactly(0.1));
    EXPECT_EQ(verdict(in_most({good, good, good, bad})), Verdict::holds);
    EXPECT_EQ(verdict(in_most({good, good, shape, bad})), Verdict::in_shape);
    EXPECT_EQ(verdict(in_most({good, good, open, bad})), Verdict::undecided);
    EXPECT_EQ(verdict(in_most({good, bad, bad, bad})), Verdict::fails);
    EXPECT_EQ(verdict(in_most({good, shape, open, bad})), Verdict::in_shape) << "whether the open one holds or not";
    EXPECT_EQ(verdict(in_all({good, shape, open})), Verdict::in_shape);
    EXPECT_EQ(verdict(in_all({good, good, good})), Verdict::holds);
    EXPECT_EQ(verdict(in_all({good, good, good, bad})), Verdict::in_shape);
    EXPECT_EQ(verdict(in_all({good, bad, bad})), Verdict::fails);
    EXPECT_EQ(verdict(in_all({good, good, open})), Verdict::undecided);
    EXPECT_EQ(verdict(in_all({good, good, open, bad})), Verdict::undecided) << "in shape if the open one holds";
    EXPECT_EQ(verdict(in_all({good, shape, open, bad})), Verdict::fails) << "whatever the open one does";
}

TEST(JoinedRules, ReadingsThatDisagreeDecideNothing) {
    const Judged good = judge_fit(exactly(0.01)), shape = judge_fit(exactly(0.03)),
                 open = judge_fit({0.02, 0.01, 0.03}), bad = judge_fit(exactly(0.1));
    EXPECT_EQ(verdict(in_readings({good, good})), Verdict::holds);
    EXPECT_EQ(verdict(in_readings({bad, bad, bad})), Verdict::fails);
    EXPECT_EQ(verdict(in_readings({shape, shape})), Verdict::in_shape);
    EXPECT_EQ(verdict(in_readings({good, good, bad})), Verdict::undecided) << "a majority of readings is no reading";
    EXPECT_EQ(verdict(in_readings({good, shape})), Verdict::undecided);
    EXPECT_EQ(verdict(in_readings({bad, open})), Verdict::undecided);
    EXPECT_EQ(in_readings({good, good}).limits, "in all readings: " + good.limits);
    const Judged constant = judge_constant(exactly(1));
    EXPECT_EQ(in_readings({good, good, constant}).rule, "fit, constant");
    EXPECT_EQ(in_readings({good, good, constant}).limits, "in all readings: " + good.limits + "; " + constant.limits);
}

TEST(JoinedRules, AClaimThatACaseCanBeFoundHasTheBestVerdictOfAll) {
    const Judged good = judge_fit(exactly(0.01)), fair = judge_fit(exactly(0.03)), bad = judge_fit(exactly(1)),
                 open = judge_fit({0.03, 0.01, 0.1});
    EXPECT_EQ(verdict(in_any({bad, good, fair})), Verdict::holds);
    EXPECT_EQ(verdict(in_any({bad, fair})), Verdict::in_shape);
    EXPECT_EQ(verdict(in_any({bad, bad})), Verdict::fails);
    EXPECT_EQ(verdict(in_any({open, good})), Verdict::holds) << "whatever the open one is";
    const Judged found = in_any({bad, fair, open});
    EXPECT_EQ(verdict(found), Verdict::undecided);
    EXPECT_EQ(found.best, Verdict::holds);
    EXPECT_EQ(found.worst, Verdict::in_shape);
    EXPECT_EQ(found.limits, "in any: " + bad.limits);
}

TEST(JoinedRules, AnUndecidedVerdictIsOneFromItsBestToItsWorst) {
    const Judged near = judge_fit({0.02, 0.01, 0.03}), far = judge_fit({0.05, 0.03, 0.06}),
                 wide = judge_fit({0.03, 0.01, 0.1}), good = judge_fit(exactly(0.01));
    EXPECT_EQ(near.best, Verdict::holds);
    EXPECT_EQ(near.worst, Verdict::in_shape);
    EXPECT_EQ(far.best, Verdict::in_shape);
    EXPECT_EQ(far.worst, Verdict::fails);
    EXPECT_EQ(wide.best, Verdict::holds);
    EXPECT_EQ(wide.worst, Verdict::fails);
    EXPECT_EQ(good.best, good.worst);
    EXPECT_EQ(verdict(both(in_readings({good, judge_fit(exactly(0.03))}), judge_fit(exactly(0.03)))), Verdict::in_shape)
        << "whichever reading is meant";
}

// All ways to combine four parts, each of a verdict or undecided between two: the oracle puts every verdict that an
// undecided part may have in its place.
TEST(JoinedRules, AClaimWithUndecidedPartsIsDecidedIfAllOutcomesAgree) {
    const Verdict decided[] = {Verdict::holds, Verdict::in_shape, Verdict::fails};  // from the best to the worst
    struct Kind {
        std::size_t best, worst;
    };
    const Kind kinds[] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}};
    constexpr std::size_t parts = 4, all = 6 * 6 * 6 * 6;
    using Join = Judged (*)(const std::vector<Judged>&);
    const Join joins[] = {in_all, in_any, in_most, in_readings, [](const std::vector<Judged>& some) {
                              return both(both(some[0], some[1]), both(some[2], some[3]));
                          }};
    for (const Join& join : joins)
        for (std::size_t number = 0; number < all; ++number) {
            std::vector<Judged> judged;
            std::vector<Kind> of;
            for (std::size_t i = 0, rest = number; i < parts; ++i, rest /= std::size(kinds)) {
                const Kind& kind = of.emplace_back(kinds[rest % std::size(kinds)]);
                const bool open = kind.best != kind.worst;
                judged.push_back({open ? Verdict::undecided : decided[kind.best], "fit", "", decided[kind.best],
                                  decided[kind.worst]});
            }
            std::set<Verdict> outcomes;
            for (std::size_t choice = 0; choice < 3 * 3 * 3 * 3; ++choice) {
                std::vector<Judged> one;
                for (std::size_t i = 0, rest = choice; i < parts; ++i, rest /= 3)
                    if (rest % 3 >= of[i].best && rest % 3 <= of[i].worst)
                        one.push_back({decided[rest % 3], "fit", ""});
                if (one.size() == parts) outcomes.insert(verdict(join(one)));
            }
            ASSERT_FALSE(outcomes.empty());
            EXPECT_EQ(verdict(join(judged)), outcomes.size() == 1 ? *outcomes.begin() : Verdict::undecided)
                << "parts " << number;
        }
}

}  // namespace
}  // namespace shadowbench::claims
