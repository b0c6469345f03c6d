#include "bench/node_ratio.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "techniques/built.h"

namespace shadowbench::bench {
namespace {

using techniques::testing::hairy_scene;

// The ratio of `deep` with these parameters in a scene.
std::optional<results::FewestNodes> ratio_of(const scene::Scene& scene, const std::string& parameters,
                                             const scene::RaySettings& settings = rays::testing::rays(12, 9)) {
    const techniques::Technique& row = techniques::find("deep", "");
    const techniques::ParameterValues values =
        techniques::read_parameters(row.parameters, nlohmann::json::parse(parameters), "");
    const int apron = row.create(values)->needs().apron;
    const rays::testing::Captured captured =
        rays::testing::capture(scene, rays::testing::directional(), settings, apron);
    Maps maps = begin_maps(row, values, {captured.layout, captured.view, nullptr});
    for (const rays::LightRays& tile : captured.tiles) add(maps, tile);
    finish(maps);
    std::vector<NodesBesideFewest> parts;
    for (const rays::LightRays& tile : captured.tiles) {
        parts.emplace_back();
        compare_nodes(maps, tile, captured.layout, parts.back());
    }
    return over_fewest(parts, nodes(maps).cells);
}

scene::Scene layers(int count, base::Vec3f opacity) {
    scene::Scene scene;
    for (int i = 0; i < count; ++i) {
        scene.objects.push_back(
            rays::testing::quad({-1, -1, 0.9f - 0.1f * static_cast<float>(i)}, {2, 0, 0}, {0, 2, 0.05f}));
        scene.objects.back().opacity = opacity;
    }
    return scene;
}

scene::Scene slabs() {
    scene::Scene scene;
    scene.objects.push_back(techniques::testing::slab(2.0f, 0.5, -0.5, 0.1));
    return scene;
}

struct Named {
    const char* name;
    scene::Scene scene;
};

std::vector<Named> scenes() {
    return {{"hair", hairy_scene(false)},
            {"hair in smoke", hairy_scene(true)},
            {"slab", slabs()},
            {"layers", layers(12, base::Vec3f(0.08f))}};
}

// If the bound were of other functions, of another tolerance or by other rules than the map's, then the map with the
// fewest nodes would have more or fewer than it says.
TEST(NodeRatio, IsOneForTheFewestNodesAndAtLeastThatByDefault) {
    double largest = 0.0;
    for (const Named& entry : scenes())
        for (const char* more : {R"("tolerance": 0.02)", R"("tolerance": 0.002)",
                                 R"("tolerance": 0.02, "filter": "gaussian", "radius": 1.5)",
                                 R"("tolerance": 0.02, "mip": "nearest", "storage": "tiled")"}) {
            SCOPED_TRACE(std::string(entry.name) + ", " + more);
            const std::string parameters = std::string("{") + more;
            const auto optimal = ratio_of(entry.scene, parameters + R"(, "compression": "optimal"})");
            const auto bounded = ratio_of(entry.scene, parameters + "}");
            ASSERT_TRUE(optimal && bounded);
            EXPECT_EQ(optimal->ratio(), 1.0);
            EXPECT_EQ(optimal->cells, 144u) << "a map so small is compared in every pixel";
            EXPECT_EQ(optimal->left_out, 0u);
            EXPECT_EQ(bounded->fewest, optimal->nodes);
            EXPECT_GE(bounded->ratio(), 1.0);
            EXPECT_EQ(bounded->interval.low, bounded->interval.high);
            largest = std::max(largest, bounded->ratio());
        }
    EXPECT_GT(largest, 1.05) << "a ratio that is always 1 compares nothing";
}

TEST(NodeRatio, ComparesAnEvenShareOfManyCells) {
    const auto share = ratio_of(hairy_scene(false), R"({"tolerance": 0.02})", rays::testing::rays(36, 4));
    ASSERT_TRUE(share);
    EXPECT_GT(share->cells, 500u);
    EXPECT_LT(share->cells, 800u) << "one in two of 1,296";
    EXPECT_LT(share->interval.low, share->ratio());
    EXPECT_LT(share->ratio(), share->interval.high);
}

TEST(NodeRatio, LeavesOutPixelsOfThreeFunctions) {
    EXPECT_FALSE(ratio_of(layers(6, {0.1f, 0.2f, 0.3f}), R"({"tolerance": 0.02})"));
}

TEST(NodeRatio, IsAbsentWhereNothingIsStored) {
    EXPECT_FALSE(ratio_of(layers(1, base::Vec3f(0.0f)), R"({"tolerance": 0.02})"));
}

}  // namespace
}  // namespace shadowbench::bench
