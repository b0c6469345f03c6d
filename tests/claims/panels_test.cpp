#include "claims/panels.h"

#include <gtest/gtest.h>

#include <vector>

#include "render/display.h"

namespace shadowbench::claims {
namespace {

using base::Vec3f;
using render::Image;

TEST(Panels, DifferencesAreDarkOnWhite) {
    Image difference({3, 1}, Vec3f(0.0f));
    difference.at(1, 0) = Vec3f(0.01f, 0.0f, 2.0f);
    const Image printed = dark_on_white(difference);
    EXPECT_EQ(printed.at(0, 0), Vec3f(1.0f));
    EXPECT_EQ(printed.at(1, 0).y, 1.0f);
    EXPECT_NEAR(printed.at(1, 0).z, 0.0f, 1e-6f);
    // A hundredth is a tenth of the way from black to white on a display, and from white to black in print.
    EXPECT_NEAR(render::to_display(printed.at(1, 0).x), 1.0 - render::to_display(0.01), 1e-6);
    EXPECT_LT(render::to_display(printed.at(1, 0).x), 0.91);
}

TEST(Panels, StandSideBySideWithTheirNumbers) {
    std::vector<Panel> panels;
    for (const float value : {0.25f, 0.5f})
        panels.push_back({Image({60, 50}, Vec3f(value)), Image({60, 50}, Vec3f(value / 2))});
    const Image sheet = side_by_side(panels);
    ASSERT_EQ(sheet.width, 124);
    ASSERT_EQ(sheet.height, 104);
    for (int i = 0; i < 2; ++i) {
        const float value = i == 0 ? 0.25f : 0.5f;
        EXPECT_EQ(sheet.at(64 * i + 40, 10), Vec3f(value));
        EXPECT_EQ(sheet.at(64 * i + 40, 100), Vec3f(value / 2));
        EXPECT_EQ(sheet.at(64 * i, 49), Vec3f(1.0f)) << "the field of the number";
        EXPECT_EQ(sheet.at(64 * i, 103), Vec3f(value / 2)) << "only the upper picture has a number";
    }
    EXPECT_EQ(sheet.at(62, 20), Vec3f(1.0f)) << "between the panels";
    bool differ = false;
    for (int y = 23; y < 50; ++y)
        for (int x = 0; x < 20; ++x) differ = differ || sheet.at(x, y) != sheet.at(64 + x, y);
    EXPECT_TRUE(differ) << "1 and 2 look alike";
}

}  // namespace
}  // namespace shadowbench::claims
