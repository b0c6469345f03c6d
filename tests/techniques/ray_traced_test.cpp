#include <gtest/gtest.h>

#include "techniques/built.h"

namespace shadowbench::techniques {
namespace {

using testing::build;
using testing::Built;

// An opaque quad over all of y that slides from x in [-0.8, -0.3] to x in [0.1, 0.6], seen from above.
scene::Scene sliding_quad(const base::Vec3f& motion) {
    scene::Scene scene;
    scene.objects.push_back(rays::testing::quad({-0.8f, -3, 0}, {0.5f, 0, 0}, {0, 6, 0}));
    scene.objects[0].motion = motion;
    return scene;
}

// The share of the shutter during which the quad is above x.
double covered(double x, double speed) {
    const double from = std::clamp((x + 0.3) / speed, 0.0, 1.0), to = std::clamp((x + 0.8) / speed, 0.0, 1.0);
    return to - from;
}

TEST(RayTraced, AveragesOverTheShutterOfASceneThatMoves) {
    const Built b = build(find("ray_traced", ""), sliding_quad({0.9f, 0, 0}), rays::testing::directional(),
                          rays::testing::rays(16, 4), R"({"samples": 400})");
    for (const double x : {-0.9, -0.75, -0.4, -0.1, 0.2, 0.5, 0.8}) {
        const auto at = static_cast<float>((x + 1) * 8);
        // Narrow enough for one place; a time's part of the shutter is 1/400, at both ends of the quad's passage.
        EXPECT_NEAR(b.lookup(at, 7.3f, 1e6f, 0.001f), 1.0 - covered(x, 0.9), 0.006) << x;
    }
}

TEST(RayTraced, AnswersTheSameQueryTheSameWayInAnyCompany) {
    const Built b = build(find("ray_traced", ""), sliding_quad({0.9f, 0, 0}), rays::testing::directional(),
                          rays::testing::rays(16, 4), R"({"samples": 7})");
    std::vector<Query> queries;
    for (int i = 0; i < 50; ++i) queries.push_back({0.3f * static_cast<float>(i), 5.5f, 1e6f, 1.0f});
    std::vector<float> together(queries.size());
    b.map->lookup(queries, together);
    for (std::size_t i = 0; i < queries.size(); ++i)
        EXPECT_EQ(b.lookup(queries[i].x, queries[i].y, queries[i].z, queries[i].width), together[i]);
}

TEST(RayTraced, SeesAStillSceneAsItStands) {
    const Built b = build(find("ray_traced", ""), sliding_quad({0, 0, 0}), rays::testing::directional(),
                          rays::testing::rays(16, 4), R"({"samples": 4})");
    EXPECT_EQ(b.lookup(8 * 0.5f, 7.3f, 1e6f, 0.001f), 0.0f) << "under the quad";
    EXPECT_EQ(b.lookup(8 * 1.2f, 7.3f, 1e6f, 0.001f), 1.0f) << "where it would move to";
}

TEST(RayTraced, AFootprintThatHangsOverTheMapIsCutToIt) {
    scene::Scene scene;  // dark where x < 0, which is the map's left half
    scene.objects.push_back(rays::testing::quad({-3, -3, 0}, {3, 0, 0}, {0, 6, 0}));
    const Built b = build(find("ray_traced", ""), scene, rays::testing::directional(), rays::testing::rays(16, 4),
                          R"({"samples": 64})");
    EXPECT_EQ(b.lookup(8.0f, 8.0f, 1e6f, 1000.0f), 0.5f) << "eight columns of samples, four in the dark";
    EXPECT_EQ(b.lookup(15.0f, 8.0f, 1e6f, 10.0f), 1.0f);
    EXPECT_NEAR(b.lookup(0.0f, 8.0f, 1e6f, 20.0f), 0.2f, 0.08f) << "0 to 10, of which 8 are dark";
    EXPECT_EQ(b.lookup(0.01f, 15.99f, 1e6f, 15.0f), 0.0f);
}

}  // namespace
}  // namespace shadowbench::techniques
