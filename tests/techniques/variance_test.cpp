#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "techniques/one_ray.h"
#include "techniques/variants.h"

namespace shadowbench::techniques {
namespace {

using testing::HandMap;
using testing::HandRays;
using testing::OneRay;
using testing::Segments;

constexpr float last = 16.0f;  // depths of these maps: from 0
constexpr float infinity = std::numeric_limits<float>::infinity();

const Technique& variance() {
    return find("variance", "");
}

// One pixel of these rays.
HandMap pixel_of(const std::vector<Segments>& rays, const nlohmann::json& parameters = nlohmann::json::object()) {
    const HandRays given{1, 1, static_cast<int>(rays.size()), rays};
    rays::MapLayout layout = testing::layout_of(given);
    layout.z_min = 0.0f;
    layout.z_max = last;
    return testing::make_map(variance(), read_parameters(variance().parameters, parameters, ""), light_rays(given),
                             layout);
}

float ask(const HandMap& map, float z) {
    return map({0.5f, 0.5f, z, 1.0f});
}

// The technique's c of a depth: all depths behind the last one are at the far end.
double place(double z) {
    return z > last ? 1.0 : std::max(z, 0.0) / last - 1.0;
}

double chebyshev(double first, double second, double z, double least = 1e-6) {
    const double t = place(z), spread = std::max(second - first * first, least);
    return t <= first ? 1.0 : spread / (spread + (t - first) * (t - first));
}

Segments wall(float z, float through = 0.0f) {
    return {{z, z, through}};
}

TEST(Variance, OfTwoPlanesIsChebyshevsBound) {
    for (const int covered : {1, 5, 8, 12}) {
        std::vector<Segments> rays(16, wall(12));
        std::fill_n(rays.begin(), covered, wall(3));
        const HandMap map = pixel_of(rays);
        const double p = covered / 16.0, a = place(3), b = place(12);
        const double first = p * a + (1 - p) * b, second = p * a * a + (1 - p) * b * b;
        for (float z = -1.0f; z < 20.0f; z += 0.25f)
            EXPECT_NEAR(ask(map, z), chebyshev(first, second, z), 1e-5) << covered << " at " << z;
        EXPECT_NEAR(ask(map, 12.0f), 1 - p, 1e-5) << "at the deeper plane the bound is the truth";
        // All is opaque: what still gets through is the light bleeding, 1 / (1 + (distance / deviation)^2).
        const double distance = 1.0 - first, deviation = std::sqrt(p * (1 - p)) * (b - a);
        EXPECT_NEAR(ask(map, infinity), 1 / (1 + std::pow(distance / deviation, 2)), 1e-5);
    }
}

TEST(Variance, OfAHalfCoveredFootprintIsExactBehindEverything) {
    for (const float z : {0.0f, 1e-3f, 5.0f, last}) {
        const HandMap map = pixel_of({wall(z), {}, {}, wall(z)});
        EXPECT_EQ(ask(map, z), 1.0f) << "the wall itself is lit";
        for (const float behind : {std::nextafter(last, infinity), 1e6f, infinity})
            EXPECT_NEAR(ask(map, behind), 0.5f, 1e-6f) << z;
    }
}

// Half of the light is absorbed at 4, half at the far end: before their mean the bound says nothing.
TEST(Variance, BleedsLightBetweenAnOccluderAndTheFarEnd) {
    const HandMap map = pixel_of({wall(4), {}});
    EXPECT_EQ(ask(map, 5.0f), 1.0f);
    EXPECT_NEAR(ask(map, last), chebyshev(0.5 * place(4) + 0.5, 0.5 * place(4) * place(4) + 0.5, last), 1e-6);
}

// Averaged answers would be the truth here, but the technique averages the moments.
TEST(Variance, FiltersMomentsOverTheFootprint) {
    const HandRays given{4, 1, 1, {wall(3), wall(3), wall(12), wall(12)}};
    rays::MapLayout layout = testing::layout_of(given);
    layout.z_min = 0.0f;
    layout.z_max = last;
    const auto built = [&](const char* filter) {
        return testing::make_map(variance(), read_parameters(variance().parameters, {{"filter", filter}}, ""),
                                 light_rays(given), layout);
    };
    const HandMap footprint = built("footprint"), bilinear = built("bilinear"), point = built("point");
    const auto expected = [](double p, double z) {  // p of the map at depth 3
        const double a = place(3), b = place(12);
        return chebyshev(p * a + (1 - p) * b, p * a * a + (1 - p) * b * b, z);
    };
    for (const float z : {2.0f, 3.5f, 8.0f, 10.0f, 12.0f, 12.5f, 20.0f}) {
        EXPECT_NEAR(footprint({2.0f, 0.5f, z, 2.0f}), expected(0.5, z), 1e-5) << z;
        EXPECT_NEAR(footprint({2.5f, 0.5f, z, 3.0f}), expected(1.0 / 3.0, z), 1e-5) << z;
        EXPECT_NEAR(bilinear({1.75f, 0.5f, z, 0.0f}), expected(0.75, z), 1e-5) << z;
        EXPECT_NEAR(point({1.9f, 0.5f, z, 5.0f}), expected(1.0, z), 1e-5) << z;
    }
    EXPECT_GT(footprint({2.0f, 0.5f, 10.0f, 2.0f}), 0.6f) << "the mean of the answers is 0.5";
}

TEST(Variance, OfAPixelIsThatOfItsRaysHoweverTheyAreStored) {
    std::vector<Segments> rays;
    for (std::uint64_t seed = 0; seed < 16; ++seed) rays.push_back(testing::random_segments(seed, 5, 1, 15));
    const HandMap pixel = pixel_of(rays), sample = pixel_of(rays, {{"cells", "sample"}});
    EXPECT_EQ(pixel.map->bytes(), 8u);
    EXPECT_EQ(sample.map->bytes(), 16 * 8u);
    for (float z = 0.0f; z < 18.0f; z += 0.5f) EXPECT_NEAR(ask(pixel, z), ask(sample, z), 1e-6) << z;
}

TEST(Variance, HasTheLeastVarianceBehindALoneWall) {
    for (const double least : {1e-6, 1e-4, 0.01}) {
        const HandMap map = pixel_of({wall(4)}, {{"min_variance", least}});
        EXPECT_EQ(ask(map, 4.0f), 1.0f);
        for (const float beyond : {0.01f, 0.1f, 1.0f, 10.0f}) {
            const double t = beyond / last;
            EXPECT_NEAR(ask(map, 4.0f + beyond), least / (least + t * t), 1e-3);
        }
    }
}

// E(c) = -1 + integral of V, and E(c^2) = 1 + 2 integral of c V, over c from -1 to 1, V the transmittance: by Gauss's
// rule of three points in every panel between the ends of segments, in double.
void integrate(const OneRay& ray, const Segments& segments, double& first, double& second) {
    std::vector<double> ends{0.0, last};
    for (const testing::Segment& s : segments) ends.insert(ends.end(), {s.front, s.back});
    std::sort(ends.begin(), ends.end());
    const double through = ray.exact(2 * last);
    first = -1.0 + through;  // from 0 to 1 V is what passes everything
    second = 1.0 + through;
    constexpr int panels = 100;
    const double off = std::sqrt(0.15);
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        const double length = (ends[i + 1] - ends[i]) / last / panels;
        for (int k = 0; k < panels; ++k)
            for (const auto& [at, weight] : {std::pair{0.5 - off, 5.0 / 18}, {0.5, 8.0 / 18}, {0.5 + off, 5.0 / 18}}) {
                const double c = place(ends[i]) + (k + at) * length;
                const double v = weight * length * ray.exact((c + 1.0) * last);
                first += v;
                second += 2.0 * c * v;
            }
    }
}

TEST(Variance, HoldsTheMomentsOfTheLightThatIsTaken) {
    std::vector<Segments> cases = {wall(5, 0.3f),
                                   {{2, 2, 0.5f}, {9, 9, 0.5f}},
                                   {{3, 11, 0.9999f}},
                                   {{3, 11, 0.999f}},
                                   {{3, 11, 0.2f}},
                                   {{3, 11, 1e-20f}},
                                   {{3, 11, 0.5f}, {5, 14, 0.25f}, {7, 7, 0.5f}}};
    for (std::uint64_t seed = 0; seed < 20; ++seed) cases.push_back(testing::random_segments(seed, 8, 1, 15));
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const OneRay ray("variance", "{}", cases[i], 0, last);
        double first, second;
        integrate(ray, cases[i], first, second);
        // Each moment is rounded to a float, by up to 2^-25: this is the variance's error from it.
        const double allowed = 1e-6 + 0x1p-23 / std::max(second - first * first, 1e-6);
        for (float z = 0.125f; z < 18.0f; z += 0.25f)
            EXPECT_NEAR(ray(z), chebyshev(first, second, z), allowed) << "case " << i << " at " << z;
    }
}

