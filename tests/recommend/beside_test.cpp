#include "recommend/beside.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "bench/run.h"
#include "recommend/answer.h"
#include "recommend/of_run.h"
#include "recommend/two_layers.h"

namespace shadowbench::recommend {
namespace {

using nlohmann::json;
using testing::HasSubstr;

json scenario(int resolution, const json& techniques) {
    json document = two_layers();
    document["rays"]["resolution"] = resolution;
    document["receivers"] = {{"type", "probes"}, {"count", 1000}, {"footprint", {{"share", 0.06}}}};
    document["reference"] = {{"samples_per_pixel", 256}, {"queries", 100}, {"spread_seeds", 2}};
    document["techniques"] = techniques;
    return document;
}

const json deep = json::array({{{"type", "deep"}, {"tolerance", 0.02}}});
const json slices = json::array({{{"type", "opacity"}, {"slices", 64}}, {{"type", "variance"}}});

Recommendation ran(const json& document) {
    bench::RunOptions options;
    options.threads = 2;
    return recommendation_of(bench::run(document, options, {}), "", Measure::rms, "run");
}

std::vector<Contest> held(const json& ours, const json& theirs, double error) {
    Goal goal;
    goal.error = error;
    return hold_beside(ours, {}, ran(ours), theirs, ran(theirs), goal, 20.0, {});
}

TEST(Beside, MeasuresBothAnswersAgain) {
    const json ours = scenario(16, deep), theirs = scenario(32, slices);
    const std::vector<Contest> contests = held(ours, theirs, 0.5);
    ASSERT_EQ(contests.size(), costs);
    const Contest& bytes = contests[static_cast<std::size_t>(Cost::bytes)];
    EXPECT_EQ(bytes.ours->text, "deep tolerance=0.02, resolution=16 samples_per_pixel=4");
    EXPECT_EQ(bytes.theirs->text, "variance, resolution=32 samples_per_pixel=4");
    EXPECT_EQ(bytes.theirs->measured.cost[1], 32 * 32 * 8.0);
    EXPECT_EQ(bytes.ratio->low, bytes.ours->measured.cost[1] / (32 * 32 * 8.0));
    EXPECT_EQ(bytes.ratio->high, bytes.ratio->low);
    EXPECT_GT(bytes.ours->measured.cost[0], 0.0);
    EXPECT_GT(bytes.ours->measured.error.high, bytes.ours->measured.error.low);
    const std::string text = to_text(contests, "rms", 0.5);
    EXPECT_THAT(text, HasSubstr("bytes  cheaper: ours over theirs"));
    EXPECT_THAT(text, HasSubstr("theirs 8 KiB, error"));
}

TEST(Beside, NamesTheSameSettingAndWhatOneDoesNotReach) {
    const json ours = scenario(16, deep), coarse = scenario(16, json::array({{{"type", "variance"}}}));
    EXPECT_THAT(to_text(held(ours, ours, 0.5), "rms", 0.5), HasSubstr("the same setting: ours over theirs 1.000"));
    Recommendation nothing = ran(coarse);
    for (Answered& row : nothing.exploration.confirmed) row.confirmed.error.high = 1.0;
    Goal goal;
    goal.error = 0.5;
    const auto contests = hold_beside(ours, {}, ran(ours), coarse, nothing, goal, 20.0, {});
    EXPECT_THAT(to_text(contests, "rms", 0.5), HasSubstr("only ours reaches it"));
}

TEST(Beside, RefusesAnswersToDifferentQuestions) {
    const json ours = scenario(16, deep);
    for (const auto& [pointer, value] : std::vector<std::pair<const char*, json>>{
             {"/receivers/count", 900}, {"/receivers/footprint/share", 0.05}, {"/scene/objects/0/opacity", 0.7},
             {"/lights/0/direction/0", 0.1}}) {
        json theirs = ours;
        theirs[json::json_pointer(pointer)] = value;
        try {
            held(ours, theirs, 0.5);
            ADD_FAILURE() << pointer;
        } catch (const base::Error& error) {
            EXPECT_THAT(error.what(), HasSubstr("different questions")) << pointer;
        }
    }
}

TEST(Beside, RefusesAnswersByDifferentMeasures) {
    const json ours = scenario(16, deep);
    Recommendation by_largest = ran(ours);
    by_largest.measure = Measure::max;
    Goal goal;
    goal.error = 0.5;
    EXPECT_THROW(hold_beside(ours, {}, ran(ours), ours, by_largest, goal, 20.0, {}), base::Error);
}

}  // namespace
}  // namespace shadowbench::recommend
