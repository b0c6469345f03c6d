#include "claims/volume.h"

#include <gtest/gtest.h>

#include <cmath>

#include "claims/volume_crossings.h"
#include "claims/volume_depths.h"
#include "claims/volume_map.h"
#include "claims/volume_rays.h"
#include "rays/grid_media.h"

namespace shadowbench::claims::volume {
namespace {

Context quick_context(PaperReport& report) {
    Context context;
    context.scenarios = std::filesystem::path(SHADOWBENCH_SOURCE_DIR) / "scenarios/papers";
    context.quick = true;
    context.report = &report;
    return context;
}

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
    PaperReport report;
    const Context context = quick_context(report);
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

TEST(VolumeDepths, AreOfRaysThatHaveLostTheLevelsThere) {
    PaperReport report;
    const Context context = quick_context(report);
    with_map(context, "volume_box", 24, [](const VolumeMap& map) {
        const rays::GridMedia media(map.scenario.scene, true);
        const std::vector<TexelRay> texels = texel_rays(map.scenario.scene, map.view, *map.maps.layout);
        ASSERT_EQ(texels.size(), 24u * 24u) << "as many as there are";
        int reached = 0;
        for (const TexelRay& texel : texels)
            for (std::size_t i = 0; i < levels.size(); ++i) {
                if (texel.exact.most < levels[i]) continue;
                ++reached;
                const double z = texel.exact.depth[i];
                base::Vec3d depth;
                media.optical_depths(map.view, texel.x + 0.5, texel.y + 0.5, 0.0, std::span(&z, 1),
                                     std::span(&depth, 1));
                EXPECT_NEAR(-std::expm1(-depth.x), levels[i], 1e-4);
            }
        EXPECT_GT(reached, 100);
        const double error = depth_error(map.maps, texels, map_steps);
        EXPECT_GT(error, 0.0);
        EXPECT_LT(error, 1.0) << "steps";
        EXPECT_NEAR(depth_error(map.maps, texels, 2 * map_steps), 2.0 * error, 1e-9) << "of half the length";
    });
}

TEST(VolumeViews, GoAroundTheTarget) {
    scene::Camera camera;
    camera.position = {4, 2, 0};
    camera.target = {1, 1, 0};
    const base::Vec3d half = turned(camera, 180.0).position, quarter = turned(camera, 90.0).position;
    EXPECT_LT((half - base::Vec3d(-2, 2, 0)).length(), 1e-12);
    EXPECT_LT((quarter - base::Vec3d(1, 2, -3)).length(), 1e-12);
    EXPECT_EQ(turned(camera, 0.0).position, camera.position);
}

TEST(VolumeViews, NumbersAreOverTheRaysThroughTheBox) {
    std::vector<render::BoxRay> rays(3);
    rays[0].back = rays[2].back = 1.0;  // the second misses the box
    const std::vector<double> a{1.0, 9.0, 2.0}, b{1.0, 0.0, 0.0};
    EXPECT_DOUBLE_EQ(rms(rays, a, b), std::sqrt(2.0));
    EXPECT_DOUBLE_EQ(mean(rays, a), 1.5);
}

TEST(VolumeCrossings, HaveANumberForEachSeed) {
    PaperReport report;
    const Context context = quick_context(report);
    const Crossings box = measure_crossings(context, data_sets[0]);
    ASSERT_EQ(box.all.smooth.size(), static_cast<std::size_t>(views));
    for (std::size_t seed = 0; seed < box.all.smooth.size(); ++seed) {
        EXPECT_LT(box.all.apart[seed], box.few.apart[seed]) << "a step is at most as long as its map lets it be";
        EXPECT_LT(box.all.light_apart[seed], box.few.light_apart[seed]);
        EXPECT_GT(box.all.light_apart[seed], 0.0);
        EXPECT_LT(box.all.smooth[seed], box.shadow_map[seed]);
        EXPECT_LT(box.all.smooth_depth[seed], box.all.bucket_depth[seed]);
        EXPECT_GT(box.all.bucket_depth[seed], 0.3) << "a level is crossed anywhere in a step";
        EXPECT_LT(box.all.bucket_depth[seed], 1.0);
        if (seed == 0) continue;
        EXPECT_NE(box.all.smooth[seed], box.all.smooth[0]) << "of other rays";
    }
    EXPECT_EQ(box.builds.times.size(), 3u);
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
