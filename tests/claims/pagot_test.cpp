#include "claims/pagot.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "claims/pagot_views.h"

namespace shadowbench::claims::pagot {
namespace {

Context quick_context(PaperReport& report) {
    Context context;
    context.scenarios = std::filesystem::path(SHADOWBENCH_SOURCE_DIR) / "scenarios/papers";
    context.quick = true;
    context.report = &report;
    return context;
}

Crossing of_line(double start, double slope) {
    std::vector<std::pair<double, double>> points;
    for (const double x : {0.25, 0.5, 1.0, 3.0, 4.0}) points.emplace_back(x, start + slope * x);
    return crossing_of(points);
}

TEST(Crossing, IsWhereTheLineThroughTheDifferencesIsZero) {
    const Crossing found = of_line(3.0, -2.0);
    EXPECT_NEAR(found.selection, 3.0, 1e-12);
    EXPECT_NEAR(found.saved, 2.0, 1e-12);
    EXPECT_NEAR(found.fragments, 1.5, 1e-12);
}

TEST(Crossing, IsTheLeastSquaresLines) {
    const std::pair<double, double> points[] = {{0.0, 1.0}, {1.0, 0.0}, {2.0, 1.0}, {3.0, -1.0}};
    const Crossing found = crossing_of(points);  // by hand: slope -0.5, mean (1.5, 0.25)
    EXPECT_NEAR(found.saved, 0.5, 1e-12);
    EXPECT_NEAR(found.selection, 1.0, 1e-12);
    EXPECT_NEAR(found.fragments, 2.0, 1e-12);
}

TEST(Crossing, MayBeNeverOrAtOnce) {
    EXPECT_EQ(of_line(3.0, 0.5).fragments, never);
    EXPECT_EQ(of_line(3.0, -1e-9).fragments, never);
    EXPECT_EQ(of_line(-1.0, -2.0).fragments, 0.0) << "selection costs nothing";
}

TEST(Crossing, OutsideTheImagesIsOnlyKnownToLieBeyondThem) {
    const auto within = [](std::vector<double> places, double most) {
        std::vector<Crossing> rounds;
        for (const double place : places) rounds.push_back({1.0, 1.0, place});
        return crossing_within(rounds, most);
    };
    const Value inside = within({1.9, 2.0, 2.1, 2.2, 2.0}, 6.0);
    EXPECT_EQ(inside.value, 2.0);
    EXPECT_EQ(inside.low, 1.9);
    EXPECT_EQ(inside.high, 2.2);
    const Value beyond = within({9.0, 15.0, 16.0, never, 14.0}, 6.0);
    EXPECT_EQ(beyond.low, 6.0);
    EXPECT_EQ(beyond.high, never);
    EXPECT_EQ(within({5.0, 15.0, 16.0, 20.0, 14.0}, 6.0).low, 5.0) << "part of the interval is inside";
    const Value nowhere = within(std::vector<double>(5, never), 6.0);
    EXPECT_EQ(nowhere.low, never);
    EXPECT_EQ(judge_less(inside, exactly(never)).verdict, Verdict::holds);
    EXPECT_EQ(judge_less(beyond, exactly(never)).verdict, Verdict::undecided);
    EXPECT_EQ(judge_less(nowhere, exactly(never)).verdict, Verdict::fails);
}

TEST(Kernels, AreRequestedAsThePaperDescribesThem) {
    EXPECT_EQ(request({1, 4}), R"({"type":"multi_depth","n":1,"select":"maximum","kernel":4})");
    EXPECT_EQ(request({3, 2}), R"({"type":"multi_depth","n":3,"select":"both","kernel":2})");
    EXPECT_EQ(title({3, 2}), "3-SM with 2 x 2");
}

TEST(Turned, TurnsLightAndCameraAroundTheirTargets) {
    const nlohmann::json document = nlohmann::json::parse(R"({
        "lights": [{"position": [3, 7, 3], "target": [1, 0.8, 0]}],
        "receivers": {"position": [-1, 3, 6], "target": [-1, 0.6, 0]}})");
    const nlohmann::json one = turned(document, 90.0, 0.0), other = turned(document, 0.0, 180.0);
    EXPECT_EQ(one.at("receivers"), document.at("receivers"));
    EXPECT_EQ(other.at("lights"), document.at("lights"));
    const auto coordinate = [](const nlohmann::json& thing, std::size_t axis) {
        return thing.at("position").at(axis).get<double>();
    };
    const nlohmann::json &light = one.at("lights").at(0), &camera = other.at("receivers");
    EXPECT_NEAR(coordinate(light, 0), 4.0, 1e-12);
    EXPECT_EQ(coordinate(light, 1), 7.0);
    EXPECT_NEAR(coordinate(light, 2), -2.0, 1e-12);
    EXPECT_NEAR(coordinate(camera, 0), -1.0, 1e-12);
    EXPECT_NEAR(coordinate(camera, 2), -6.0, 1e-12);
}

TEST(LeastShade, KeepsFootprintsFromTheReceiversOwnSurface) {
    nlohmann::json document = nlohmann::json::parse(R"({
        "lights": [{"position": [0, 2, 0], "target": [0, 0, 0], "angle": 90}],
        "rays": {"resolution": 100}, "receivers": {"bias": 0}})");
    const double cell = 0.04, reach = 3.0 * std::sqrt(2.0);  // 4 units wide at the target; half a diagonal of 6 cells
    document["receivers"]["bias"] = cell * reach;
    EXPECT_NEAR(least_shade(document, Surfaces::others), 0.8 / std::sqrt(2.0), 1e-12) << "45 degrees";
    EXPECT_EQ(least_shade(document, Surfaces::plane), 0.1) << "it casts no shadow";
}

