#include "recommend/of_run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "base/error.h"
#include "metrics/student.h"
#include "recommend/answer.h"

namespace shadowbench::recommend {
namespace {

results::Cell cell(const std::string& technique, const std::string& parameters, const std::string& json,
                   std::vector<double> errors, std::size_t bytes, double lookup_ns, double build_ms) {
    results::Cell made;
    made.technique = technique;
    made.parameters = parameters;
    made.parameters_json = json;
    made.bytes = bytes;
    made.lookup.emplace().norms = {3.0 * errors[0], errors[0], 0.0, 2.0 * errors[0]};
    for (std::size_t s = 1; s < errors.size(); ++s)
        made.over_seeds.push_back({{3.0 * errors[s], errors[s], 0.0, 2.0 * errors[s]}, bytes});
    results::CellTimes& times = made.times.emplace();
    times.build_ms = results::summarise({build_ms, build_ms * 1.1, build_ms * 0.9});
    times.random_order.ns = results::summarise({lookup_ns, lookup_ns * 1.02, lookup_ns * 0.98});
    return made;
}

results::VariantResult variant(int resolution, int side, std::vector<results::Cell> cells) {
    results::VariantResult made;
    made.settings = {{"/rays/resolution", std::to_string(resolution)},
                     {"/rays/samples_per_pixel", std::to_string(side * side)}};
    results::LightResult& light = made.lights.emplace_back();
    light.name = "sun";
    light.layout = {resolution, resolution, side, side, true};
    light.rays = 1000;
    light.agreement.emplace().times.capture_rays_per_second = 1e6;  // 1 ms
    light.times.setup_seconds = 0.002;
    light.reference.error_rms = 0.003;
    light.reference.error_max = 0.02;
    light.cells = std::move(cells);
    return made;
}

const std::vector<double> small_errors{0.010, 0.012, 0.011}, large_errors{0.050, 0.052, 0.048};

results::Result run() {
    results::Result made;
    made.name = "made";
    made.document = R"({"receivers": {"footprint": {"share": 0.01}}})";
    const std::string tent = R"({"type": "deep", "kernel": "tent", "tolerance": 0.02})";
    made.variants = {
        variant(64, 2, {cell("deep", "kernel=tent tolerance=0.02", tent, small_errors, 2000, 30, 5),
                        cell("variance", "", R"({"type": "variance"})", large_errors, 500, 10, 4)}),
        variant(32, 4, {cell("deep", "kernel=tent tolerance=0.02", tent, large_errors, 900, 20, 3),
                        cell("ray_traced", "", R"({"type": "ray_traced", "samples": 16})", small_errors, 0, 900, 0)})};
    return made;
}

Answer answer_of(const Recommendation& found, double error) {
    Goal goal;
    goal.error = error;
    return answer(found.exploration, goal);
}

TEST(RecommendationOfARun, NamesTheCheapestRow) {
    const Recommendation found = recommendation_of(run(), "", Measure::rms, "run");
    EXPECT_EQ(found.light, "sun");
    EXPECT_FALSE(found.footprint_share);
    const Answer coarse = answer_of(found, 0.06), fine = answer_of(found, 0.02);
    EXPECT_EQ(coarse.cheapest[1]->best.cost[1], 500.0);
    EXPECT_EQ(coarse.cheapest[0]->best.cost[0], 10.0);
    EXPECT_EQ(setting_text(found.exploration.families, coarse.cheapest[1]->best.point),
              "variance, resolution=64 samples_per_pixel=4");
    EXPECT_EQ(fine.cheapest[1]->best.cost[1], 2000.0);
    EXPECT_EQ(setting_text(found.exploration.families, fine.cheapest[1]->best.point),
              "deep kernel=tent tolerance=0.02, resolution=64 samples_per_pixel=4");
    EXPECT_THAT(answer_text(found, fine.goal).text,
                ::testing::HasSubstr(R"({"type":"deep","kernel":"tent","tolerance":0.02})"));
    // Nothing is known of settings that the run does not have.
    ASSERT_EQ(fine.missed.size(), 1u);
    EXPECT_EQ(fine.missed[0].technique, "variance");
    EXPECT_EQ(fine.missed[0].held, Held::given);
    EXPECT_TRUE(fine.without_map);
}

TEST(RecommendationOfARun, ChargesTheCaptureAndTheSpreadOverSeeds) {
    const Recommendation found = recommendation_of(run(), "sun", Measure::rms, "run");
    const Confirmed& deep = found.exploration.confirmed[0].confirmed;
    EXPECT_DOUBLE_EQ(deep.cost[2], 5.0 + 2.0 + 1.0);
    EXPECT_DOUBLE_EQ(deep.interval[2].high, 5.5 + 3.0);
    EXPECT_DOUBLE_EQ(deep.error.high, metrics::mean_interval(small_errors).high);
    const Confirmed& traced = found.exploration.confirmed[3].confirmed;
    EXPECT_DOUBLE_EQ(traced.cost[2], 0.0);
    const Recommendation largest = recommendation_of(run(), "sun", Measure::max, "run");
    EXPECT_DOUBLE_EQ(largest.exploration.confirmed[0].confirmed.mean_error, 0.033);
}

TEST(RecommendationOfARun, OfRegularRaysIsExact) {
    results::Result regular = run();
    regular.variants.resize(1);
    regular.variants[0].lights[0].layout.jittered = false;
    for (results::Cell& row : regular.variants[0].lights[0].cells) row.over_seeds.clear();
    const Recommendation found = recommendation_of(regular, "", Measure::rms, "run");
    EXPECT_EQ(found.exploration.confirmed[0].confirmed.error.high, 0.010);
}

TEST(RecommendationOfARun, LeavesOutWhatFailed) {
    results::Result broken = run();
    results::Cell& row = broken.variants[0].lights[0].cells[0];
    row.status = results::CellStatus::failed;
    row.reason = "it rises";
    row.times.reset();
    const Answer fine = answer_of(recommendation_of(broken, "", Measure::rms, "run"), 0.02);
    EXPECT_FALSE(fine.cheapest[1]);
    ASSERT_EQ(fine.broken.size(), 1u);
    EXPECT_EQ(fine.broken[0].reason, "it rises");
}

TEST(RecommendationOfARun, RefusesRowsThatDoNotAnswerOneQuestion) {
    const auto refused = [](const std::function<void(results::Result&)>& change, Measure measure, const char* why) {
        results::Result made = run();
        change(made);
        try {
            recommendation_of(made, "", measure, "the run");
            ADD_FAILURE() << why;
        } catch (const base::Error& error) {
            EXPECT_THAT(error.what(), ::testing::HasSubstr(why));
        }
    };
    refused([](auto& made) { made.variants[0].settings.push_back({"/rays/seed", "2"}); }, Measure::rms, "/rays/seed");
    refused([](auto& made) { made.document = R"({"receivers": {"filter_width": 2}})"; }, Measure::rms,
            "receivers.footprint");
    refused(
        [](auto& made) {
            made.document = R"({"receivers": {"type": "camera", "footprint": {"share": 0.1}, "slope_bias": 0.5}})";
        },
        Measure::rms, "slope_bias is in map pixels");
    // Results are read from files, whose scenarios nobody has checked.
    for (const char* damaged : {R"({"lights": [{}]})", R"({"lights": [{"type": "spot", "name": "sun", "softness": {}}]})",
                                R"({"lights": [7]})", R"({"receivers": [1]})", R"({"receivers": {"footprint": {}}})"})
        refused([&](auto& made) { made.document = damaged; }, Measure::rms, "the run holds no valid scenario");
    refused([](auto& made) { made.variants[1].lights[0].cells[0].over_seeds.clear(); }, Measure::rms, "spread_seeds");
    refused([](auto&) {}, Measure::curve, "stored functions");
    refused([](auto& made) { made.variants.clear(); }, Measure::rms, "no rows");
    refused([](auto& made) { for (auto& v : made.variants) v.lights.push_back(v.lights[0]), v.lights[1].name = "sky"; },
            Measure::rms, "name one of: sun, sky");
}

TEST(RecommendationOfARun, GivesAFootprintInMapPixelsAsAShare) {
    results::Result made = run();
    made.document = R"({"receivers": {"filter_width": 2}})";
    made.variants.resize(1);
    EXPECT_DOUBLE_EQ(recommendation_of(made, "", Measure::rms, "run").footprint_share.value(), 2.0 / 64.0);
}

// The light's softness is a width in light space, so maps of all resolutions were asked the same.
TEST(RecommendationOfARun, TakesTheSoftnessOfItsLightForTheFootprint) {
    results::Result made = run();
    made.document = R"({"receivers": {"filter_width": 2}, "lights": [{"type": "directional", "direction": [0, -1, 0],
                        "name": "sun", "softness": {"share": 0.1}}]})";
    EXPECT_FALSE(recommendation_of(made, "", Measure::rms, "run").footprint_share);
}

}  // namespace
}  // namespace shadowbench::recommend
