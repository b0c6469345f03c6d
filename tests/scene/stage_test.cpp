// Where a ground, a light and a camera go around boxes, and how dense a volume is.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "scene/stage.h"

namespace shadowbench::scene {
namespace {

struct Around {
    Box3d box;
    UpAxis up = UpAxis::y;
};

// A cube, a flat and a tall box, one far from the origin, and tiny and huge ones; with either axis up.
std::vector<Around> boxes() {
    std::vector<Around> all;
    for (const UpAxis up : {UpAxis::y, UpAxis::z})
        for (const Box3d& box :
             {Box3d(Vec3d(0, 0, 0), Vec3d(1, 1, 1)), Box3d(Vec3d(-3, 2, 1), Vec3d(5, 2, 4)),
              Box3d(Vec3d(0, 0, 0), Vec3d(0.1, 40, 0.1)), Box3d(Vec3d(1e6, -7, 5), Vec3d(1e6, -4, 9)),
              Box3d(Vec3d(-1e-9, 0, 0), Vec3d(0, 3e-9, 1e-9)),
              Box3d(Vec3d(-2e12, -1e12, -1e12), Vec3d(1e12, 3e12, 5e11))})
            all.push_back({box, up});
    return all;
}

std::vector<Vec3d> corners_of(const Box3d& box) {
    std::vector<Vec3d> corners;
    for (int i = 0; i < 8; ++i)
        corners.emplace_back(i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y,
                             i & 4 ? box.max.z : box.min.z);
    return corners;
}

Vec3d up_of(const Around& around) {
    return around.up == UpAxis::y ? Vec3d(0, 1, 0) : Vec3d(0, 0, 1);
}

// Where the light through a point meets the ground's plane.
Vec3d shadow_of(const Vec3d& point, const Stage& stage, const Vec3d& up) {
    return point + stage.light * ((stage.ground_corner - point).dot(up) / stage.light.dot(up));
}

bool is_seen(const Vec3d& point, const Camera& camera) {
    const Vec3d forward = (camera.target - camera.position).normalized();
    const Vec3d right = forward.cross(camera.up).normalized(), upwards = right.cross(forward);
    const Vec3d away = point - camera.position;
    const double depth = away.dot(forward), most = depth * std::tan(0.5 * camera.fov * std::numbers::pi / 180.0);
    return depth > 0.0 && std::abs(away.dot(right)) <= picture_aspect * most && std::abs(away.dot(upwards)) <= most;
}

TEST(Stage, TheGroundLiesBelowTheBoxAndHoldsItsShadow) {
    for (const Around& around : boxes()) {
        const Stage stage = stage_around(around.box, around.up);
        const Vec3d up = up_of(around), &u = stage.ground_u, &v = stage.ground_v;
        EXPECT_EQ(u.dot(up), 0.0);
        EXPECT_EQ(v.dot(up), 0.0);
        EXPECT_GT(u.cross(v).dot(up), 0.0);
        EXPECT_LT(stage.light.dot(up), 0.0);
        for (const Vec3d& corner : corners_of(around.box)) {
            EXPECT_GT((corner - stage.ground_corner).dot(up), 0.0);
            const Vec3d shadow = shadow_of(corner, stage, up) - stage.ground_corner;
            for (const Vec3d& edge : {u, v}) {
                EXPECT_GT(shadow.dot(edge), 0.0);
                EXPECT_LT(shadow.dot(edge), edge.dot(edge));
            }
        }
    }
}

TEST(Stage, TheCameraSeesTheBoxAndItsShadow) {
    for (const Around& around : boxes()) {
        const Stage stage = stage_around(around.box, around.up);
        EXPECT_EQ(stage.camera.up, up_of(around));
        for (const Vec3d& corner : corners_of(around.box)) {
            EXPECT_TRUE(is_seen(corner, stage.camera)) << corner;
            EXPECT_TRUE(is_seen(shadow_of(corner, stage, up_of(around)), stage.camera)) << corner;
        }
    }
}

// Not a speck in the middle of the picture: a little closer, something would be cut off.
TEST(Stage, TheBoxAndItsShadowFillThePicture) {
    for (const Around& around : boxes()) {
        const Stage stage = stage_around(around.box, around.up);
        Camera closer = stage.camera;
        closer.fov /= 1.15;
        bool cut = false;
        for (const Vec3d& corner : corners_of(around.box))
            cut = cut || !is_seen(corner, closer) || !is_seen(shadow_of(corner, stage, up_of(around)), closer);
        EXPECT_TRUE(cut);
    }
}

// A cube of side 1 has a diagonal of 1.732: numbers are multiples of 0.001.
TEST(Stage, NumbersAreShort) {
    const Stage stage = stage_around(Box3d(Vec3d(0, 0, 0), Vec3d(1, 1, 1)), UpAxis::y);
    EXPECT_EQ(stage.bias, 0.002);
    EXPECT_EQ(stage.ground_corner.y, -0.035);  // 0.02 * 1.732 below
    for (const double number : {stage.camera.position.x, stage.camera.target.z, stage.ground_u.z})
        EXPECT_EQ(number, std::round(number * 1000.0) / 1000.0);
}

TEST(Stage, ToDigitsKeepsThoseThatLead) {
    EXPECT_EQ(to_digits(0.012345, 2), 0.012);
    EXPECT_EQ(to_digits(-987654.0, 2), -990000.0);
    EXPECT_EQ(to_digits(8.0, 1), 8.0);
    EXPECT_EQ(to_digits(0.0, 3), 0.0);
}

// The largest sums are 6 along x, 5 along y and 4 along z.
TEST(Stage, TheDensestColumnCountsEdgesAndAllAxes) {
    GridVolume volume;
    volume.size = Vec3i(2, 2, 2);
    volume.density = {1, 0, 0.5f, 0, 2, 4, 0, 1};
    volume.lower = Vec3d(1, 1, 1);
    volume.upper = Vec3d(3, 3, 3);
    EXPECT_DOUBLE_EQ(densest_column(volume), 4.0);  // along z at x = 1, y = 0
    volume.upper = Vec3d(3, 3, 201);
    EXPECT_DOUBLE_EQ(densest_column(volume), 5.0);  // along y at x = 1, z = 1
    volume.upper = Vec3d(3, 21, 201);
    EXPECT_DOUBLE_EQ(densest_column(volume), 6.0);  // along x at y = 0, z = 1
    volume.upper = Vec3d(3, 3, 3);
    volume.density.assign(8, 0.0f);
    EXPECT_EQ(densest_column(volume), 0.0);
}

}  // namespace
}  // namespace shadowbench::scene