// One ball alone has no shadow on it: what a kernel answers there is of the ball itself.
TEST(LeastShade, LeavesNothingThatABallShadesOfItself) {
    PaperReport report;
    const Context context = quick_context(report);
    nlohmann::json document =
        context.document(curved, {fmt::format("techniques=[{},{}]", request({1, 4}), request({3, 3})),
                                  "rays.resolution=256", "receivers.resolution=[256,192]"});
    nlohmann::json& balls = document.at("scene").at("objects").at(0);
    balls["centres"] = nlohmann::json::parse("[[-0.9, 0.7, 0.2]]");
    balls["radii"] = nlohmann::json::parse("[0.7]");
    const double least = least_shade(document, Surfaces::others);
    const Seen seen(document, {});
    std::size_t count = 0, shaded = 0;
    for (std::size_t q = 0; q < seen.queries().size(); ++q) {
        if (std::abs(seen.place(q).y) < 1e-3) continue;
        if (seen.shade(q) >= least) {
            ++count;
            EXPECT_EQ(seen.visibility(0)[q], 1.0f);
            EXPECT_EQ(seen.visibility(1)[q], 1.0f);
        } else {
            shaded += seen.visibility(1)[q] < 1.0f;
        }
    }
    EXPECT_GT(count, 100u);
    EXPECT_GT(shaded, 10u) << "where the ball turns away from the light";
}

// Of straight edges along the cells' axes, between the centres of two cells: the kernel of 4 x 4 has steps half a cell
// from those of 3 x 3, and the mean over 4 x 4 cells has none.
TEST(Likeness, InOnePhaseIsOutOfReachOfTheExactMeanToo) {
    double of_mean = 0.0, of_smaller = 0.0;
    const int edges = 50, places = 400;
    for (int i = 0; i < edges; ++i)
        for (int k = 0; k < places; ++k) {
            const double edge = (i + 0.5) / edges, x = -3.0 + 7.0 * (k + 0.5) / places;
            const auto steps = [&](int side) {
                int lit = 0;
                for (int s = 0; s < side; ++s) lit += std::floor(x + s - 0.5 * (side - 1)) + 0.5 > edge;
                return static_cast<double>(lit) / side;
            };
            const double mean = std::clamp((x - edge) / 4.0 + 0.5, 0.0, 1.0);
            of_mean += (mean - steps(4)) * (mean - steps(4));
            of_smaller += (steps(3) - steps(4)) * (steps(3) - steps(4));
        }
    const double share = std::sqrt(of_mean / of_smaller);
    EXPECT_NEAR(share, 0.65, 0.02);
    EXPECT_NE(judge_likeness(exactly(share)).verdict, Verdict::holds);
}