TEST(Variance, IsNeverDarkerThanTheTruthAndKeepsItsLeak) {
    for (const double least : {0.0, 1e-6, 0.01, 1.0})
        for (std::uint64_t seed = 0; seed < 200; ++seed) {
            std::vector<Segments> rays;
            for (std::uint64_t r = 0; r < 4; ++r)
                rays.push_back(testing::random_segments(4 * seed + r, static_cast<int>(seed % 7), 0, last));
            if (seed % 3 == 0) rays[0] = wall(static_cast<float>(seed % 16));
            if (seed % 5 == 0) rays[3] = wall(0.0f);
            const HandMap map = pixel_of(rays, {{"min_variance", least}});
            const rays::LightRays given = testing::light_rays({1, 1, 4, rays});
            const auto truth = [&](double z) {
                double sum = 0.0;
                for (std::size_t r = 0; r < 4; ++r) sum += rays::transmittance(given, r, 0, z);
                return sum / 4;
            };
            for (float z = -0.5f; z < 17.0f; z += 0.5f) ASSERT_GE(ask(map, z), truth(z) - 1e-5) << seed << " at " << z;
            const Promises promised =
                promises(variance(), read_parameters(variance().parameters, {{"min_variance", least}}, ""));
            ASSERT_LE(ask(map, infinity), truth(2 * last) + promised.leak + 1e-6) << seed << " " << least;
        }
}

}  // namespace
}  // namespace shadowbench::techniques
