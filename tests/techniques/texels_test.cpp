// The filters that all techniques of one texel per ray share.
#include <gtest/gtest.h>

#include "techniques/built.h"

namespace shadowbench::techniques {
namespace {

class Texels : public ::testing::TestWithParam<const char*> {
protected:
    testing::Built build(const char* parameters, int samples) const {
        return testing::build(find(GetParam(), ""), testing::hairy_scene(true), rays::testing::directional(),
                              rays::testing::rays(16, samples), parameters);
    }
};

TEST_P(Texels, BilinearLookupsBlendFourTexels) {
    const auto b = build(R"({"filter": "bilinear"})", 1), point = build(R"({"filter": "point"})", 1);
    int grey = 0;
    for (const auto& [x, y] : {std::pair{8.5f, 8.5f}, {8.75f, 6.0f}, {3.2f, 9.9f}, {0.1f, 15.9f}}) {
        const float fx = std::clamp(x - 0.5f, 0.0f, 15.0f), fy = std::clamp(y - 0.5f, 0.0f, 15.0f);
        const int i = static_cast<int>(fx), j = static_cast<int>(fy);
        const float wx = fx - static_cast<float>(i), wy = fy - static_cast<float>(j);
        const auto at = [&](int dx, int dy) {
            return point.lookup(static_cast<float>(std::min(i + dx, 15)) + 0.5f,
                                static_cast<float>(std::min(j + dy, 15)) + 0.5f, 1.0f);
        };
        const float expected =
            (1 - wy) * ((1 - wx) * at(0, 0) + wx * at(1, 0)) + wy * ((1 - wx) * at(0, 1) + wx * at(1, 1));
        EXPECT_NEAR(b.lookup(x, y, 1.0f), expected, 1e-6f);
        grey += expected > 0.0f && expected < 1.0f;
    }
    EXPECT_GE(grey, 3);
}

TEST_P(Texels, AFootprintIsTheMeanOfItsTexels) {
    const auto b = build(R"({"filter": "footprint", "cells": "sample"})", 4),
               point = build(R"({"filter": "point", "cells": "sample"})", 4);
    const auto mean = [&](float x0, float x1, float y0, float y1) {  // texels are half a pixel wide
        double sum = 0.0;
        int count = 0;
        for (float y = y0 + 0.25f; y < y1; y += 0.5f)
            for (float x = x0 + 0.25f; x < x1; x += 0.5f, ++count) sum += point.lookup(x, y, 1.0f);
        return sum / count;
    };
    EXPECT_NEAR(b.lookup(8.5f, 6.5f, 1.0f, 1.0f), mean(8, 9, 6, 7), 1e-6);
    EXPECT_NEAR(b.lookup(8.0f, 6.0f, 1.0f, 4.0f), mean(6, 10, 4, 8), 1e-6);
    EXPECT_NEAR(b.lookup(0.5f, 15.5f, 1.0f, 3.0f), mean(0, 2, 14, 16), 1e-6) << "clipped to the map";
    EXPECT_EQ(b.lookup(8.3f, 6.8f, 1.0f, 0.01f), point.lookup(8.3f, 6.8f, 1.0f)) << "one texel at least";
}

TEST_P(Texels, AQuarterOfAMillionTexelsHaveTheMeanOfOne) {
    // Added up in float, each 0.3 is rounded the same way once the sum is large: to 0.297 above 65,536.
    scene::Scene scene;
    scene.objects.push_back(rays::testing::quad({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, 0.7f));
    const auto b = testing::build(find(GetParam(), ""), scene, rays::testing::directional(),
                                  rays::testing::rays(64, 64), R"({"cells": "sample"})");
    const float one = b.lookup(32.0f, 32.0f, 1e6f, 0.01f);
    EXPECT_NEAR(b.lookup(32.0f, 32.0f, 1e6f, 64.0f), one, 1e-7f);
}

TEST_P(Texels, TheCentreIsOneRayOfEachPixel) {
    const auto all = build(R"({"cells": "sample"})", 4), one = build(R"({"cells": "centre", "filter": "point"})", 4);
    EXPECT_EQ(one.map->bytes() * 4, all.map->bytes());
    const auto point = build(R"({"filter": "point", "cells": "sample"})", 4);
    for (int y = 0; y < 16; ++y)  // the sample cell right above the middle
        for (int x = 0; x < 16; ++x)
            EXPECT_EQ(one.lookup(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, 1.0f),
                      point.lookup(static_cast<float>(x) + 0.75f, static_cast<float>(y) + 0.75f, 1.0f));
}

INSTANTIATE_TEST_SUITE_P(Techniques, Texels, ::testing::Values("avsm", "opacity", "fourier", "volume_deep"),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace
}  // namespace shadowbench::techniques
