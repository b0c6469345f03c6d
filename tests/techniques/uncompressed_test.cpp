#include <gtest/gtest.h>

#include "techniques/built.h"

namespace shadowbench::techniques {
namespace {

// The mean of the oracle over the rays of the footprint, found by checking every ray of the map.
double oracle(const testing::Captured& c, const Query& q) {
    double sum = 0.0;
    int count = 0;
    rays::testing::for_each_ray(c, [&](const rays::LightRays& tile, std::size_t ray, int i, int j) {
        const rays::SamplePosition p = sample_position(c.layout, i, j);
        if (std::abs(p.x - q.x) > 0.5 * q.width || std::abs(p.y - q.y) > 0.5 * q.width) return;
        sum += rays::transmittance(tile, ray, 0, q.z);
        ++count;
    });
    return sum / count;
}

TEST(Uncompressed, AgreesWithTheDoubleOracle) {
    for (const bool media : {false, true}) {
        scene::Scene scene = testing::hairy_scene(media);
        if (media) scene.objects.push_back(testing::slab(0.7f, 0.4, -0.6, 0.03));
        for (const auto& light : {rays::testing::directional(), rays::testing::spot({0.5, 0.4, 2}, 50)}) {
            const auto b = testing::build(find("uncompressed", ""), scene, light, rays::testing::rays(32, 16));
            base::Random random(9);
            for (int i = 0; i < 300; ++i) {
                const Query q{static_cast<float>(random.uniform(2, 30)), static_cast<float>(random.uniform(2, 30)),
                              static_cast<float>(random.uniform(b.rays.layout.z_min, b.rays.layout.z_max)),
                              static_cast<float>(random.uniform(1, 3))};
                EXPECT_NEAR(b.lookup(q.x, q.y, q.z, q.width), oracle(b.rays, q), 1e-6) << "media " << media;
            }
        }
    }
}

TEST(Uncompressed, SurfacesCostOneNodeACrossing) {
    const auto b = testing::build(find("uncompressed", ""), testing::hairy_scene(false), rays::testing::directional(),
                                  rays::testing::rays(32, 4));
    std::size_t crossings = 0;
    for (const auto& tile : b.rays.tiles) crossings += tile.segments();
    EXPECT_EQ(b.map->nodes().total, crossings);
}

}  // namespace
}  // namespace shadowbench::techniques