TEST(CloseView, LooksAtTheMiddleOfTheShadowFromTheSameSide) {
    const nlohmann::json document = nlohmann::json::parse(R"({
        "lights": [{"position": [4, 8, 0], "target": [1, 2, 0]}],
        "receivers": {"position": [0, 3, 6], "target": [1, 1, 0]}})");
    const base::Vec3d middle = middle_of_shadow(document);
    EXPECT_LT(middle.length(), 1e-12);
    const nlohmann::json close = aimed(document, middle, 12.0), &camera = close.at("receivers");
    EXPECT_EQ(camera.at("fov"), 12.0);
    const double from[] = {-1.0, 2.0, 6.0};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(camera.at("target").at(axis).get<double>(), 0.0, 1e-12);
        EXPECT_NEAR(camera.at("position").at(axis).get<double>(), from[axis], 1e-12);
    }
}

TEST(Phases, PicturesHaveAMeanAndADistanceFromIt) {
    std::vector<render::Image> pictures(2, render::Image({2, 1}, base::Vec3f(0.5f)));
    pictures[0].at(0, 0) = base::Vec3f(0.25f);
    pictures[1].at(0, 0) = base::Vec3f(0.75f);
    const render::Image mean = mean_picture(pictures);
    EXPECT_EQ(mean.at(0, 0), base::Vec3f(0.5f));
    EXPECT_EQ(mean.at(1, 0), base::Vec3f(0.5f));
    EXPECT_NEAR(rms_from(pictures, mean), 0.25 * std::sqrt(0.5), 1e-7);  // in one of two pixels
}

TEST(Views, TakeTheWidthOfTheLeastMeanError) {
    Views::Numbers numbers;
    for (std::vector<double>& error : numbers.error) error = {0.5, 0.5};
    numbers.error[1] = {0.1, 0.8};
    numbers.error[3] = {0.4, 0.3};
    EXPECT_EQ(numbers.best_width(), 3u);
}

// What the place of the cells adds to the difference of an odd and an even kernel is not in their means over phases.
TEST(Views, MeansOverPhasesDifferLessThanPicturesInOnePhase) {
    PaperReport report;
    const Context context = quick_context(report);
    const Kernel odd{1, 3}, even{1, 4};
    Views views(context, flat, Surfaces::plane, {odd, even});
    EXPECT_EQ(report.documents.size(), 1u);
    const Difference& difference = views.difference(odd, even);
    ASSERT_EQ(difference.of_means.rms.size(), static_cast<std::size_t>(lights));
    EXPECT_EQ(&views.difference(even, odd), &difference) << "a distance has no direction";
    for (std::size_t i = 0; i < difference.of_means.rms.size(); ++i) {
        EXPECT_LT(difference.of_means.rms[i], 0.9 * difference.in_one_phase.rms[i]);
        EXPECT_GT(views.numbers(odd).half_a_cell_on.rms[i], difference.of_means.rms[i]);
        EXPECT_GT(views.numbers(odd).aliasing[i], views.numbers(even).aliasing[i]) << "steps of a third and a quarter";
        EXPECT_LT(views.numbers(odd).transition[i], views.numbers(even).transition[i]);
    }
}

}  // namespace
}  // namespace shadowbench::claims::pagot
