#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/error.h"
#include "bench/queries.h"
#include "bench/reference.h"
#include "rays/light_view.h"
#include "scene/scene.h"

namespace shadowbench::bench {
namespace {

using techniques::Query;

// The edge of a half-plane: the mean over a footprint of width w at a distance d inside the shadow is 1/2 - d/w. It is
// the same footprint at every resolution, so the answer is too, up to the rays that the edge cuts.
TEST(Rescaled, QueriesAskTheSameFootprintOfMapsOfEveryResolution) {
    scene::Scenario scenario;
    scene::Object quad;
    scene::Mesh mesh;
    mesh.positions = {{-2, 0, -2}, {0, 0, -2}, {0, 0, 2}, {-2, 0, 2}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    quad.shape = mesh;
    scene::Scene scene;
    scene.objects = {quad};
    scene::Light light;
    light.extent = base::Vec2d(2, 2);
    const auto view_of = [&](int side) { return rays::make_light_view(light, scene, {side, side}, ""); };

    const rays::LightView own = view_of(10);
    std::vector<Query> queries;
    std::vector<double> expected;
    for (const double width : {0.5, 1.0, 3.0})
        for (const double share : {-0.9, -0.5, -0.2, 0.0, 0.3, 0.7, 0.9}) {
            const base::Vec3d place = rays::to_light(own, {0.1 * width * share, -1.0, 0.033});  // a pixel is 0.2 wide
            queries.push_back({static_cast<float>(place.x), static_cast<float>(place.y), static_cast<float>(place.z),
                               static_cast<float>(width)});
            expected.push_back(0.5 + 0.5 * share);  // lit where x > 0
        }
    for (const int side : {7, 10, 23, 80}) {
        const rays::LightView view = view_of(side);
        const QuerySet asked = rescaled(Asked(queries), own, view);
        scene::RaySettings settings;
        settings.resolution = {side, side};
        settings.samples_per_pixel = 48 * 48;
        settings.pattern = scene::Pattern::regular;
        const Truth truth = reference_visibility(scene, view, settings, asked.queries, {});
        for (std::size_t i = 0; i < queries.size(); ++i) {
            const double columns = 48.0 * asked.queries[i].width;  // of rays in the footprint
            EXPECT_NEAR(asked.queries[i].width * view.pixel.x, queries[i].width * own.pixel.x, 1e-6);
            EXPECT_NEAR(truth.value[i], expected[i], 2.0 / columns) << side << " " << i;
        }
    }
}

TEST(Rescaled, PositionsStayInTheMapAndFootprintsGrowWithIt) {
    rays::LightView own, fine;
    own.resolution = {3, 3};
    own.pixel = {1.0, 1.0};
    fine.resolution = {7, 7};
    fine.pixel = {3.0 / 7.0, 3.0 / 7.0};
    const std::vector<Query> queries{{std::nextafter(3.0f, 0.0f), std::nextafter(3.0f, 0.0f), 1.0f, 1.5f}};
    const std::vector<techniques::Footprint> footprints{{1.0f, 0.0f, 0.5f, 2.0f}};
    const QuerySet set = rescaled({queries, footprints}, own, fine);
    EXPECT_LT(set.queries[0].x, 7.0f);
    EXPECT_LT(set.queries[0].y, 7.0f);
    EXPECT_FLOAT_EQ(set.queries[0].width, 3.5f);
    EXPECT_FLOAT_EQ(set.footprints[0].vy, 14.0f / 3.0f);
    fine.lower = {0.5, 0.0};
    EXPECT_THROW(rescaled({queries, footprints}, own, fine), base::Error);
}

}  // namespace
}  // namespace shadowbench::bench
