#include "recommend/trials.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "document/document.h"
#include "recommend/two_layers.h"
#include "results/report.h"

namespace shadowbench::recommend {
namespace {

using nlohmann::json;

bench::RunOptions only(std::vector<std::string> ids) {
    bench::RunOptions options;
    options.only = std::move(ids);
    options.threads = 2;
    return options;
}

Trials trials_of(const json& document, std::vector<std::string> ids, Measure measure = Measure::rms) {
    return {document, only(std::move(ids)), "", measure, {}};
}

// The point of a family with the steps whose values are nearest to these, in order of the axes.
Point point_of(const Lab& lab, const std::string& family, const std::vector<double>& values) {
    for (std::size_t f = 0; f < lab.families().size(); ++f) {
        const Family& candidate = lab.families()[f];
        if (candidate.name != family) continue;
        Point point{f, {}};
        for (std::size_t a = 0; a < values.size(); ++a) {
            const std::vector<std::string>& steps = candidate.axes[a].values;
            const auto nearer = [&](const std::string& x, const std::string& y) {
                return std::abs(std::stod(x) - values[a]) < std::abs(std::stod(y) - values[a]);
            };
            point.step.push_back(
                static_cast<int>(std::min_element(steps.begin(), steps.end(), nearer) - steps.begin()));
        }
        return point;
    }
    ADD_FAILURE() << "no family " << family;
    return {};
}

TEST(Trials, MeasureTheSameErrorAndBytesAgain) {
    Trials trials = trials_of(two_layers(), {"deep", "pcf", "ray_traced"});
    for (const Point& point :
         {point_of(trials, "deep kernel=box mip=none", {32, 16, 0.0501}),
          point_of(trials, "pcf res_factor=1 storage=raw", {16, 4, 16}), point_of(trials, "ray_traced", {16, 4, 16})}) {
        const Trial a = trials.measure(point), b = trials.measure(point);
        EXPECT_EQ(a.failed, "");
        EXPECT_GT(a.error, 0.0);
        EXPECT_EQ(a.error, b.error);
        EXPECT_EQ(a.cost[static_cast<std::size_t>(Cost::bytes)], b.cost[static_cast<std::size_t>(Cost::bytes)]);
        EXPECT_GT(a.cost[static_cast<std::size_t>(Cost::lookup)], 0.0);
    }
}

// A run with another resolution, whose filter is as wide on the light's plane, asks the same question. Its truth comes
// from other rays, so the errors may differ by as much as the two truths do.
TEST(Trials, AtAnotherResolutionAgreeWithARunThere) {
    Trials trials = trials_of(two_layers(), {"deep"});
    for (const int resolution : {16, 23, 32, 91}) {
        const Point point = point_of(trials, "deep kernel=box mip=none", {1.0 * resolution, 16, 0.1});
        const Setting setting = trials.space().setting(point);
        ASSERT_EQ(setting.resolution.x, resolution);
        const Trial trial = trials.measure(point);
        json there = two_layers();
        there["rays"] = {{"resolution", resolution}, {"samples_per_pixel", 16}};
        there["receivers"]["filter_width"] = 1.5 * resolution / 16.0;
        there["techniques"] = {{{"type", "deep"}, {"tolerance", setting.values.number("tolerance")}}};
        const results::Result run = bench::run(there, only({}), {});
        const results::LightResult& light = run.variants[0].lights[0];
        const results::LightResult own = trials.result().variants[0].lights[0];
        const double doubt = std::hypot(light.reference.error_rms, own.reference.error_rms);
        EXPECT_NEAR(trial.error, light.cells[0].lookup->norms.rms, doubt) << resolution;
        EXPECT_EQ(trial.cost[static_cast<std::size_t>(Cost::bytes)], static_cast<double>(light.cells[0].bytes));
        EXPECT_LT(doubt, 0.1 * trial.error);
    }
}

// Two settings of one map, another map, and a setting that stores none.
TEST(Trials, TimeLookupsAgainInTurns) {
    Trials trials = trials_of(two_layers(), {"deep", "pcf", "ray_traced"});
    const std::vector<Point> points{point_of(trials, "pcf res_factor=1 storage=raw", {16, 4, 4}),
                                    point_of(trials, "pcf res_factor=1 storage=raw", {16, 4, 256}),
                                    point_of(trials, "deep kernel=box mip=none", {32, 16, 0.0501}),
                                    point_of(trials, "ray_traced", {16, 4, 16})};
    for (const Point& point : points) ASSERT_EQ(trials.measure(point).failed, "");
    const std::vector<std::optional<double>> ns = trials.time_again(points);
    ASSERT_EQ(ns.size(), points.size());
    for (const auto& one : ns) {
        ASSERT_TRUE(one);
        EXPECT_GT(*one, 0.0);
    }
    // Their maps are kept, and answer as before.
    const Trial before = trials.measure(points[2]), after = trials.measure(points[2]);
    EXPECT_EQ(before.error, after.error);
}

TEST(Trials, CaptureTheRaysOfAResolutionOnce) {
    Trials trials = trials_of(two_layers(), {"deep", "variance"});
    const Point deep = point_of(trials, "deep kernel=box mip=none", {256, 64, 0.1});
    const Point variance = point_of(trials, "variance filter=point", {256, 64});
    trials.measure(deep);
    const double there = trials.effort(variance);
    const Point other = point_of(trials, "variance filter=point", {256, 100});
    EXPECT_GT(trials.effort(other), there);
    trials.measure(variance);
    EXPECT_EQ(trials.result().variants.size(), 1u);
    EXPECT_EQ(trials.result().variants[0].lights[0].cells.size(), 2u);
}

TEST(Trials, KnowTheLeastBytesOfASetting) {
    Trials trials = trials_of(two_layers(), {});
    for (std::size_t f = 0; f < trials.families().size(); ++f) {
        const Family& family = trials.families()[f];
        Point point{f, {}};
        for (const Axis& axis : family.axes) point.step.push_back(axis.steps() / 3);
        const Trial trial = trials.measure(point);
        EXPECT_EQ(trial.failed, "") << family.name;
        EXPECT_LE(trials.at_least(point, Cost::bytes), trial.cost[static_cast<std::size_t>(Cost::bytes)])
            << family.name;
    }
}

TEST(Trials, ConfirmWithIntervalsThatHoldTheMean) {
    Trials trials = trials_of(two_layers(), {"deep", "avsm"});
    const std::vector<Point> points{point_of(trials, "deep kernel=tent mip=none", {32, 16, 0.1}),
                                    point_of(trials, "avsm sampling=linear filter=footprint", {32, 16, 8})};
    const std::vector<Confirmed> answers = trials.confirm(points, {0.05, true, 20.0});
    ASSERT_EQ(answers.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(answers[i].failed, "");
        EXPECT_LT(answers[i].error.low, answers[i].mean_error);
        EXPECT_GT(answers[i].error.high, answers[i].mean_error);
        for (std::size_t k = 0; k < costs; ++k) {
            EXPECT_LE(answers[i].interval[k].low, answers[i].cost[k]);
            EXPECT_GE(answers[i].interval[k].high, answers[i].cost[k]);
        }
        EXPECT_NEAR(trials.measure(points[i]).error, answers[i].mean_error, 0.5 * answers[i].mean_error);
    }
}

// Otherwise shadow rays, which are slow, would take the time that confirming the best setting needs.
TEST(Trials, KnowThatConfirmingSlowLookupsTakesLonger) {
    Trials trials = trials_of(two_layers(), {"ray_traced"});
    const Point point = point_of(trials, "ray_traced", {16, 4, 64});
    const double unknown = trials.confirm_effort(point, {});
    const double ns = trials.measure(point).cost[static_cast<std::size_t>(Cost::lookup)];
    EXPECT_NEAR(trials.confirm_effort(point, {}) - unknown, 5 * 500 * 1e-9 * ns, 1e-9 * ns) << "5 seeds of 500 queries";
}

// Otherwise a second setting of the same light rays, should the best one err too much, would seem too dear to confirm.
TEST(Trials, KnowThatConfirmingSharesLightRays) {
    Trials trials = trials_of(two_layers(), {"deep", "avsm", "ray_traced"});
    const Point deep = point_of(trials, "deep kernel=tent mip=none", {32, 16, 0.1}),
                avsm = point_of(trials, "avsm sampling=linear filter=footprint", {32, 16, 8}),
                finer = point_of(trials, "avsm sampling=linear filter=footprint", {64, 16, 8}),
                traced = point_of(trials, "ray_traced", {32, 16, 64});
    const double by_itself = trials.confirm_effort(avsm, {});
    EXPECT_LT(trials.confirm_effort(avsm, std::vector{deep}), by_itself);
    EXPECT_EQ(trials.confirm_effort(avsm, std::vector{finer}), by_itself);
    EXPECT_EQ(trials.confirm_effort(avsm, std::vector{traced}), by_itself) << "which captures none";
}

// Regular rays have no seed: every repetition errs by the same.
TEST(Trials, OfRegularRaysHaveAnExactError) {
    json document = two_layers();
    document["rays"]["pattern"] = "regular";
    Trials trials = trials_of(document, {"deep"}, Measure::p99);
    const std::vector<Point> points{point_of(trials, "deep kernel=box mip=none", {32, 16, 0.1})};
    const Trial trial = trials.measure(points[0]);
    const Confirmed confirmed = trials.confirm(points, {0.05, true, 20.0})[0];
    EXPECT_DOUBLE_EQ(confirmed.error.high, trial.error);
    EXPECT_DOUBLE_EQ(confirmed.mean_error, trial.error);
}

TEST(Trials, JudgeTheMeasureAskedFor) {
    std::vector<double> errors;
    for (const Measure measure : {Measure::rms, Measure::p99, Measure::max, Measure::curve}) {
        Trials trials = trials_of(two_layers(), {"deep", "ray_traced"}, measure);
        const Trial trial = trials.measure(point_of(trials, "deep kernel=box mip=none", {32, 16, 0.1}));
        errors.push_back(trial.error);
        const results::Result result = trials.result();
        const results::Cell& cell = result.variants[0].lights[0].cells[0];
        if (measure == Measure::curve) {
            EXPECT_EQ(trial.error, cell.curve->norms.max);
            EXPECT_LE(trial.error, 0.12);  // the tolerance
            EXPECT_THAT(trials.measure(point_of(trials, "ray_traced", {16, 4, 4})).failed,
                        ::testing::HasSubstr("no function"));
        }
    }
    EXPECT_LT(errors[0], errors[1]);
    EXPECT_LT(errors[1], errors[2]);
}

TEST(Trials, NameASettingThatIsTooLargeInsteadOfMeasuringIt) {
    Trials trials = trials_of(two_layers(), {"deep"});
    const Trial trial = trials.measure(point_of(trials, "deep kernel=box mip=none", {4096, 256, 0.1}));
    EXPECT_THAT(trial.failed, ::testing::HasSubstr("light rays"));
}

TEST(Trials, AreWrittenAsTheResultOfARun) {
    Trials trials = trials_of(two_layers(), {"deep"});
    const Point point = point_of(trials, "deep kernel=box mip=none", {32, 16, 0.1});
    trials.measure(point);
    trials.confirm(std::vector<Point>{point}, {0.05, true, 20.0});
    const auto written = results::to_json(trials.result());
    const results::Result read = results::from_json(json::parse(written.dump()), "result.json");
    ASSERT_EQ(read.variants.size(), 1u);
    EXPECT_EQ(read.variants[0].settings[0].pointer, "/rays/resolution");
    EXPECT_EQ(read.variants[0].settings[0].value, "32");
    ASSERT_EQ(read.variants[0].lights[0].cells.size(), 1u);
    EXPECT_GE(read.variants[0].lights[0].cells[0].times->random_order.ns.raw.size(), 7u);
}

base::Error error_of(const json& document, const std::string& light = "") {
    try {
        Trials(document, only({"deep"}), light, Measure::rms, {});
    } catch (const base::Error& error) {
        return error;
    }
    ADD_FAILURE() << "accepted";
    return {base::ErrorCode::internal, "", ""};
}

TEST(Trials, AskForALightIfThereAreSeveral) {
    json document = two_layers();
    document["lights"].push_back({{"type", "directional"}, {"name", "sky"}, {"direction", {0.1, -1, 0}}});
    const base::Error error = error_of(document);
    EXPECT_EQ(error.code(), base::ErrorCode::usage);
    EXPECT_THAT(error.message(), ::testing::HasSubstr("sun, sky"));
    EXPECT_EQ(Trials(document, only({"deep"}), "sky", Measure::rms, {}).light(), "sky");
    EXPECT_EQ(error_of(document, "moon").code(), base::ErrorCode::usage);
}

TEST(Trials, DropSweepsOverWhatIsExploredAndRefuseOthers) {
    json document = two_layers();
    document["sweeps"] = {{"/rays/samples_per_pixel", {4, 16}}, {"/techniques/0/tolerance", {0.1, 0.2}}};
    EXPECT_EQ(trials_of(document, {"deep"}).result().name, "two_layers");
    document["sweeps"]["/rays/resolution"] = {16, 32};
    EXPECT_EQ(error_of(document).code(), base::ErrorCode::usage);
}

TEST(Trials, RefuseALightThatSeesNoCaster) {
    json document = two_layers();
    document["lights"][0]["target"] = {50, 0, 0};
    document["lights"][0]["extent"] = {1, 1};
    EXPECT_THAT(error_of(document).message(), ::testing::HasSubstr("sees nothing"));
}

// Otherwise a short budget would go into filling the memory of one huge map.
TEST(Trials, KnowThatLargeMapsTakeLonger) {
    Trials trials = trials_of(two_layers(), {"opacity", "deep"});
    const std::string opacity = "opacity bounds=texel filter=footprint";
    const Point small = point_of(trials, opacity, {1024, 1, 2}), large = point_of(trials, opacity, {1024, 1, 256});
    const double more = trials.at_least(large, Cost::bytes) - trials.at_least(small, Cost::bytes);
    ASSERT_GT(more, 1e9);
    EXPECT_GT(trials.effort(large) - trials.effort(small), 1e-10 * more);
}

}  // namespace
}  // namespace shadowbench::recommend
