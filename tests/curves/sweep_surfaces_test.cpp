#include "curves/sweep_surfaces.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "cases.h"
#include "curves/norms.h"

namespace shadowbench::curves {
namespace {

using cases::Segment;
using Pixel = std::vector<std::vector<Segment>>;

rc::Gen<Pixel> any_pixel() {
    return rc::gen::apply(
        [](std::uint64_t seed, int count) {
            base::Random random(seed);
            cases::DepthPalette palette(random);
            Pixel pixel;
            for (int i = 0; i < count; ++i) pixel.push_back(cases::adversarial_ray(random, palette, 12, false));
            return pixel;
        },
        cases::full_range(rc::gen::inRange<std::uint64_t>(0, 1u << 20)), cases::full_range(rc::gen::inRange(1, 9)));
}

Curve visibility_of(const Pixel& pixel) {
    SweepScratch scratch;
    Curve out;
    const rays::LightRays rays = cases::make_rays(pixel, false);
    visibility_of_surfaces(rays, 0, rays.rays(), 0, scratch, out);
    return out;
}

template <class T>
void shuffle(std::vector<T>& items, base::Random& random) {
    for (std::size_t i = items.size(); i > 1; --i) std::swap(items[i - 1], items[random.below(i)]);
}

RC_GTEST_PROP(SweepSurfaces, TheOrderOfTheRaysChangesNothing, ()) {
    Pixel pixel = *any_pixel();
    const Curve expected = visibility_of(pixel);
    base::Random random(*cases::full_range(rc::gen::inRange<std::uint64_t>(0, 1000)));
    shuffle(pixel, random);
    RC_ASSERT(visibility_of(pixel) == expected);
}

// Their product rounds differently in the 53rd digit; one float in a thousand million shows it.
RC_GTEST_PROP(SweepSurfaces, TheOrderOfHitsAtOneDepthChangesTheLastDigitOfAFloatAtMost, ()) {
    Pixel pixel = *any_pixel();
    const Curve expected = visibility_of(pixel);
    base::Random random(*cases::full_range(rc::gen::inRange<std::uint64_t>(0, 1000)));
    for (auto& ray : pixel) shuffle(ray, random);
    RC_ASSERT(distance(visibility_of(pixel), expected, 0.0, 0.0).max <= 0x1p-24);
}

TEST(SweepSurfaces, KnowsWhetherAnySegmentHasAnExtent) {
    const auto rays = cases::make_rays({{{1, 1, 0.5f}}, {{1, 2, 0.5f}}, {}}, true);
    EXPECT_TRUE(surfaces_only(rays, 0, 1));
    EXPECT_FALSE(surfaces_only(rays, 0, 2));
    EXPECT_TRUE(surfaces_only(rays, 2, 1));
    EXPECT_TRUE(surfaces_only(rays, std::vector<WeightedRay>{{0, 0.5}, {2, 0.5}}));
    EXPECT_FALSE(surfaces_only(rays, std::vector<WeightedRay>{{1, 1.0}}));
}

}  // namespace
}  // namespace shadowbench::curves
