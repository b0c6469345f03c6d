#include "render/two_pass.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/random.h"
#include "bench/load.h"
#include "bench/prepared_light.h"
#include "document/document.h"
#include "rays/capture.h"

namespace shadowbench::render {
namespace {

using base::Vec3d;

// Density 0.5 everywhere in a box of 4 x 2 x 3.
scene::Object slab(double extinction) {
    scene::GridVolume volume;
    volume.size = {4, 2, 3};
    volume.density.assign(4 * 2 * 3, 0.5f);
    volume.lower = {-2, 0, 0};
    volume.upper = {2, 2, 3};
    volume.step = 0.1;
    scene::Object object;
    object.extinction = base::Vec3f(static_cast<float>(extinction));
    object.shape = volume;
    return object;
}
const scene::GridVolume& grid(const scene::Object& object) {
    return std::get<scene::GridVolume>(object.shape);
}

TEST(TwoPass, cuts_rays_to_the_box) {
    const scene::Object object = slab(1);
    const BoxRay through = cut_to_box({0, 1, 10}, {0, 0, -1}, 0.0, grid(object));
    EXPECT_DOUBLE_EQ(through.front, 7.0);
    EXPECT_DOUBLE_EQ(through.back, 10.0);
    EXPECT_DOUBLE_EQ(cut_to_box({0, 1, 1}, {0, 0, -1}, 0.0, grid(object)).back, 1.0) << "from inside";
    EXPECT_DOUBLE_EQ(cut_to_box({0, 1, 1}, {0, 0, -1}, -5.0, grid(object)).front, -2.0);
    EXPECT_FALSE(cut_to_box({0, 1, 10}, {0, 0, 1}, 0.0, grid(object)).meets()) << "behind the origin";
    EXPECT_FALSE(cut_to_box({0, 3, 10}, {0, 0, -1}, 0.0, grid(object)).meets()) << "beside the box";
    const double slope = 1.0 / std::sqrt(2.0);
    const BoxRay slanted = cut_to_box({-3, 1, 0}, {slope, 0, slope}, 0.0, grid(object));
    EXPECT_NEAR(slanted.at(slanted.front).x, -2.0, 1e-12);
    EXPECT_NEAR(slanted.at(slanted.back).z, 3.0, 1e-12);
}

TEST(TwoPass, draws_the_places_of_rays_in_their_pixels) {
    const scene::Object object = slab(1);
    scene::Camera camera;
    camera.position = {0, 1, 10};
    camera.target = {0, 1, 0};
    camera.fov = 10;
    const auto middles = box_rays(camera, {8, 8}, grid(object)), drawn = box_rays(camera, {8, 8}, grid(object), 1),
               again = box_rays(camera, {8, 8}, grid(object), 1), other = box_rays(camera, {8, 8}, grid(object), 2);
    ASSERT_EQ(drawn.size(), 64u);
    const double pixel = 2.0 * std::tan(5.0 * std::acos(-1.0) / 180.0) / 8.0;  // on the plane at distance 1
    for (std::size_t i = 0; i < drawn.size(); ++i) {
        EXPECT_EQ(drawn[i].direction, again[i].direction);
        EXPECT_NE(drawn[i].direction, other[i].direction);
        const auto on_plane = [](const BoxRay& ray) { return ray.direction / -ray.direction.z; };
        const Vec3d off = on_plane(drawn[i]) - on_plane(middles[i]);
        EXPECT_LE(std::max(std::abs(off.x), std::abs(off.y)), 0.5 * pixel * (1 + 1e-9)) << i;
    }
}

// Constant density d and extinction s: the colour is d (1 - exp(-s d length)).
TEST(TwoPass, gathers_the_colour_of_a_uniform_volume) {
    for (const double extinction : {0.2, 3.0, 40.0}) {
        const scene::Object object = slab(extinction);
        const ColourPass pass(object, 512);
        const std::vector<BoxRay> rays{cut_to_box({0, 1, 10}, {0, 0, -1}, 0.0, grid(object)),
                                       cut_to_box({0, 9, 1}, {0, -1, 0}, 0.0, grid(object)),
                                       cut_to_box({0, 9, 10}, {0, -1, 0}, 0.0, grid(object))};
        const std::vector<double> colours = pass.colours(rays);
        EXPECT_NEAR(colours[0], 0.5 * (1.0 - std::exp(-0.5 * 3.0 * extinction)), 1e-4);
        EXPECT_NEAR(colours[1], 0.5 * (1.0 - std::exp(-0.5 * 2.0 * extinction)), 1e-4);
        EXPECT_EQ(colours[2], 0.0);
        std::vector<ColourStep> steps;
        pass.trace(rays[0], steps);
        EXPECT_LE(steps.size(), 512u);
        EXPECT_GT(steps.size(), 200u) << "3 of a diagonal of 5.4";
    }
}

TEST(TwoPass, takes_volumes_of_grey_extinction_only) {
    scene::Object coloured = slab(1);
    coloured.extinction.y = 2.0f;
    EXPECT_THROW(ColourPass(coloured, 8), base::Error);
    EXPECT_THROW(ColourPass(scene::Object{}, 8), base::Error);
}

// A uniform volume of density 1 from y = 0 to 2, lit from straight above, with the exact map.
struct LitSlab {
    static constexpr double extinction = 1.3;

