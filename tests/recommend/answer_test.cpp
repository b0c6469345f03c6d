#include "recommend/answer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "recommend/search.h"
#include "recommend/synthetic.h"

namespace shadowbench::recommend::test {
namespace {

using testing::HasSubstr;
using testing::Not;

Family family(const std::string& technique) {
    return {
        technique, technique + " filter=box", {axis("resolution", 9, 2), axis("samples", 5, 2), axis("nodes", 7, 2)}};
}

Confirmed confirmed(double error, double lookup, double bytes, double build) {
    Confirmed result;
    result.error = {error * 0.96, error * 1.04};
    result.mean_error = error;
    result.cost = {lookup, bytes, build};
    for (std::size_t k = 0; k < costs; ++k) result.interval[k] = {result.cost[k] * 0.98, result.cost[k] * 1.02};
    result.interval[1] = {bytes, bytes};
    return result;
}

// Explorations by hand.
struct Made {
    Exploration found;

    explicit Made(std::vector<std::string> techniques) {
        found.goal.error = 0.02;
        for (const std::string& technique : techniques) found.families.push_back(family(technique));
    }
    Made& trial(std::size_t f, std::vector<int> step, double error, std::array<double, costs> cost,
                const std::string& failed = {}) {
        found.measured.push_back({{f, std::move(step)}, {failed, error, cost}});
        return *this;
    }
    Made& sure(std::size_t f, std::vector<int> step, double error, std::array<double, costs> cost) {
        trial(f, step, error, cost);
        found.confirmed.push_back({{f, std::move(step)}, confirmed(error, cost[0], cost[1], cost[2])});
        return *this;
    }
    Answer answered() const { return answer(found, found.goal); }
};

Cheapest of(const Answer& answer, Cost cost) {
    return answer.cheapest[static_cast<std::size_t>(cost)].value();
}

TEST(Answer, NamesTheCheapestPerCostAndTheBestOfAnotherTechnique) {
    Made made({"deep", "avsm"});
    made.sure(0, {2, 2, 2}, 0.018, {20, 5000, 9}).sure(0, {3, 2, 2}, 0.015, {18, 9000, 12});
    made.sure(1, {2, 3, 1}, 0.017, {27, 4000, 8}).sure(1, {4, 3, 1}, 0.0198, {10, 1000, 1});  // up to 0.0206
    const Answer result = made.answered();
    EXPECT_TRUE(result.reached);
    EXPECT_EQ(of(result, Cost::lookup).best.point, (Point{0, {3, 2, 2}}));
    EXPECT_EQ(of(result, Cost::lookup).runner_up->point, (Point{1, {2, 3, 1}}));
    EXPECT_NEAR(of(result, Cost::lookup).behind, 0.5, 1e-12);
    EXPECT_FALSE(of(result, Cost::lookup).tie);
    EXPECT_EQ(of(result, Cost::bytes).best.point, (Point{1, {2, 3, 1}}));
    EXPECT_NEAR(of(result, Cost::bytes).behind, 0.25, 1e-12);
    EXPECT_FALSE(result.closest);
    EXPECT_TRUE(result.missed.empty());
}

TEST(Answer, CallsOverlappingIntervalsATie) {
    Made made({"deep", "avsm"});
    made.sure(0, {2, 2, 2}, 0.018, {20, 5000, 9}).sure(1, {2, 3, 1}, 0.017, {20.5, 5000, 9.9});
    const Answer result = made.answered();
    EXPECT_TRUE(of(result, Cost::lookup).tie);
    EXPECT_TRUE(of(result, Cost::bytes).tie);
    EXPECT_FALSE(of(result, Cost::build).tie);
    EXPECT_THAT(to_text(result, made.found.families, {"rms", {}}), HasSubstr("a tie with 20.5 ns, avsm"));
}

TEST(Answer, AnotherErrorIsAnsweredFromTheSamePoints) {
    Made made({"deep", "avsm"});
    made.sure(0, {2, 2, 2}, 0.018, {20, 5000, 9}).sure(0, {4, 4, 4}, 0.009, {30, 20000, 40});
    made.trial(1, {3, 3, 3}, 0.005, {10, 3000, 5});
    Goal finer = made.found.goal;
    finer.error = 0.01;
    const Cheapest lookup = of(answer(made.found, finer), Cost::lookup);
    EXPECT_EQ(lookup.best.point, (Point{0, {4, 4, 4}}));
    ASSERT_TRUE(lookup.perhaps);
    EXPECT_EQ(lookup.perhaps->point, (Point{1, {3, 3, 3}}));
    finer.error = 0.006;
    const Answer unsure = answer(made.found, finer);
    EXPECT_TRUE(unsure.reached);
    EXPECT_FALSE(of(unsure, Cost::bytes).best.confirmed);
    EXPECT_THAT(to_text(unsure, made.found.families, {"rms", {}}), HasSubstr("not confirmed"));
}

TEST(Answer, TrialsAreTrustedLessByWhatConfirmingAddsToTheOthers) {
    Made made({"deep"});
    for (int i = 0; i < 3; ++i) made.sure(0, {i, 2, 2}, 0.03, {20, 5000, 9});  // the upper ends are 4 % higher
    made.trial(0, {5, 5, 5}, 0.0195, {20, 5000, 9});
    EXPECT_FALSE(made.answered().reached);
    made.trial(0, {6, 5, 5}, 0.0190, {20, 5000, 9});
    EXPECT_TRUE(made.answered().reached);
}

TEST(Answer, LimitsHoldForTheUpperEndsOfIntervals) {
    Made made({"deep", "avsm"});
    made.sure(0, {2, 2, 2}, 0.018, {20, 5000, 9}).sure(1, {2, 3, 1}, 0.017, {30, 4000, 9});
    made.found.goal.at_most[0] = 20.2;  // the interval of 20 ends at 20.4
    const Answer result = made.answered();
    EXPECT_FALSE(result.reached);
    ASSERT_EQ(result.missed.size(), 2u);
    for (const Missed& missed : result.missed) EXPECT_EQ(missed.held, Held::at_most);
    made.found.goal.at_most[0] = 20.5;
    EXPECT_EQ(of(made.answered(), Cost::bytes).best.point, (Point{0, {2, 2, 2}}));
}

TEST(Answer, WithoutAMapOnlyLookupsCompete) {
    Made made({"deep", "ray_traced"});
    made.found.families[1].mapless = true;
    made.sure(0, {2, 2, 2}, 0.018, {20, 5000, 9}).sure(1, {2, 3, 1}, 0.017, {900, 0, 0.01});
    const Answer result = made.answered();
    EXPECT_EQ(of(result, Cost::bytes).best.point.family, 0u);
    EXPECT_FALSE(of(result, Cost::bytes).runner_up);
    EXPECT_EQ(of(result, Cost::build).best.point.family, 0u);
    EXPECT_EQ(of(result, Cost::lookup).best.point.family, 0u);
    EXPECT_EQ(of(result, Cost::lookup).runner_up->point.family, 1u);
    ASSERT_TRUE(result.without_map);
    EXPECT_THAT(to_text(result, made.found.families, {"rms", {}}), HasSubstr("without a map: ray_traced"));
    made.sure(1, {1, 1, 1}, 0.018, {10, 0, 0.01});
    EXPECT_EQ(of(made.answered(), Cost::lookup).best.point.family, 1u);
    EXPECT_EQ(of(made.answered(), Cost::lookup).runner_up->point.family, 0u);
}

TEST(Answer, CallsATechniqueDearThatCostsMoreBeforeItReachesTheError) {
    Made made({"deep", "dear", "thrifty"});
    made.sure(0, {2, 2, 2}, 0.018, {20, 5000, 9});
    made.trial(1, {3, 3, 3}, 0.03, {40, 9000, 20}).trial(2, {3, 3, 3}, 0.03, {40, 4000, 20});
    made.found.end = End::budget;
    const Answer result = made.answered();
    ASSERT_EQ(result.missed.size(), 2u);
    EXPECT_EQ(result.missed[0].held, Held::dear);
    EXPECT_EQ(result.missed[1].held, Held::budget);
}

TEST(Answer, SaysIfConfirmingWasCut) {
    Made made({"deep"});
    made.sure(0, {2, 2, 2}, 0.018, {20, 5000, 9});
    EXPECT_FALSE(made.answered().cut);
    made.found.confirmed[0].confirmed.cut = true;
    EXPECT_TRUE(made.answered().cut);
    EXPECT_THAT(to_text(made.answered(), made.found.families, {"rms", {}}), HasSubstr("ran out"));
}

TEST(Answer, SaysIfTheHostTookMuchOfTheTime) {
    Made made({"deep"});
    made.sure(0, {2, 2, 2}, 0.018, {20, 5000, 9});
    for (const std::optional<double> little : {std::optional<double>(), std::optional<double>(0.01)}) {
        made.found.steal = little;
        EXPECT_THAT(to_text(made.answered(), made.found.families, {"rms", {}}), Not(HasSubstr("steal")));
    }
    made.found.steal = 0.144;
    EXPECT_THAT(to_text(made.answered(), made.found.families, {"rms", {}}), HasSubstr("took 14 % of the time (steal)"));
}

TEST(Answer, SaysWhatHoldsATechniqueBack) {
    // Of every technique, three points of a climb; the scout is "uncompressed".
    const auto climb = [](Made& made, std::size_t f, double first, double middle, double last) {
        made.trial(f, {0, 0, 0}, first, {1, 1, 1});
        made.trial(f, {4, 2, 3}, middle, {1, 1, 1});
        made.trial(f, {8, 4, 6}, last, {1, 1, 1});
    };
    Made made({"uncompressed", "falls", "stays"});
    made.found.scout = 0;
    climb(made, 0, 0.2, 0.05, 0.01);
    climb(made, 1, 0.3, 0.15, 0.05);
    climb(made, 2, 0.3, 0.101, 0.1);
    Answer result = made.answered();
    ASSERT_EQ(result.missed.size(), 2u);
    EXPECT_EQ(result.missed[0].held, Held::representation);
    EXPECT_EQ(result.missed[1].held, Held::bias);
    EXPECT_EQ(result.missed[1].closest->point, (Point{2, {8, 4, 6}}));

    made.found.end = End::budget;
    EXPECT_EQ(made.answered().missed[0].held, Held::budget);
    EXPECT_EQ(made.answered().missed[1].held, Held::bias);

    made.found.end = End::complete;
    made.found.goal.error = 0.005;  // even the scout misses it
    result = made.answered();
    ASSERT_EQ(result.missed.size(), 3u);
    EXPECT_EQ(result.missed[0].held, Held::rays);
    EXPECT_EQ(result.missed[1].held, Held::rays);
    EXPECT_EQ(result.missed[2].held, Held::bias);
    EXPECT_FALSE(result.reached);
    ASSERT_TRUE(result.closest);
    EXPECT_EQ(result.closest->point, (Point{0, {8, 4, 6}}));
    const std::string text = to_text(result, made.found.families, {"rms", {}});
    EXPECT_THAT(text, HasSubstr("no setting reaches it"));
    EXPECT_THAT(text, HasSubstr("rays too few: uncompressed (0.01), falls (0.05)"));
}

TEST(Answer, NamesWhatBrokeAPromiseAndWhatWasNotMeasured) {
    Made made({"deep", "fourier", "partly", "late"});
    made.found.end = End::budget;
    made.sure(0, {2, 2, 2}, 0.018, {20, 5000, 9});
    made.trial(1, {0, 0, 0}, 0.0, {}, "visibility rises by 0.2").trial(1, {2, 2, 2}, 0.0, {}, "outside [0, 1]");
    made.trial(2, {0, 0, 0}, 0.3, {5, 5, 5}).trial(2, {2, 2, 2}, 0.001, {}, "outside [0, 1]");
    const Answer result = made.answered();
    ASSERT_EQ(result.broken.size(), 2u);
    EXPECT_EQ(result.broken[0].settings, 2u);
    EXPECT_EQ(result.broken[0].reason, "visibility rises by 0.2");
    EXPECT_EQ(result.broken[1].settings, 1u);
    EXPECT_EQ(result.broken[1].measured, 2u);
    EXPECT_FALSE(of(result, Cost::lookup).runner_up);
    const std::string text = to_text(result, made.found.families, {"rms", {}});
    EXPECT_THAT(text, HasSubstr("failed and left out: fourier (visibility rises by 0.2), partly (at 1 of 2 settings"));
    EXPECT_THAT(text, HasSubstr("late (not measured)"));
    EXPECT_THAT(text, HasSubstr("the budget ended first"));
}

// Otherwise the one technique that was followed passes for the cheapest.
TEST(Answer, BeginsWithABudgetThatEndedBeforeHalfOfTheTechniquesWereFollowed) {
    Made made({"uncompressed", "deep", "avsm", "late", "broken"});
    made.found.goal.budget = 90.0;
    made.sure(0, {2, 2, 2}, 0.018, {20, 5000, 1800}).trial(1, {0, 0, 0}, 0.3, {5, 5, 5});
    made.trial(2, {3, 3, 3}, 0.015, {300, 76555, 9000}).trial(4, {0, 0, 0}, 0.0, {}, "outside [0, 1]");
    made.found.end = End::budget;
    Wording wording{"rms", {}};
    wording.width = 400;
    const Answer result = made.answered();
    EXPECT_EQ(result.techniques, 4u);
    EXPECT_EQ(result.open, 2u);
    EXPECT_TRUE(result.too_early());
    EXPECT_THAT(to_text(result, made.found.families, wording),
                testing::StartsWith("THE BUDGET WAS TOO SHORT: 90s ended before 2 of 4 techniques were followed to the "
                                    "error, so cheaper settings are likely. Give 5min or more.\nrms error"));
    wording.again = [](double budget) { return "again --budget " + budget_text(budget); };
    EXPECT_THAT(to_text(result, made.found.families, wording), HasSubstr("go on with:\nagain --budget 5min\n"));
    made.found.end = End::complete;
    EXPECT_FALSE(made.answered().too_early());
    made.found.end = End::budget;
    made.trial(1, {3, 3, 3}, 0.015, {30, 50000, 900});
    EXPECT_FALSE(made.answered().too_early()) << "one of four is left";
    EXPECT_THAT(to_text(made.answered(), made.found.families, wording), Not(HasSubstr("TOO SHORT")));
}

// "The budget ended" with a third of it left is a riddle.
TEST(Answer, SaysWhatTheBudgetHadNoTimeForAndWhichTruthErrorsStandOn) {
    Made made({"deep"});
    made.sure(0, {2, 2, 2}, 0.018, {20, 5000, 9});
    made.found.end = End::budget;
    made.found.next = NextStep{41.2, 34.0};
    Wording wording{"rms", {}};
    wording.width = 400;
    EXPECT_THAT(to_text(made.answered(), made.found.families, wording),
                HasSubstr("the next step takes about 41.2 s, confirming included, and 34 s were left;"));
    EXPECT_THAT(to_text(made.answered(), made.found.families, wording), Not(HasSubstr("truth")));
    wording.truth = 0.0047;
    EXPECT_THAT(to_text(made.answered(), made.found.families, wording), HasSubstr("truth (standard error 0.0047)"));
}

TEST(Answer, CostsAreReadable) {
    EXPECT_EQ(cost_text(12.5, 0), "12.5 ns");
    EXPECT_EQ(cost_text(1234.0, 0), "1.23 µs");
    EXPECT_EQ(cost_text(2.5e6, 0), "2.5 ms");
    EXPECT_EQ(cost_text(904.0, 2), "904 ms");
    EXPECT_EQ(cost_text(1800.0, 2), "1.8 s");
    EXPECT_EQ(longer_budget(5.0), 300.0);
    EXPECT_EQ(longer_budget(301.0), 660.0);
    EXPECT_EQ(budget_text(660.0), "11min");
    EXPECT_EQ(budget_text(5.0), "5s");
    Made made({"deep", "uncompressed"});
    made.sure(0, {2, 2, 2}, 0.018, {20, 5000, 1800}).sure(1, {2, 2, 2}, 0.018, {300, 76550, 1900});
    const std::string text = to_text(made.answered(), made.found.families, {"rms", {}, 120});
    EXPECT_THAT(text, HasSubstr("15 x as much: 300 ns"));
    EXPECT_THAT(text, HasSubstr("6 % more: 1.9 s"));
    EXPECT_THAT(text, HasSubstr("build  1.8 s with capture: deep"));
}

TEST(Answer, APointThatFailedWhenConfirmedIsNoAnswer) {
    Made made({"deep"});
    made.sure(0, {2, 2, 2}, 0.018, {20, 5000, 9});
    made.found.confirmed[0].confirmed.failed = "visibility rises with seed 3";
    const Answer result = made.answered();
    EXPECT_FALSE(result.reached);
    ASSERT_EQ(result.broken.size(), 1u);
    EXPECT_EQ(result.broken[0].reason, "visibility rises with seed 3");
}

TEST(Answer, AnEmptyExplorationReachesNothing) {
    Made made({"deep"});
    made.found.end = End::cancelled;
    const Answer result = made.answered();
    EXPECT_FALSE(result.reached);
    EXPECT_FALSE(result.closest);
    EXPECT_THAT(to_text(result, made.found.families, {"rms", {}}), HasSubstr("cancelled"));
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
}

TEST(Answer, FitsTwentyLinesOfAHundredColumns) {
    // Long names, every cost with a tie and a doubtful point, all reasons, failures and a spent budget.
    std::vector<std::string> techniques;
    for (int i = 0; i < 40; ++i) techniques.push_back("technique_with_a_long_name_" + std::to_string(i));
    Made made(techniques);
    made.found.scout = 4;
    for (Family& one : made.found.families) one.name = one.technique + " filter=a_long_word kernel=another_long_word";
    made.sure(0, {2, 2, 2}, 0.018, {20, 5e9, 9}).sure(1, {2, 3, 1}, 0.017, {20.5, 5e9, 9});
    made.trial(2, {3, 3, 3}, 0.005, {1, 3, 0.5});
    made.trial(3, {3, 3, 3}, 0.001, {1e6, 1e12, 1e6});
    made.found.goal.at_most[1] = 1e11;
    for (std::size_t f = 4; f < 30; ++f) {
        made.trial(f, {0, 0, 0}, 0.5, {1, 1, 1});
        made.trial(f, {8, 4, 6}, f % 2 ? 0.49 : 0.1, {1, 1, 1});
    }
    for (std::size_t f = 30; f < 39; ++f)
        made.trial(f, {0, 0, 0}, 0.0, {}, "a long reason why it failed: " + std::string(90, 'x'));
    made.found.end = End::budget;
    const Wording wording{"p99",
                          [](const Point& point) { return "{\"technique\": " + std::to_string(point.family) + "}"; }};
    const std::vector<std::string> lines = lines_of(to_text(made.answered(), made.found.families, wording));
    // A setting is there to be copied: it goes on in a further line, and is never cut.
    const auto goes_on = [](const std::string& line) { return line.starts_with("         "); };
    EXPECT_LE(lines.size() - static_cast<std::size_t>(std::count_if(lines.begin(), lines.end(), goes_on)), text_lines);
    EXPECT_LE(lines.size(), 26u);
    for (const std::string& line : lines) {
        if (line.find("resolution=") != std::string::npos) { EXPECT_THAT(line, Not(HasSubstr("..."))) << line; }
    }
    for (const std::string& line : lines) EXPECT_LE(line.size(), text_columns) << line;
    EXPECT_THAT(lines.back(), HasSubstr("the budget ended first"));
    EXPECT_THAT(lines, testing::Contains("{\"technique\": 0}"));
    EXPECT_THAT(lines, testing::Contains(HasSubstr("failed and left out: technique_with_a_long_name_30")));
}

// Otherwise a terminal breaks the lines anywhere, or the settings of an answer end in dots.
TEST(Answer, GoesOnInTheNextLineWhereItDoesNotFit) {
    Made made({"deep", "avsm"});
    made.found.families[0].name = "deep kernel=tent compression=optimal mip=none probes=8 tolerance=0.0508";
    made.sure(0, {2, 2, 2}, 0.018, {20, 5e9, 9}).sure(1, {2, 3, 1}, 0.017, {20.5, 5e9, 9});
    Wording wording{"rms", [](const Point&) { return "{\"technique\": \"" + std::string(80, 'x') + "\"}"; }, 60};
    const std::string text = to_text(made.answered(), made.found.families, wording);
    for (const std::string& line : lines_of(text)) EXPECT_LE(line[0] == '{' ? 0 : line.size(), 60u) << line;
    EXPECT_THAT(text, HasSubstr("{\"technique\": \"" + std::string(80, 'x') + "\"}\n"));
    EXPECT_THAT(text, HasSubstr("lookup 20 ns: deep kernel=tent compression=optimal mip=none\n         probes=8 "));
    EXPECT_THAT(text, Not(HasSubstr("...")));
    wording.width = 120;
    EXPECT_THAT(to_text(made.answered(), made.found.families, wording),
                HasSubstr("probes=8 tolerance=0.0508 nodes=2, resolution=2 samples=2\n"));
}

TEST(Answer, ASettingIsWrittenAsAScenarioHasIt) {
    Family traced = family("ray_traced");
    traced.axes[0] = {"resolution", {""}, 1};
    traced.axes[1] = {"samples_per_pixel", {""}, 1};
    const std::vector<Family> families{family("deep"), traced};
    EXPECT_EQ(setting_text(families, {0, {2, 3, 4}}), "deep filter=box nodes=4, resolution=2 samples=3");
    EXPECT_EQ(setting_text(families, {1, {0, 0, 4}}), "ray_traced filter=box nodes=4");
}

TEST(Curves, HoldWhatNoOtherSettingOfTheTechniqueBeats) {
    Made made({"deep", "avsm"});
    made.trial(0, {0, 0, 0}, 0.3, {10, 100, 1})
        .trial(0, {1, 0, 0}, 0.2, {12, 200, 1})
        .trial(0, {0, 1, 0}, 0.25, {15, 300, 1});
    made.trial(0, {2, 2, 2}, 0.05, {20, 50, 1}).trial(0, {3, 3, 3}, 0.01, {}, "failed");
    made.trial(1, {0, 0, 0}, 0.9, {30, 10, 1});
    const std::vector<Curve> lookup = curves(made.found, Cost::lookup), bytes = curves(made.found, Cost::bytes);
    ASSERT_EQ(lookup.size(), 2u);
    ASSERT_EQ(lookup[0].points.size(), 3u);
    EXPECT_EQ(lookup[0].points[0].point, (Point{0, {0, 0, 0}}));
    EXPECT_EQ(lookup[0].points[2].point, (Point{0, {2, 2, 2}}));
    EXPECT_EQ(lookup[1].points.size(), 1u);
    ASSERT_EQ(bytes[0].points.size(), 1u);
    EXPECT_EQ(bytes[0].points[0].point, (Point{0, {2, 2, 2}}));
}

TEST(Curves, OfAnExplorationReachFromTheCheapestSettingToTheLeastError) {
    const RandomCase random = random_case(5);
    SyntheticLab lab(random.laws, {}, 1);
    Goal goal;
    goal.error = 0.3 * random.error;
    const Exploration found = explore(lab, goal, {});
    for (const Curve& curve : curves(found, Cost::build)) {
        double most = 0.0, least = 1.0;
        for (const Measured& measured : found.measured) {
            if (found.families[measured.point.family].technique != curve.technique) continue;
            most = std::max(most, measured.trial.error);
            least = std::min(least, measured.trial.error);
        }
        ASSERT_GE(curve.points.size(), 2u) << curve.technique;  // a climb that cannot reach the error ends after two
        EXPECT_EQ(curve.points.front().error.low, most);
        EXPECT_NEAR(curve.points.back().error.low, least, 1e-12);
    }
}

}  // namespace
}  // namespace shadowbench::recommend::test
