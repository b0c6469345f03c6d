// Surfaces that floats can hardly separate, or thousands of surfaces, on the committed scenarios, compared with closed
// forms in long double.
#include <gtest/gtest.h>

#include <cmath>

#include "bench/hard_case.h"

namespace shadowbench::bench {
namespace {

using techniques::Query;

// The transmittance of n crossings of `opacity`, rounded to a float.
long double left(float opacity, int n) {
    return std::exp(n * std::log1p(-static_cast<long double>(opacity)));
}

TEST(HardSurfaces, WallsOverNineDecadesEachTakeHalf) {
    const HardCase hard("depth_range");
    std::vector<Query> queries;
    std::vector<long double> expected;
    const float second = 0.001000001f;
    const std::vector<std::pair<float, int>> walls_before = {
        {0.0005f, 0},   {0.001f, 0}, {std::nextafter(0.001f, 1.0f), 1}, {second, 1}, {std::nextafter(second, 1.0f), 2},
        {0.9f, 2},      {1.0f, 2},   {std::nextafter(1.0f, 2.0f), 3},   {999.0f, 3}, {1001.0f, 4},
        {999999.0f, 4}, {1e6f, 4},   {std::nextafter(1e6f, 2e6f), 5},   {3e9f, 5}};
    for (const auto& [z, walls] : walls_before) {
        queries.push_back({2.5f, 2.5f, z, 1.0f});  // beside the ball, which fills far less than a pixel in the middle
        expected.push_back(std::ldexp(1.0L, -walls));
    }
    hard.expect(queries, expected);
}

TEST(HardSurfaces, LayersOneFloatApartAreCountedOneByOne) {
    const HardCase hard("ulp_layers");
    std::vector<Query> queries;
    std::vector<long double> expected;
    for (const int layer : {0, 1, 2, 3, 100, 1000, 2047, 2048, 4000, 4095, 4096, 5000}) {
        // Layer i is at depth 1 + i 2^-23, behind i layers.
        queries.push_back({1.5f, 2.5f, 1.0f + 0x1p-23f * static_cast<float>(layer), 1.0f});
        expected.push_back(left(0x1p-10f, std::min(layer, 4096)));
    }
    hard.expect(queries, expected);
}

// A query between layers of a scenario whose layer i is at height 0.5 - i 1e-5.
void expect_layers(const HardCase& hard, float opacity, double slack) {
    std::vector<Query> queries;
    std::vector<long double> expected;
    for (const int layers : {0, 1, 2, 3, 10, 14, 100, 3000, 10000, 30000, 69315, 99999, 100000}) {
        queries.push_back(hard.at({0.1, 0.500005 - 1e-5 * layers, 0.1}));
        expected.push_back(left(opacity, layers));
    }
    hard.expect(queries, expected, slack);
}

TEST(HardSurfaces, AHundredThousandFaintLayersTakeAllLight) {
    // A light ray holds a transmittance with a last digit of 2^-24. An error of half of it occurs n times, and
    // n (1 - a)^n is at most 1 / (a e).
    expect_layers(HardCase("faint_layers"), 1e-4f, 2e-6 + 0x1p-25 / (1e-4 * std::exp(1.0)));
}

TEST(HardSurfaces, AHundredThousandFaintLayersAreMultipliedWithoutDrift) {
    // As above, but for the opacity that the light rays hold: no technique with a bound loses more than that.
    const HardCase hard("faint_layers", {"techniques=[{\"type\": \"deep\", \"tolerance\": 0}, {\"type\": \"deep\"}, "
                                         "{\"type\": \"uncompressed\"}]"});
    expect_layers(hard, 1.0f - (1.0f - 1e-4f), 2e-6);
}

TEST(HardSurfaces, AHundredThousandDenseLayersLeaveNoLight) {
    expect_layers(HardCase("dense_layers"), 0.999f, 2e-6);
}

TEST(HardSurfaces, CoincidentSurfacesShadeOnlyWhatIsStrictlyBehindThem) {
    const HardCase hard("coincident");
    const float z = hard.at({0, 0, 0}).z;
    std::vector<Query> queries;
    std::vector<long double> expected;
    for (const double x : {-0.7, -0.3, 0.3, 0.7})
        for (const double y : {-0.6, -0.1, 0.4}) {
            Query q = hard.at({x, 0, y}, 0.5f);
            queries.push_back(q);
            expected.push_back(1.0L);
            q.z = std::nextafter(z, 10.0f);
            queries.push_back(q);
            expected.push_back(x > 0 ? 0.0L : 0.25L);
        }
    hard.expect(queries, expected);
}

TEST(HardSurfaces, AFilterWiderThanTheMapGivesItsMean) {
    const HardCase hard("wide_filter", {"timing.lookups=1"});
    std::vector<Query> queries;
    std::vector<long double> expected;
    for (const double x : {-0.99, 0.0, 0.5})
        for (const float width : {3.0f, 64.0f, 100.0f, 1024.0f}) {
            queries.push_back(hard.at({x, -0.5, -0.3}, width));
            expected.push_back(left(0.7f, 1));
        }
    hard.expect(queries, expected);
}

TEST(HardSurfaces, JitteredSamplesFindHalfOfACheckerboardAndRegularOnesAllOrNothing) {
    for (const char* pattern : {"regular", "jittered"}) {
        const HardCase hard("checkerboard", {std::string("rays.pattern=") + pattern});
        const Query behind = hard.at({0, -1, 0}, 16.0f);
        for (const Contender& contender : hard.contenders()) {
            if (contender.cell.technique != "uncompressed" && contender.cell.technique != "deep") continue;
            const float mean = lookup_all(contender.maps, {std::vector<Query>{behind}})[0];
            if (std::string(pattern) == "regular")
                EXPECT_NEAR(mean, 0.0f, 1e-3) << "every sample is at the same place of its square, which is opaque";
            else
                EXPECT_NEAR(mean, 0.5f, 0.03) << "4,096 samples of mean 1/2 and at most as much deviation, four times";
        }
    }
}

TEST(HardSurfaces, AMapThatSeesNothingIsLit) {
    const HardCase hard("empty_map");
    std::vector<Query> queries;
    for (const float x : {0.0f, 3.3f, 15.99f})
        for (const float z : {-1.0f, 0.0f, 0.5f, 1e30f}) queries.push_back({x, 7.0f, z, 2.0f});
    hard.expect(queries, std::vector<long double>(queries.size(), 1.0L), 0.0);
}

}  // namespace
}  // namespace shadowbench::bench
