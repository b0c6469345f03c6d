// Grids that are turned, mirrored and sheared in the world, against closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/random.h"
#include "rays/grid_media.h"
#include "rays/scenes.h"

namespace shadowbench::rays {
namespace {

using base::Matrix4d;
using base::Vec3d;

Matrix4d rows(const Vec3d& x, const Vec3d& y, const Vec3d& z, const Vec3d& origin) {
    return {x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, origin.x, origin.y, origin.z, 1};
}

const std::vector<Matrix4d>& maps() {
    static const std::vector<Matrix4d> list{
        rows({2, 0, 0}, {0, 0.5, 0}, {0, 0, 3}, {1, -2, 0.5}),               // along the axes
        rows({0, 1, 0}, {0, 0, 1}, {1, 0, 0}, {0, 0, 0}),                    // axes swapped
        rows({-1, 0, 0}, {0, 1, 0}, {0, 0, -1}, {3, 0, 1}),                  // mirrored
        rows({0.6, 0.8, 0}, {-0.8, 0.6, 0}, {0, 0, 1}, {0.1, 0.2, 0.3}),     // turned
        rows({1, 0.5, 0.25}, {0, 1, -0.75}, {0.5, 0, 1.5}, {-1, 0.5, 0.25})  // sheared
    };
    return list;
}

scene::GridVolume unit_cube(float density) {
    scene::GridVolume grid;
    grid.size = {3, 4, 5};
    grid.density.assign(60, density);
    grid.lower = {0, 0, 0};
    grid.upper = {1, 1, 1};
    grid.step = 0.01;
    return grid;
}

// The length of a ray of unit length inside the image of the unit cube, whose faces are planes in the world.
double chord(const Matrix4d& map, const Vec3d& origin, const Vec3d& direction) {
    const Vec3d corner(map[3][0], map[3][1], map[3][2]);
    double front = -1e30, back = 1e30;
    for (int axis = 0; axis < 3; ++axis) {
        const auto edge = [&](int i) { return Vec3d(map[i % 3][0], map[i % 3][1], map[i % 3][2]); };
        const Vec3d normal = edge(axis + 1).cross(edge(axis + 2));
        const double along = normal.dot(direction), to_first = normal.dot(corner - origin),
                     to_second = to_first + normal.dot(edge(axis));
        front = std::max(front, std::min(to_first / along, to_second / along));
        back = std::min(back, std::max(to_first / along, to_second / along));
    }
    return std::max(0.0, back - front);
}

struct Ray {
    Vec3d origin, direction;
};
Ray random_ray(base::Random& random, const scene::GridVolume& volume) {
    const base::Box3d box = scene::world_box(volume);
    const auto inside = [&] {
        Vec3d p;
        for (int a = 0; a < 3; ++a) p[a] = random.uniform(box.min[a], box.max[a]);
        return p;
    };
    const Vec3d through = inside(), direction = (inside() - through).normalized();
    return {through - direction * 20.0, direction};
}

double sum(const std::vector<MediumSegment>& segments) {
    double depth = 0.0;
    for (const MediumSegment& s : segments) depth += s.depth;
    return depth;
}

TEST(PlacedVolume, AConstantBoxHasTheDepthOfItsChordThroughEveryMap) {
    for (std::size_t m = 0; m < maps().size(); ++m) {
        scene::GridVolume volume = unit_cube(2.0f);
        scene::place(volume, maps()[m]);
        EXPECT_EQ(volume.frame.has_value(), m > 0);
        const VolumeMarcher marcher(volume);
        base::Random random(m + 1);
        int hits = 0;
        for (int i = 0; i < 200; ++i) {
            const Ray ray = random_ray(random, volume);
            const double length = chord(maps()[m], ray.origin, ray.direction), half = 0.5;
            // A direction of any length: `scale` is world length per unit of t.
            const Vec3d direction = ray.direction * half;
            std::vector<MediumSegment> steps, cells;
            marcher.march(ray.origin, direction, half, 0.0, 1e30, steps);
            marcher.march_cells(ray.origin, direction, half, 0.0, 1e30, cells);
            std::vector<double> exact(1);
            marcher.optical_depths(ray.origin, direction, half, 0.0, std::vector<double>{200.0}, exact);
            hits += length > 0.0;
            EXPECT_NEAR(exact[0], 2.0 * length, 1e-12) << m;
            EXPECT_NEAR(sum(cells), 2.0 * length, 1e-12) << m;
            EXPECT_NEAR(sum(steps), 2.0 * length, 1e-12) << m;
        }
        EXPECT_GT(hits, 50);
    }
}

// Swapped and mirrored axes: the same field as a grid whose voxels were moved one by one.
TEST(PlacedVolume, SwappedAndMirroredAxesEqualAGridWithMovedVoxels) {
    scene::GridVolume volume = unit_cube(0.0f), moved = unit_cube(0.0f);
    base::Random random(9);
    for (float& density : volume.density) density = static_cast<float>(random.uniform());
    moved.size = {4, 5, 3};  // (x, y, z) -> (y, 1 - z, x)
    for (int z = 0; z < 5; ++z)
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 3; ++x)
                moved.density[static_cast<std::size_t>((x * 5 + 4 - z) * 4 + y)] =
                    volume.density[static_cast<std::size_t>((z * 4 + y) * 3 + x)];
    scene::place(volume, rows({0, 0, 1}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}));
    ASSERT_TRUE(volume.frame);
    const VolumeMarcher placed(volume), baked(moved);
    for (int i = 0; i < 200; ++i) {
        const Ray ray = random_ray(random, moved);
        const std::vector<double> t{19.6, 20.0, 20.3, 30.0};
        std::vector<double> a(4), b(4);
        placed.optical_depths(ray.origin, ray.direction, 1.0, 0.0, t, a);
        baked.optical_depths(ray.origin, ray.direction, 1.0, 0.0, t, b);
        for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(a[k], b[k], 1e-13);
    }
}

