// The choice of rays whose curves stand for a paper's figure.
#include "claims/texel.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/error.h"

namespace shadowbench::claims {
namespace {

constexpr int side = 64;

// A map of one tile. Ray i has i % 100 surfaces, each of which transmits `through`, at depths 1, 2, 3, ... thousandths.
std::vector<rays::LightRays> one_tile(float through) {
    rays::LightRays tile;
    tile.width = tile.height = side;
    tile.begin.push_back(0);
    for (int i = 0; i < side * side; ++i) {
        for (int s = 1; s <= i % 100; ++s) {
            tile.z_front.push_back(0.001f * static_cast<float>(s));
            tile.transmittance.push_back(through);
        }
        tile.begin.push_back(static_cast<std::uint32_t>(tile.z_front.size()));
    }
    return {tile};
}

rays::MapLayout layout() {
    rays::MapLayout layout;
    layout.width = layout.height = layout.tile_width = layout.tile_height = side;
    return layout;
}

TEST(ChooseRays, TakesThoseWithTheNumberOfNodesNearestToTheWish) {
    const auto places = choose_rays(one_tile(1.0f), layout(), {80}, 5);
    ASSERT_EQ(places.size(), 5u);
    for (const RayPlace& place : places) EXPECT_EQ(place.ray % 100, 40u) << "two nodes a segment";
}

TEST(ChooseRays, KeepsThemApart) {
    const auto places = choose_rays(one_tile(1.0f), layout(), {80}, 40);
    for (std::size_t i = 0; i < places.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
            const int a = static_cast<int>(places[i].ray), b = static_cast<int>(places[j].ray);
            EXPECT_GT(std::max(std::abs(a % side - b % side), std::abs(a / side - b / side)), side / 32);
        }
}

TEST(ChooseRays, WithoutAWishTakesTheBusiest) {
    EXPECT_EQ(choose_rays(one_tile(1.0f), layout(), {}, 1).front().ray, 99u);
}

// 0.3 of the light is left of 0.9^n for n up to 11.
TEST(ChooseRays, TakesOnlyRaysThatFit) {
    const RayPlace place = choose_rays(one_tile(0.9f), layout(), {0, lit_at_half_depth}, 1).front();
    EXPECT_EQ(place.ray % 100, 11u);
}

TEST(ChooseRays, TooFewAreAnError) {
    try {
        choose_rays(one_tile(1.0f), layout(), {80}, 4000);
        FAIL();
    } catch (const base::Error& error) {
        EXPECT_NE(error.message().find("of 4000 rays"), std::string::npos) << error.message();
    }
}

}  // namespace
}  // namespace shadowbench::claims