    void with_map(const std::function<void(const scene::Scenario&, const rays::LightView&, const bench::Maps&)>& use) {
        const nlohmann::json document = nlohmann::json::parse(R"({"name": "slab",
            "scene": {"objects": [{"type": "crossed_rods", "radius": 40, "size": [4, 4, 4], "lower": [-4, 0, -4],
                                   "upper": [4, 2, 4], "extinction": 1.3, "step": 0.005}]},
            "lights": [{"type": "directional", "direction": [0, -1, 0]}],
            "rays": {"resolution": 16, "samples_per_pixel": 1, "pattern": "regular"},
            "techniques": [{"type": "uncompressed"}]})");
        const auto variants = document::expand(document);
        bench::ScenarioLoader loader({});
        const scene::Scenario& scenario = loader.load(variants.front());
        const auto contenders = bench::make_contenders(scenario, variants.front());
        const bench::PreparedLight light = bench::prepare_light(scenario, 0, contenders, {});
        const rays::Capture capture(scenario.scene, light.view, light.layout);
        bench::Maps maps =
            bench::begin_maps(*contenders[0].row, contenders[0].values, {light.layout, light.view, nullptr});
        for (int tile = 0; tile < light.layout.tiles(); ++tile) bench::add(maps, capture.tile(tile));
        bench::finish(maps);
        use(scenario, light.view, maps);
    }
};

// The paper's average counts all places alike: for a ray along the light it is the mean of 1 - exp(-s) up to the
// optical depth of the slab. What the eye sees weighs each place by exp(-s) too.
TEST(TwoPass, averages_all_places_alike_and_the_exact_pass_those_that_are_seen) {
    LitSlab().with_map([](const scene::Scenario& scenario, const rays::LightView& view, const bench::Maps& maps) {
        const scene::Object& object = scenario.scene.objects[0];
        const double depth = 2.0 * LitSlab::extinction, through = std::exp(-depth);
        const std::vector<BoxRay> rays{
            cut_to_box({0.3, 50, 0.2}, {0, -1, 0}, 0.0, grid(object)),
            cut_to_box({-50, 1.5, 0.1}, {1, 0, 0}, 0.0, grid(object)),  // all of it 0.5 below the top
            cut_to_box({-50, 9, 0.1}, {1, 0, 0}, 0.0, grid(object))};
        const std::vector<double> mean = mean_opacities(rays, 512, view, maps),
                                  exact = exact_opacities(rays, 512, scenario.scene, view, ColourPass(object, 4096));
        EXPECT_NEAR(mean[0], 1.0 - (1.0 - through) / depth, 1e-4);
        EXPECT_NEAR(exact[0], 1.0 - 0.5 * (1.0 - through * through) / (1.0 - through), 1e-4);
        const double level = 1.0 - std::exp(-0.5 * LitSlab::extinction);
        EXPECT_NEAR(mean[1], level, 1e-4);
        EXPECT_NEAR(exact[1], level, 1e-4);
        EXPECT_EQ(mean[2], 0.0);
        EXPECT_EQ(exact[2], 0.0);
        EXPECT_NEAR(mean_opacities(rays, 1, view, maps)[0], 1.0 - std::exp(-0.5 * depth), 1e-4) << "the middle";
    });
}

// The depth that the paper compares is the way to the light inside the box. It differs from planar depth by the depth
// at which the light ray enters the box, which the map holds too.
TEST(TwoPass, planar_depth_differs_from_the_way_to_the_light_by_that_of_the_entry) {
    const scene::Object object = slab(1);
    scene::Scene scene;
    scene.objects = {object};
    scene::Light light;
    light.direction = Vec3d(-1, -1.5, -0.6).normalized();
    const rays::LightView view = rays::make_light_view(light, scene, {32, 32}, "");
    base::Random random(5);
    for (int i = 0; i < 200; ++i) {
        const Vec3d place(random.uniform(-2, 2), random.uniform(0, 2), random.uniform(0, 3));
        const double way = cut_to_box(place, -light.direction, 0.0, grid(object)).back;
        const Vec3d at = rays::to_light(view, place);
        const rays::LightLine line = rays::light_line(view, at.x, at.y);
        const double entry =
            cut_to_box(line.origin, line.direction, -std::numeric_limits<double>::infinity(), grid(object)).front;
        EXPECT_NEAR(at.z - entry, way, 1e-9);
    }
}

TEST(TwoPass, darkens_colours_by_opacities) {
    EXPECT_THAT(darkened(std::vector<double>{0.8, 0.5, 0.25}, std::vector<double>{0.0, 0.5, 1.0}),
                testing::ElementsAre(0.8, 0.25, 0.0));
    const Image image = grey_picture(std::vector<double>{0.0, 0.25, 0.5, 1.0}, {2, 2});
    EXPECT_EQ(image.at(1, 0), base::Vec3f(0.25f));
    EXPECT_EQ(image.at(0, 1), base::Vec3f(0.5f));
}

}  // namespace
}  // namespace shadowbench::render
