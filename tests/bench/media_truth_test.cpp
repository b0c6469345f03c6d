// The truth of grid volumes, and the ray-traced technique, compared with an independent integration at receivers inside
// the media and behind them.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "bench/queries.h"
#include "bench/reference.h"
#include "bench/run.h"
#include "document/document.h"
#include "rays/scenes.h"
#include "rays/tracer.h"
#include "scene/readers/files.h"
#include "scene/scenario.h"

namespace shadowbench::bench {
namespace {

using base::Vec3d;
using scene::GridVolume;
using techniques::Query;

scene::SearchPath data() {
    scene::SearchPath path;
    if (const char* folder = std::getenv("SHADOWBENCH_DATA")) path.folders.emplace_back(folder);
    path.folders.push_back(std::filesystem::path(SHADOWBENCH_SOURCE_DIR) / ".." / "shared" / "data");
    return path;
}

// Empty if no folder holds the file.
std::filesystem::path find(const std::string& file) {
    for (const std::filesystem::path& folder : data().folders)
        if (std::filesystem::exists(folder / file)) return folder / file;
    return {};
}

// Trilinear between voxel centres; the outermost values continue for half a voxel; 0 outside the box.
double density(const GridVolume& g, const Vec3d& p) {
    int low[3], high[3];
    double share[3];
    for (int a = 0; a < 3; ++a) {
        if (p[a] < g.lower[a] || p[a] > g.upper[a]) return 0.0;
        const double place =
            std::clamp((p[a] - g.lower[a]) / (g.upper[a] - g.lower[a]) * g.size[a] - 0.5, 0.0, g.size[a] - 1.0);
        low[a] = static_cast<int>(std::floor(place));
        high[a] = std::min(low[a] + 1, g.size[a] - 1);
        share[a] = place - low[a];
    }
    double sum = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        double weight = 1.0;
        int at[3];
        for (int a = 0; a < 3; ++a) {
            const bool up = corner >> a & 1;
            weight *= up ? share[a] : 1.0 - share[a];
            at[a] = up ? high[a] : low[a];
        }
        sum += weight * g.density[(static_cast<std::size_t>(at[2]) * g.size.y + at[1]) * g.size.x + at[0]];
    }
    return sum;
}

// The integral along a straight line from `from` to `to`: 100,000 midpoint steps of the part inside the box.
double integral(const GridVolume& g, const Vec3d& from, const Vec3d& to) {
    double first = 0.0, last = 1.0;
    const Vec3d d = to - from;
    for (int a = 0; a < 3; ++a) {
        if (d[a] == 0.0) continue;
        const double t0 = (g.lower[a] - from[a]) / d[a], t1 = (g.upper[a] - from[a]) / d[a];
        first = std::max(first, std::min(t0, t1));
        last = std::min(last, std::max(t0, t1));
    }
    if (!(first < last)) return 0.0;
    constexpr int steps = 100000;
    double sum = 0.0;
    for (int i = 0; i < steps; ++i) sum += density(g, from + d * (first + (last - first) * (i + 0.5) / steps));
    return sum * d.length() * (last - first) / steps;
}

GridVolume random_grid() {
    GridVolume g;
    g.size = {5, 4, 3};
    base::Random random(3);
    for (int i = 0; i < 60; ++i)  // with holes
        g.density.push_back(static_cast<float>(std::max(0.0, random.uniform(-0.5, 1.5))));
    g.lower = {-0.7, -1, -0.4};
    g.upper = {1.1, 0.8, 0.9};
    g.step = 0.3;
    return g;
}

// A grid of this many unit lengths across, around the origin.
void resize(GridVolume& g, double across) {
    const Vec3d extent = g.upper - g.lower;
    const double scale = across / std::max({extent.x, extent.y, extent.z});
    g.lower = extent * (-0.5 * scale);
    g.upper = extent * (0.5 * scale);
    g.step = across / 20.0;  // coarse: the truth must not depend on it
}

scene::Object object_of(GridVolume volume, const base::Vec3f& extinction, const base::Vec3f& motion = base::Vec3f(0)) {
    scene::Object object;
    object.shape = std::move(volume);
    object.extinction = extinction;
    object.motion = motion;
    return object;
}

std::array<scene::Light, 3> lights() {
    scene::Light slanted = rays::testing::directional(2.4), spot = rays::testing::spot({1.5, 4, -2}, 34),
                 inside = rays::testing::spot({0.1, 0.2, 0.3}, 70);
    slanted.direction = Vec3d(0.3, -1, 0.55).normalized();
    slanted.up = Vec3d(0.1, 0.2, 1);
    inside.target = {-0.5, -0.4, -0.2};
    return {slanted, spot, inside};
}

// One ray a pixel, through its middle, at the middle of the shutter.
void expect_exact(const scene::Scene& scene, int receivers) {
    int within = 0;
    for (const scene::Light& light : lights()) {
        const rays::LightView view = rays::make_light_view(light, scene, {24, 20}, "/lights/0");
        auto settings = rays::testing::rays(24, 1, scene::Pattern::regular);
        settings.resolution = {24, 20};
        base::Random random(11);
        std::vector<Query> queries;
        for (int i = 0; i < receivers; ++i)
            queries.push_back(
                {static_cast<float>(random.below(24)) + 0.5f, static_cast<float>(random.below(20)) + 0.5f,
                 static_cast<float>(random.uniform(view.z_min, view.z_min + 1.1 * (view.z_max - view.z_min))), 0.5f});
        const Truth truth = reference_visibility(scene, view, settings, queries, {});
        const rays::Tracer tracer(scene, true);
        std::vector<rays::TracedSegment> scratch;
        const double time = scene::has_motion(scene) ? 0.5 : 0.0;
        for (std::size_t q = 0; q < queries.size(); ++q) {
            const auto place = [&](double z) {
                return rays::to_world(view, rays::unproject(view, queries[q].x, queries[q].y, z));
            };
            Vec3d expected(1.0);
            for (const scene::Object& object : scene.objects) {
                const Vec3d moved = Vec3d(object.motion) * time;
                const double depth = integral(std::get<GridVolume>(object.shape),
                                              place(view.perspective ? view.z_near : view.z_min - 1.0) - moved,
                                              place(queries[q].z) - moved);
                for (int c = 0; c < 3; ++c) expected[c] *= std::exp(-depth * object.extinction[c]);
            }
            within += expected[0] < 0.999 && expected[0] > 0.001;
            const Vec3d traced = tracer.transmittance(view, queries[q].x, queries[q].y, queries[q].z, scratch, time);
            for (int c = 0; c < truth.channels; ++c) {
                EXPECT_NEAR(truth.value[static_cast<std::size_t>(c) * queries.size() + q], expected[c], 1e-7);
                EXPECT_NEAR(traced[c], expected[c], 1e-7);
            }
        }
    }
    EXPECT_GT(within, receivers / 2) << "enough receivers inside the media";
}

TEST(MediaTruth, IsExactInASmallGridWithHoles) {
    scene::Scene scene;
    scene.objects.push_back(object_of(random_grid(), {1.3f, 0.7f, 2.0f}));
    expect_exact(scene, 60);
}

TEST(MediaTruth, IsExactWhereGridsOverlapAndMove) {
    scene::Scene scene;
    scene.objects.push_back(object_of(random_grid(), {1.3f, 0.7f, 2.0f}, {0.3f, -0.2f, 0.4f}));
    GridVolume other = random_grid();
    std::reverse(other.density.begin(), other.density.end());
    resize(other, 1.7);
    scene.objects.push_back(object_of(other, {0.4f, 0.9f, 0.2f}));
    expect_exact(scene, 30);
}

TEST(MediaTruth, IsExactInARow) {
    GridVolume row;  // two axes have a single voxel: constant along them
    row.size = {1, 1, 4};
    row.density = {0.5f, 3.0f, 0.0f, 1.0f};
    row.lower = {-1, -1, -1};
    row.upper = {1, 1, 1};
    row.step = 2.0;
    scene::Scene scene;
    scene.objects.push_back(object_of(row, base::Vec3f(0.8f)));
    expect_exact(scene, 40);
}

TEST(MediaTruth, IsExactInTheBuckyBall) {
    const std::string file = "volumes/bucky_32x32x32_uint8.raw";
    if (find(file).empty()) GTEST_SKIP() << file << " does not exist: set SHADOWBENCH_DATA to the folder of data";
    GridVolume ball = scene::read_raw_volume(find(file), {32, 32, 32}, "uint8");
    ball.lower = {-1, -1, -1};
    ball.upper = {1, 1, 1};
    resize(ball, 2.0);
    scene::Scene scene;
    scene.objects.push_back(object_of(ball, {2, 4, 1}));
    expect_exact(scene, 40);
}

TEST(MediaTruth, IsExactInSmokeOfAFile) {
    const std::string file = "volumes/smoke.vdb";
    if (find(file).empty()) GTEST_SKIP() << file << " does not exist: set SHADOWBENCH_DATA to the folder of data";
    GridVolume smoke = scene::read_vdb(find(file), "density");
    resize(smoke, 2.2);
    scene::Scene scene;
    scene.objects.push_back(object_of(smoke, base::Vec3f(2.0f)));
    expect_exact(scene, 40);
}

nlohmann::json receiver_in_a_ball() {
    return nlohmann::json::parse(R"({
        "name": "media_truth",
        "scene": {"objects": [{
            "type": "volume", "file": "volumes/bucky_32x32x32_uint8.raw", "format": "uint8", "size": [32, 32, 32],
            "lower": [-1.5, -1, -1.2], "upper": [1.2, 1.4, 1.1], "extinction": [2, 4, 1]}]},
        "lights": [{"type": "spot", "position": [1.5, 6, -2], "target": [0.2, 0, 0.3], "up": [0.1, 0.2, 1],
            "angle": 60, "near": 0.5}],
        "rays": {"resolution": [48, 40], "samples_per_pixel": 16},
        "receivers": {"type": "points", "positions": [[0.7842038644973708, 0.5754569816805417, -0.47256466246713247]],
            "filter_width": 1.0, "bias": 0.0},
        "reference": {"samples_per_pixel": 65536, "queries": 64, "spread_seeds": 0},
        "timing": {"repetitions": 1, "lookups": 64},
        "techniques": [{"type": "ray_traced", "samples": 65536}]})");
}

