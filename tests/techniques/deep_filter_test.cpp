// The pixel filter of deep shadow maps.
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "curves/norms.h"
#include "curves/sweep.h"
#include "techniques/built.h"
#include "techniques/deep/pixel_filter.h"

namespace shadowbench::techniques {
namespace {

using rays::testing::directional;
using testing::build;
using testing::Built;

const Technique& deep() {
    return find("deep", "");
}

// The weight that the filter of equation (1) gives a ray at (dx, dy) from the centre.
double weigh(const PixelFilter& filter, double dx, double dy) {
    const double r = filter.radius;
    if (std::abs(dx) > r || std::abs(dy) > r) return 0.0;
    if (filter.shape == FilterShape::box) return 1.0;
    if (filter.shape == FilterShape::tent) return (1 - std::abs(dx) / r) * (1 - std::abs(dy) / r);
    return std::exp(-2 * (dx * dx + dy * dy) / (r * r));
}

const char* name_of(FilterShape shape) {
    return shape == FilterShape::box ? "box" : shape == FilterShape::tent ? "tent" : "gaussian";
}

std::string parameters_of(const PixelFilter& filter, double tolerance) {
    return std::string("{\"filter\": \"") + name_of(filter.shape) + "\", \"radius\": " + std::to_string(filter.radius) +
           ", \"tolerance\": " + std::to_string(tolerance) + "}";
}

constexpr FilterShape shapes[] = {FilterShape::box, FilterShape::tent, FilterShape::gaussian};

// Weights of the pixels around one, one ray each, in the middle of its pixel.
std::vector<double> centre_weights(const PixelFilter& filter, int x, int y) {
    rays::MapLayout layout;
    layout.width = layout.height = layout.tile_width = layout.tile_height = 5;
    rays::LightRays tile;
    tile.width = tile.height = 5;
    tile.begin.assign(26, 0);
    std::vector<curves::WeightedRay> rays;
    filter_rays(
        filter, tile, [&](std::size_t ray) { return ray_offset(layout, tile, ray); }, x, y, rays);
    std::vector<double> weights(25, 0.0);
    for (const curves::WeightedRay& r : rays) weights[r.ray] = r.weight;
    return weights;
}

TEST(DeepFilter, WeightsFollowTheirClosedForms) {
    const auto inner = [](FilterShape shape, double radius) { return centre_weights({shape, radius}, 2, 2); };
    EXPECT_NEAR(inner(FilterShape::box, 1.5)[12], 1.0 / 9, 1e-12);
    EXPECT_NEAR(inner(FilterShape::box, 1.5)[6], 1.0 / 9, 1e-12);
    EXPECT_EQ(inner(FilterShape::box, 0.5)[12], 1.0);
    EXPECT_NEAR(inner(FilterShape::tent, 1.5)[12], 9.0 / 25, 1e-12) << "1 / (1 + 2 / 3), squared";
    EXPECT_NEAR(inner(FilterShape::tent, 1.5)[11], 3.0 / 25, 1e-12);
    EXPECT_NEAR(inner(FilterShape::tent, 1.5)[6], 1.0 / 25, 1e-12);
    EXPECT_EQ(inner(FilterShape::tent, 1.0)[12], 1.0) << "the neighbours are where the tent is 0";
    const double g = std::exp(-2.0 / (2.5 * 2.5)), h = std::exp(-8.0 / (2.5 * 2.5)), sum = 1 + 2 * g + 2 * h;
    EXPECT_NEAR(inner(FilterShape::gaussian, 2.5)[12], 1 / (sum * sum), 1e-12);
    EXPECT_NEAR(inner(FilterShape::gaussian, 2.5)[13], g / (sum * sum), 1e-12);
    EXPECT_NEAR(inner(FilterShape::gaussian, 2.5)[0], h * h / (sum * sum), 1e-12);
}

TEST(DeepFilter, AtTheMapsCornerTheExistingRaysShareTheWeight) {
    EXPECT_NEAR(centre_weights({FilterShape::box, 1.5}, 0, 0)[0], 1.0 / 4, 1e-12);
    EXPECT_NEAR(centre_weights({FilterShape::tent, 1.5}, 0, 0)[0], 9.0 / 16, 1e-12) << "1 / (1 + 1 / 3), squared";
    EXPECT_NEAR(centre_weights({FilterShape::tent, 1.5}, 4, 4)[23], 3.0 / 16, 1e-12);
}

TEST(DeepFilter, AsksForThePixelsThatItReaches) {
    for (const auto& [radius, apron] : {std::pair{0.5, 0}, {0.6, 1}, {1.0, 1}, {1.5, 1}, {1.51, 2}, {8.0, 8}})
        EXPECT_EQ((PixelFilter{FilterShape::tent, radius}.apron()), apron) << radius;
    EXPECT_TRUE(PixelFilter{}.is_pixel());
    EXPECT_FALSE((PixelFilter{FilterShape::gaussian, 0.5}.is_pixel()));
}

TEST(DeepFilter, RaysWithoutTheApronAreRefused) {
    const ParameterValues values = read_parameters(deep().parameters, {{"radius", 2.0}}, "");
    const auto map = deep().create(values);
    EXPECT_EQ(map->needs().apron, 2);
    EXPECT_EQ(map->cells(), Cells::filtered);
    rays::MapLayout layout;
    layout.apron = 1;
    const rays::LightView view;
    EXPECT_THROW(map->begin({layout, view, nullptr, 0}), base::Error);
    layout.apron = 2;
    EXPECT_NO_THROW(map->begin({layout, view, nullptr, 0}));
}

// Pixels at the map's edges, at the border of two tiles, and in the middle.
std::vector<std::pair<int, int>> some_pixels() {
    return {{0, 0}, {69, 69}, {0, 40}, {63, 30}, {64, 30}, {63, 63}, {64, 64}, {30, 35}, {35, 69}};
}

// All rays of the map with their weights for a pixel, by definition.
struct Term {
    const rays::LightRays* tile;
    std::size_t ray;
    double weight;
};
std::vector<Term> terms_of(const rays::testing::Captured& c, const PixelFilter& filter, int x, int y) {
    std::vector<Term> terms;
    double total = 0.0;
    rays::testing::for_each_ray(c, [&](const rays::LightRays& tile, std::size_t ray, int i, int j) {
        const auto at = rays::sample_position(c.layout, i, j);
        const double weight = weigh(filter, at.x - x - 0.5, at.y - y - 0.5);
        if (weight > 0.0) terms.push_back({&tile, ray, weight});
        total += weight;
    });
    for (Term& t : terms) t.weight /= total;
    return terms;
}

TEST(DeepFilter, APixelIsTheWeightedMeanOfTheRaysAroundItsCentre) {
    for (const bool media : {false, true}) {
        const auto scene = testing::hairy_scene(media);
        const auto plain = rays::testing::capture(scene, directional(), rays::testing::rays(70, 4));
        ASSERT_GT(plain.layout.tiles(), 1);
        for (const PixelFilter& filter :
             {PixelFilter{FilterShape::box, 2.0}, {FilterShape::tent, 0.75}, {FilterShape::gaussian, 1.6}}) {
            const Built b = build(deep(), scene, directional(), rays::testing::rays(70, 4),
                                  parameters_of(filter, media ? 1e-4 : 0.0).c_str());
            for (const auto& [x, y] : some_pixels()) {
                curves::Curve stored;
                b.map->stored(x, y, 0, {}, stored);
                const std::vector<Term> terms = terms_of(plain, filter, x, y);
                for (const float z : {0.5f, 0.9f, 1.0f, 1.1f, 1.3f, 3.0f}) {
                    double sum = 0.0;
                    for (const Term& t : terms) sum += t.weight * rays::transmittance(*t.tile, t.ray, 0, z);
                    ASSERT_NEAR(curves::evaluate(stored, z), sum, media ? 1.1e-4 : 1e-6)
                        << name_of(filter.shape) << " pixel " << x << " " << y;
                }
            }
        }
    }
}

// The benchmark checks curves by the weights that the map reports.
TEST(DeepFilter, StoredFunctionsStayWithinTheToleranceOfTheWeightsThatTheMapTells) {
    for (const bool media : {false, true})
        for (const FilterShape shape : shapes) {
            const double tolerance = 0.02;
            const Built b = build(deep(), testing::hairy_scene(media), directional(), rays::testing::rays(20, 16),
                                  parameters_of({shape, 1.25}, tolerance).c_str());
            curves::SweepScratch scratch;
            curves::Curve exact, stored;
            std::vector<curves::WeightedRay> rays;
            double worst = 0.0;
            for (int y = 0; y < 20; ++y)
                for (int x = 0; x < 20; ++x) {
                    const auto& layout = b.rays.layout;
                    const rays::LightRays& tile =
                        b.rays.tiles[(y / layout.tile_height) * layout.tiles_x() + x / layout.tile_width];
                    b.map->weights(x, y, tile, rays);
                    double sum = 0.0;
                    for (const curves::WeightedRay& r : rays) sum += r.weight;
                    ASSERT_NEAR(sum, 1.0, 1e-12);
                    curves::visibility(tile, rays, 1e-5, scratch, exact);
                    b.map->stored(x, y, 0, {}, stored);
                    ASSERT_TRUE(curves::is_visibility(stored));
                    worst = std::max(worst, curves::distance(stored, exact, 0, 4).max);
                }
            EXPECT_LE(worst, tolerance + 1.1e-5) << name_of(shape);
            EXPECT_GE(worst, 0.5 * tolerance);
        }
}

// Other maps of the same run may have asked for more pixels around each tile than this one.
TEST(DeepFilter, AWiderApronThanAskedForChangesNothing) {
    const auto scene = testing::hairy_scene(false);
    for (const char* parameters : {"{}", R"({"filter": "tent", "radius": 1.0})"}) {
        const Built b = build(deep(), scene, directional(), rays::testing::rays(70, 4), parameters);
        const auto wide = rays::testing::capture(scene, directional(), rays::testing::rays(70, 4), 5);
        const auto map = deep().create(b.values);
        map->begin({wide.layout, wide.view, nullptr, 0});
        for (const auto& tile : wide.tiles) map->add(tile);
        map->finish();
        curves::Curve one, two;
        for (int y = 0; y < 70; ++y)
            for (int x = 0; x < 70; ++x) {
                b.map->stored(x, y, 0, {}, one);
                map->stored(x, y, 0, {}, two);
                ASSERT_EQ(one, two) << x << " " << y;
            }
        EXPECT_EQ(map->bytes(), b.map->bytes());
    }
}

TEST(DeepFilter, AWiderFilterIsSmoother) {
    scene::Scene scene;  // a wall over the left half
    scene.objects.push_back(rays::testing::quad({-1, -1, 0}, {1, 0, 0}, {0, 2, 0}));
    const Built b = build(deep(), scene, directional(), rays::testing::rays(16, 16, scene::Pattern::regular),
                          R"({"filter": "box", "radius": 2.5, "tolerance": 0})");
    for (const auto& [x, lit] : {std::pair{4.5f, 0.0f}, {6.5f, 0.2f}, {7.5f, 0.4f}, {8.5f, 0.6f}, {11.5f, 1.0f}})
        EXPECT_NEAR(b.lookup(x, 8.5f, 5.0f), lit, 1e-6f) << x;
}

}  // namespace
}  // namespace shadowbench::techniques