// A reader may turn a grid before the scenario places it; two turns may also cancel out.
TEST(PlacedVolume, IsPlacedAgainFromWhereItStands) {
    const Matrix4d& swap = maps()[1];
    const Matrix4d& shear = maps()[4];
    scene::GridVolume volume = unit_cube(2.0f), once = volume;
    scene::place(volume, swap);
    scene::place(volume, shear);
    scene::place(once, swap * shear);
    ASSERT_TRUE(volume.frame);
    EXPECT_TRUE(volume.frame->to_world.equalWithAbsError(once.frame->to_world, 1e-15));
    EXPECT_TRUE(volume.frame->to_grid.equalWithAbsError(once.frame->to_grid, 1e-15));
    scene::GridVolume back = unit_cube(2.0f);
    scene::place(back, maps()[2]);
    scene::place(back, maps()[2].inverse() * maps()[0]);
    EXPECT_FALSE(back.frame);
    EXPECT_EQ(back.lower, Vec3d(1, -2, 0.5));
    EXPECT_EQ(back.upper, Vec3d(3, -1.5, 3.5));
}

// A turned slab that moves is at each time where the motion, in the world, has brought it.
TEST(PlacedVolume, MovesInTheWorld) {
    scene::Object object;
    scene::GridVolume volume = unit_cube(3.0f);
    scene::place(volume, rows({0.6, 0.8, 0}, {-0.8, 0.6, 0}, {0, 0, 1}, {0, 0, 0}));
    object.shape = volume;
    object.motion = base::Vec3f(0.25f, 0.0f, 0.0f);
    scene::Scene scene;
    scene.objects.push_back(object);
    const GridMedia media(scene, true);
    const LightView view = make_light_view(testing::directional(8.0), scene, {64, 64}, "/lights/0");
    for (const double time : {0.0, 0.5, 1.0})
        for (double x = 20.0; x < 50.0; x += 0.7) {
            const LightLine line = light_line(view, x, 37.3);
            const double z[] = {100.0};
            Vec3d depth;
            media.optical_depths(view, x, 37.3, time, z, {&depth, 1});
            const Vec3d origin = line.origin - Vec3d(0.25, 0, 0) * time;
            EXPECT_NEAR(depth.x, 3.0 * chord(volume.frame->to_world, origin, line.direction), 1e-12);
        }
}

// Captured rays, in steps and in cells, and the world box that the map is fitted to.
TEST(PlacedVolume, IsCapturedWhereItStands) {
    scene::Object object;
    scene::GridVolume volume = unit_cube(1.5f);
    const Matrix4d& map = maps().back();
    scene::place(volume, map);
    object.shape = volume;
    scene::Scene scene;
    scene.objects.push_back(object);
    for (const scene::Media media : {scene::Media::steps, scene::Media::cells}) {
        scene::RaySettings settings = testing::rays(16, 4);
        settings.media = media;
        scene::Light light = testing::directional();
        light.extent.reset();
        light.target = scene::world_box(volume).center();
        const testing::Captured c = testing::capture(scene, light, settings);
        int hits = 0;
        testing::for_each_ray(c, [&](const LightRays& tile, std::size_t ray, int i, int j) {
            const SamplePosition at = sample_position(c.layout, i, j);
            const LightLine line = light_line(c.view, at.x, at.y);
            const double length = chord(map, line.origin, line.direction);
            hits += length > 0.0;
            EXPECT_NEAR(transmittance(tile, ray, 0, 1e6), std::exp(-1.5 * length), 1e-6);
        });
        EXPECT_GT(hits, 200);
    }
}

}  // namespace
}  // namespace shadowbench::rays
