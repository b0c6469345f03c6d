#include "render/exposure.h"

#include <gtest/gtest.h>

#include <vector>

namespace shadowbench::render {
namespace {

using base::Vec3f;

TEST(Exposure, TheBrightestOfWhatIsSeenIsNearlyWhite) {
    Image picture({10, 20}, Vec3f(0.1f, 0.3f, 0.2f));
    std::vector<float> seen(200, 1.0f);
    EXPECT_NEAR(exposure_of(picture, seen), 3.0, 1e-6);
    picture.at(0, 0) = Vec3f(50.0f);  // one highlight of 200 pixels does not darken the print
    EXPECT_NEAR(exposure_of(picture, seen), 3.0, 1e-6);
    for (std::size_t i = 0; i < 20; ++i) picture.pixels[i] = Vec3f(50.0f), seen[i] = 0.0f;  // not seen: does not count
    EXPECT_NEAR(exposure_of(picture, seen), 3.0, 1e-6);
    EXPECT_EQ(exposure_of(Image({2, 2}, Vec3f(0.0f)), std::vector<float>(4, 1.0f)), 1.0);
    EXPECT_EQ(exposure_of(picture, std::vector<float>(200, 0.0f)), 1.0);
}

TEST(Exposure, WhatIsNotSeenIsGreyAndExposureLeavesItSo) {
    Image picture({2, 1}, Vec3f(0.2f));
    picture.at(1, 0) = Vec3f(0.1f);  // half of this pixel shows something
    const Image dim = on_grey(picture, std::vector<float>{0.0f, 0.5f}, 1.0),
                bright = on_grey(picture, std::vector<float>{1.0f, 0.5f}, 2.0);
    EXPECT_FLOAT_EQ(dim.at(1, 0).x, 0.1f + 0.15f);
    EXPECT_FLOAT_EQ(bright.at(0, 0).x, 0.4f);
    EXPECT_FLOAT_EQ(bright.at(1, 0).x, 0.2f + 0.15f);
}

}  // namespace
}  // namespace shadowbench::render
