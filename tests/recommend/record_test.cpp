#include "recommend/record.h"

#include <gtest/gtest.h>

#include <limits>

#include <nlohmann/json.hpp>

#include "base/error.h"

namespace shadowbench::recommend {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

Exploration two_families() {
    const Axis resolution{"resolution", {"16", "32", "[64,32]"}, 2}, samples{"samples_per_pixel", {"1", "4"}, 1};
    Exploration found;
    found.goal = {0.02, {true, false, true}, {infinity, 4096.0, infinity}, 300.0};
    found.families = {
        {"deep", "deep kernel=tent", {resolution, samples, {"tolerance", {"0.2", "0.1"}, 1}}, {{"kernel", "\"tent\""}}},
        {"ray_traced", "ray_traced", {{"resolution", {"16"}, 1}, {"samples_per_pixel", {"4"}, 1}}, {}}};
    found.scout = 0;
    found.measured = {{{0, {1, 0, 1}}, {"", 0.031, {12.5, 4000.0, 0.25}}}, {{1, {0, 0}}, {"fell over", 0.0, {}}}};
    Confirmed confirmed;
    confirmed.error = {0.01, infinity};
    confirmed.mean_error = 0.015;
    confirmed.cost = {13.0, 4000.0, 0.26};
    confirmed.interval = {metrics::Interval{12.0, 14.0}, metrics::Interval{4000.0, 4000.0},
                          metrics::Interval{0.2, 0.3}};
    found.confirmed = {{{0, {2, 1, 0}}, confirmed}};
    found.end = End::budget;
    found.steal = 0.125;
    found.before = 12.5;
    found.next = NextStep{41.0, 34.0};
    return found;
}

TEST(Record, IsReadBackAsItWasWritten) {
    const Exploration found = two_families();
    const nlohmann::json written = nlohmann::json::parse(to_json(found).dump());
    const Exploration read = exploration_from_json(written, "result.json");
    EXPECT_EQ(nlohmann::json::parse(to_json(read).dump()), written);
    EXPECT_EQ(read.goal.asked, found.goal.asked);
    EXPECT_EQ(read.goal.at_most, found.goal.at_most);
    EXPECT_EQ(read.end, End::budget);
    EXPECT_EQ(read.steal, 0.125);
    nlohmann::json earlier = written;  // written by a version that did not note it
    for (const char* name : {"steal", "before_seconds", "next"}) earlier.erase(name);
    EXPECT_EQ(exploration_from_json(earlier, "result.json").steal, std::nullopt);
    EXPECT_EQ(exploration_from_json(earlier, "result.json").next.has_value(), false);
    EXPECT_EQ(read.before, 12.5);
    ASSERT_TRUE(read.next);
    EXPECT_EQ(read.next->seconds, 41.0);
    EXPECT_EQ(read.next->left, 34.0);
    EXPECT_EQ(read.scout, found.scout);
    EXPECT_EQ(read.families[0].axes[0].values, found.families[0].axes[0].values);
    EXPECT_EQ(read.measured[0].point, found.measured[0].point);
    EXPECT_EQ(read.measured[0].trial.cost, found.measured[0].trial.cost);
    EXPECT_EQ(read.measured[1].trial.failed, "fell over");
    EXPECT_EQ(read.confirmed[0].confirmed.error.high, infinity);
    EXPECT_EQ(read.confirmed[0].confirmed.interval[0].low, 12.0);
}

TEST(Record, RefusesPointsThatDoNotExist) {
    const nlohmann::json good = nlohmann::json::parse(to_json(two_families()).dump());
    for (const char* change :
         {R"([{"op": "replace", "path": "/measured/0/family", "value": 2}])",
          R"([{"op": "replace", "path": "/measured/0/step", "value": [0, 0]}])",
          R"([{"op": "replace", "path": "/confirmed/0/step", "value": [3, 0, 0]}])",
          R"([{"op": "replace", "path": "/scout", "value": 2}])", R"([{"op": "remove", "path": "/families/0/axes"}])"})
        EXPECT_THROW(exploration_from_json(good.patch(nlohmann::json::parse(change)), "file"), base::Error) << change;
}

TEST(Record, GivesTheLineOfAScenario) {
    const std::vector<Family> families = two_families().families;
    EXPECT_EQ(scenario_part(families[0], {0, {2, 1, 1}}).dump(),
              R"({"rays":{"resolution":[64,32],"samples_per_pixel":4},)"
              R"("techniques":[{"type":"deep","tolerance":0.1,"kernel":"tent"}]})");
    EXPECT_EQ(scenario_part(families[1], {1, {0, 0}}).dump(), R"({"techniques":[{"type":"ray_traced"}]})");
}

}  // namespace
}  // namespace shadowbench::recommend
