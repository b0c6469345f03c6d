#include "claims/volume.h"

#include <gtest/gtest.h>

#include <cmath>

#include "claims/volume_map.h"
#include "rays/grid_media.h"

namespace shadowbench::claims::volume {
namespace {

TEST(VolumeChannels, AreTheDepthsOfTheLevelsAndTheLoss) {
    const Channels all = channels_of(curves::Curve{{1, 1}, {1, 0.9f}, {2, 0.5f}, {4, 0.1f}, {4, 0.05f}});
    EXPECT_EQ(all.depth, (std::array<float, 3>{1, 2, 4}));
    EXPECT_EQ(all.most, 0.95f);
    const Channels jump = channels_of(curves::Curve{{3, 1}, {3, 0.0f}});
    EXPECT_EQ(jump.depth, (std::array<float, 3>{3, 3, 3}));
    EXPECT_EQ(jump.most, 1.0f);
    EXPECT_EQ(channels_of({}).most, 0.0f);
}

TEST(VolumeChannels, OfALevelThatIsNotReachedIsWhereAllIsLost) {
    const Channels half = channels_of(curves::Curve{{1, 1}, {1, 0.9f}, {2, 0.7f}});
    EXPECT_EQ(half.depth, (std::array<float, 3>{1, 2, 2}));
    EXPECT_FLOAT_EQ(half.most, 0.3f);
}

// The channels of the committed box, against the exact optical depth along each light ray.
TEST(VolumeChannels, OfAMapAreThoseOfTheExactLightRays) {
    Context context;
    context.scenarios = std::filesystem::path(SHADOWBENCH_SOURCE_DIR) / "scenarios/papers";
    with_map(context, "volume_box", 24, [](const VolumeMap& map) {
        const rays::GridMedia media(map.scenario.scene, true);
        const double step = (map.view.z_max - map.view.z_min) / map_steps;
        curves::Curve function;
        int met = 0;
        for (int y = 0; y < 24; ++y)
            for (int x = 0; x < 24; ++x) {
                bench::stored(map.maps, x, y, 0, {}, function);
                const Channels channels = channels_of(function);
                const auto opacity = [&](double z) {
                    base::Vec3d depth;
                    media.optical_depths(map.view, x + 0.5, y + 0.5, 0.0, std::span(&z, 1), std::span(&depth, 1));
                    return -std::expm1(-depth.x);
                };
                EXPECT_NEAR(channels.most, opacity(map.view.z_max), 1e-3);
                if (channels.most < 0.5f) continue;
                ++met;
                for (int level = 0; level < 2; ++level) {
                    const double z = channels.depth[static_cast<std::size_t>(level)], wanted = level == 0 ? 0.1 : 0.5;
                    EXPECT_LE(opacity(z - step), wanted + 1e-3) << x << " " << y;
                    EXPECT_GE(opacity(z + step), wanted - 1e-3) << x << " " << y;
                }
            }
        EXPECT_GT(met, 50);
    });
}

TEST(VolumeSheet, PutsPicturesInRows) {
    const std::vector<render::Image> pictures(5, render::Image({20, 10}, base::Vec3f(0.5f)));
    const Sheet sheet = sheet_of("name", "caption", pictures, 3);
    ASSERT_GT(sheet.png.size(), 24u);
    const auto side = [&](std::size_t at) {  // big-endian, of the header of a PNG file
        return static_cast<unsigned char>(sheet.png[at + 3]) + 256 * static_cast<unsigned char>(sheet.png[at + 2]);
    };
    EXPECT_EQ(side(16), 3 * 24 - 4);
    EXPECT_EQ(side(20), 2 * 14 - 4);
}

}  // namespace
}  // namespace shadowbench::claims::volume