TEST(MediaTruth, DoesNotDependOnTheMarchingStep) {
    nlohmann::json document = receiver_in_a_ball();
    if (find("volumes/bucky_32x32x32_uint8.raw").empty())
        GTEST_SKIP() << "the Bucky ball does not exist: set SHADOWBENCH_DATA to the folder of data";
    for (const char* step : {"", "scene.objects.0.step=0.5", "scene.objects.0.step=0.01", "rays.media=\"cells\""}) {
        if (*step) document::set_value(document, step);
        const scene::Scenario scenario = scene::load_scenario(document, data());
        const rays::LightView view =
            rays::make_light_view(scenario.lights[0], scenario.scene, scenario.rays.resolution, "/lights/0");
        const QuerySet asked = point_queries(scenario.receivers, view);
        ASSERT_EQ(asked.queries.size(), 1u);
        const Truth truth = reference_visibility(scenario.scene, view, reference_settings(scenario), asked.queries, {});
        ASSERT_EQ(truth.channels, 3);
        EXPECT_NEAR(truth.value[1], 0.84867, 1e-4) << step;
        RunOptions options;
        options.data = data();
        const results::LightResult light = run(document, options, {}).variants.at(0).lights.at(0);
        EXPECT_LT(light.cells.at(0).lookup->norms.max, 1e-4) << step;
        ASSERT_TRUE(light.agreement);
        EXPECT_EQ(light.agreement->other_transmittance, 0u) << step;
    }
}

}  // namespace
}  // namespace shadowbench::bench
