// Figure 9 of Reeves, Salesin, Cook 1987 at 89.9 degrees: the effect of a bias on a ground that shades itself, and on
// the shadow of a wall on it.
#include <gtest/gtest.h>

#include <cmath>

#include "bench/hard_case.h"

namespace shadowbench::bench {
namespace {

using techniques::Query;

constexpr double slope = 573.0;  // of the ground in the light's view: its depth per length across the light
constexpr double wall_shadow = 0.002 * slope;  // how far the wall of 0.002 shades the ground

// One technique's answers for points of the ground at distances behind the wall, moved towards the light by a bias.
std::vector<float> ask(const HardCase& hard, const Contender& contender, const std::vector<double>& distances,
                       double bias) {
    std::vector<Query> queries;
    for (const double x : distances)
        for (double along = -0.8; along < 0.8; along += 0.1) {  // the wall
            queries.push_back(hard.at({x, 0, along}));
            queries.back().z = static_cast<float>(rays::to_light(hard.view(), {x, 0, along}).z - bias);
        }
    return lookup_all(contender.maps, {queries});
}

std::vector<double> between(double low, double high, int count) {
    std::vector<double> places;
    for (int i = 0; i < count; ++i) places.push_back(low + (high - low) * (i + 0.5) / count);
    return places;
}

double mean(const std::vector<float>& values) {
    double sum = 0.0;
    for (const float v : values) sum += v;
    return sum / static_cast<double>(values.size());
}

// The share of a ground that stays lit although it shades itself, if receivers are moved towards the light by `bias`
// (in depths that the ground passes within a pixel) and the samples lie anywhere ...
double around_receiver(double bias) {  // ... in a pixel around it
    return std::min(0.5 + bias, 1.0);
}
double in_same_pixel(double bias) {  // ... in the pixel of the receiver
    const double rest = std::max(1.0 - bias, 0.0);
    return 1.0 - 0.5 * rest * rest;
}
double in_same_sample(double bias) {  // ... in the same quarter of its pixel
    return in_same_pixel(4 * bias);
}

struct Tested {
    const char* technique;
    const char* parameters;
    double (*lit)(double bias);
};
const Tested all_tested[] = {{"shadow_map", "", in_same_sample},
                             {"deep", "tolerance=0", in_same_pixel},
                             {"avsm", "", in_same_pixel},
                             {"uncompressed", "", around_receiver},
                             {"ray_traced", "", around_receiver}};

class HardGrazing : public testing::Test {
protected:
    template <class Visit>
    void for_each(const Visit& visit) const {
        int visited = 0;
        for (const Contender& contender : hard.contenders())
            for (const Tested& tested : all_tested)
                if (contender.cell.technique == tested.technique && contender.cell.parameters == tested.parameters) {
                    visit(contender, tested);
                    ++visited;
                }
        EXPECT_EQ(visited, 5);
    }
    const HardCase hard{"grazing"};
    const double pixel = hard.view().pixel.y * slope;  // depth that the ground passes in a pixel
};

TEST_F(HardGrazing, AcneIsTheDepthBetweenSamplesAndVanishesWithTheBias) {
    for_each([&](const Contender& contender, const Tested& tested) {
        for (const double bias : {0.0, 0.05, 0.1, 0.25, 0.5, 2.0})
            EXPECT_NEAR(mean(ask(hard, contender, between(-0.7, -0.1, 400), bias * pixel)), tested.lit(bias), 0.05)
                << contender.cell.technique << " with a bias of " << bias << " pixels";
    });
}

TEST_F(HardGrazing, PeterPanningIsAsLongAsTheBias) {
    // A receiver closer behind the wall than the bias is moved to its front.
    for_each([&](const Contender& contender, const Tested&) {
        for (const double bias : {0.3, 0.6, 0.9}) {
            EXPECT_GT(mean(ask(hard, contender, between(0.01, bias - 0.01, 100), bias)), 0.99)
                << contender.cell.technique << " before the wall with a bias of " << bias;
            EXPECT_LT(mean(ask(hard, contender, between(bias + 0.01, wall_shadow - pixel, 100), bias)), 0.01)
                << contender.cell.technique << " behind the wall with a bias of " << bias;
        }
    });
}

}  // namespace
}  // namespace shadowbench::bench
