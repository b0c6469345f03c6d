// Transforms of objects, against places worked out by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scene/scenario.h"
#include "scene/support.h"

namespace shadowbench::scene {
namespace {

using nlohmann::json;
using test::error_of;
using testing::ElementsAre;
using testing::HasSubstr;

Object load(const std::string& object, const std::string& keys) {
    json document = json::parse(R"({"name": "placed", "techniques": [{"type": "deep"}],
                                    "lights": [{"type": "directional", "direction": [0, -1, 0]}]})");
    document["scene"]["objects"] = {json::parse("{" + object + (keys.empty() ? "" : ", " + keys) + "}")};
    return load_scenario(document, {}).scene.objects[0];
}

const std::string triangle =
    R"("type": "mesh", "vertices": [[1, 0, 0], [0, 2, 0], [0, 0, 3]], "triangles": [[0, 1, 2]])";
const std::string ball = R"("type": "sphere", "centre": [1, 2, 3], "radius": 2)";

std::vector<Vec3f> corners(const std::string& keys) {
    return std::get<Mesh>(load(triangle, keys).shape).positions;
}

base::Error failure(const std::string& object, const std::string& keys) {
    return error_of([&] { load(object, keys); });
}

// Each alone, with signs and directions that a wrong convention would swap.
TEST(Transform, MovesPointsAsItsKeysSay) {
    EXPECT_THAT(corners(R"("up": "y")"), ElementsAre(Vec3f(1, 0, 0), Vec3f(0, 2, 0), Vec3f(0, 0, 3)));
    EXPECT_THAT(corners(R"("up": "z")"), ElementsAre(Vec3f(1, 0, 0), Vec3f(0, 0, -2), Vec3f(0, 3, 0)));
    EXPECT_THAT(corners(R"("scale": 2)"), ElementsAre(Vec3f(2, 0, 0), Vec3f(0, 4, 0), Vec3f(0, 0, 6)));
    EXPECT_THAT(corners(R"("scale": [2, -1, 0.5])"), ElementsAre(Vec3f(2, 0, 0), Vec3f(0, -2, 0), Vec3f(0, 0, 1.5f)));
    EXPECT_THAT(corners(R"("rotate": [90, 0, 0])"), ElementsAre(Vec3f(1, 0, 0), Vec3f(0, 0, 2), Vec3f(0, -3, 0)));
    EXPECT_THAT(corners(R"("rotate": [0, 90, 0])"), ElementsAre(Vec3f(0, 0, -1), Vec3f(0, 2, 0), Vec3f(3, 0, 0)));
    EXPECT_THAT(corners(R"("rotate": [0, 0, 90])"), ElementsAre(Vec3f(0, 1, 0), Vec3f(-2, 0, 0), Vec3f(0, 0, 3)));
    EXPECT_THAT(corners(R"("translate": [1, 2, 3])"), ElementsAre(Vec3f(2, 2, 3), Vec3f(1, 4, 3), Vec3f(1, 2, 6)));
    EXPECT_THAT(corners(R"("matrix": [[1, 2, 3, 4], [0, 1, 5, 6], [0, 0, 1, 7]])"),
                ElementsAre(Vec3f(5, 6, 7), Vec3f(8, 8, 7), Vec3f(13, 21, 10)));
}

// Any other order gives other numbers.
TEST(Transform, AppliesUpThenScaleThenRotationsAboutXYZThenTranslate) {
    // (0, 2, 0) -> up (0, 0, -2) -> scale (0, 0, -10) -> about x (0, 10, 0) -> about z (-10, 0, 0) -> (-9, 0, 0)
    EXPECT_EQ(corners(R"("up": "z", "scale": [3, 4, 5], "rotate": [90, 0, 90], "translate": [1, 0, 0])")[1],
              Vec3f(-9, 0, 0));
    EXPECT_EQ(corners(R"("up": "z", "matrix": [[0, 0, 1, 0], [1, 0, 0, 0], [0, 1, 0, 8]])")[1], Vec3f(-2, 0, 8))
        << "the matrix comes after up";
    const Vec3f turned = corners(R"("rotate": [0, 0, 30])")[0];
    EXPECT_FLOAT_EQ(turned.x, static_cast<float>(std::sqrt(0.75)));
    EXPECT_FLOAT_EQ(turned.y, 0.5f);
}

TEST(Transform, TakesEveryTypeOfObjectWithItsRadii) {
    const std::string keys = R"("scale": 2, "rotate": [0, 0, 90], "translate": [0, 0, 1])";
    const auto sphere = std::get<Spheres>(load(ball, keys).shape);
    EXPECT_EQ(sphere.centres[0], Vec3f(-4, 2, 7));
    EXPECT_EQ(sphere.radii[0], 4.0f);
    const auto puffs = std::get<Particles>(
        load(R"("type": "particles", "centres": [[1, 2, 3]], "radii": [0.5], "density": [3])", keys).shape);
    EXPECT_EQ(puffs.centres[0], Vec3f(-4, 2, 7));
    EXPECT_EQ(puffs.radii[0], 1.0f);
    EXPECT_EQ(puffs.density[0], 3.0f);
    const std::string quad = R"("type": "quad", "corner": [1, 2, 3], "edge_u": [1, 0, 0], "edge_v": [0, 1, 0])";
    EXPECT_EQ(std::get<Mesh>(load(quad, keys).shape).positions[2], Vec3f(-6, 4, 7));
    const std::string hair = R"("type": "hair_ball", "strands": 3, "segments": 2)";
    const auto before = std::get<Hair>(load(hair, "").shape), after = std::get<Hair>(load(hair, keys).shape);
    ASSERT_EQ(after.points.size(), before.points.size());
    for (std::size_t i = 0; i < after.points.size(); ++i) {
        EXPECT_EQ(after.points[i], Vec3f(-2 * before.points[i].y, 2 * before.points[i].x, 2 * before.points[i].z + 1));
        EXPECT_EQ(after.radii[i], 2 * before.radii[i]);
    }
    for (const auto& reference : scenario_schema()["definitions"]["object"]["allOf"]) {
        const std::string type = reference["if"]["properties"]["type"]["const"];
        for (const char* key : {"up", "scale", "rotate", "translate", "matrix"})
            EXPECT_TRUE(scenario_schema()["definitions"][type]["properties"].contains(key)) << type << key;
    }
}

// A shear keeps volumes, and [1, 2, 4] doubles every length in the mean; a sphere would no longer be one.
TEST(Transform, GivesRadiiTheUniformPartAndRefusesEllipsoids) {
    const std::string shear = R"("matrix": [[1, 3, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]])",
                      stretch = R"("scale": [1, 2, 4])";
    const std::string puff = R"("type": "particles", "centres": [[1, 1, 1]], "radii": [0.5], "density": [3])";
    const auto sheared = std::get<Particles>(load(puff, shear).shape);
    EXPECT_EQ(sheared.centres[0], Vec3f(4, 1, 1));
    EXPECT_FLOAT_EQ(sheared.radii[0], 0.5f);
    EXPECT_FLOAT_EQ(std::get<Particles>(load(puff, stretch).shape).radii[0], 1.0f);
    const std::string hair = R"("type": "hair_ball", "strands": 1, "segments": 1)";
    EXPECT_FLOAT_EQ(std::get<Hair>(load(hair, stretch).shape).radii[0],
                    2.0f * std::get<Hair>(load(hair, "").shape).radii[0]);
    for (const std::string& keys : {shear, stretch}) {
        EXPECT_EQ(failure(ball, keys).where(), "/scene/objects/0");
        EXPECT_THAT(failure(ball, keys).message(), HasSubstr("ellipsoids"));
    }
    EXPECT_EQ(std::get<Spheres>(load(ball, R"("scale": [-2, 2, 2])").shape).radii[0], 4.0f) << "a mirror keeps spheres";
}

TEST(Transform, PlacesVolumesInTheirBoxOrWithAFrame) {
    const std::string box = R"("type": "density_box", "size": [2, 4, 8], "lower": [0, 0, 0], "upper": [2, 4, 8])";
    const auto moved = std::get<GridVolume>(load(box, R"("scale": [1, 2, 3], "translate": [1, 1, 1])").shape);
    EXPECT_FALSE(moved.frame) << "rays would pay for a turn that is none";
    EXPECT_EQ(moved.lower, Vec3d(1, 1, 1));
    EXPECT_EQ(moved.upper, Vec3d(3, 9, 25));
    EXPECT_EQ(moved.step, 0.5) << "half the smallest voxel edge";
    const Object turned = load(box, R"("rotate": [0, 0, 90], "scale": 2)");
    const auto& volume = std::get<GridVolume>(turned.shape);
    ASSERT_TRUE(volume.frame);
    EXPECT_EQ(world_box(volume).min, Vec3d(-8, 0, 0));
    EXPECT_EQ(world_box(volume).max, Vec3d(0, 4, 16));
    EXPECT_EQ(volume.step, 1.0);
    EXPECT_DOUBLE_EQ(longest_way(volume), 2 * std::sqrt(4 + 16 + 64.0));
    // x' = x + y: the layers of constant x move together, from 1 to 1 / sqrt(2) apart; the longest way is the diagonal
    // from (0, 0, 0) to (6, 4, 8).
    const auto sheared =
        std::get<GridVolume>(load(box, R"("matrix": [[1, 1, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]])").shape);
    EXPECT_DOUBLE_EQ(sheared.step, 0.5 / std::sqrt(2.0));
    EXPECT_DOUBLE_EQ(longest_way(sheared), std::sqrt(36 + 16 + 64.0));
}

TEST(Transform, RefusesWhatContradictsFlattensOrLeavesTheWorld) {
    const std::string unit = R"("matrix": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]])";
    for (const char* key : {"scale", "rotate", "translate"}) {
        const base::Error error = failure(triangle, fmt::format(R"({}, "{}": [1, 1, 1])", unit, key));
        EXPECT_EQ(error.where(), fmt::format("/scene/objects/0/{}", key));
        EXPECT_THAT(error.message(), HasSubstr("remove one"));
    }
    const auto where = [](const std::string& keys) { return failure(triangle, keys).where(); };
    EXPECT_EQ(where(R"("scale": 0)"), "/scene/objects/0/scale");
    EXPECT_EQ(where(R"("scale": -1)"), "/scene/objects/0/scale");
    EXPECT_EQ(where(R"("scale": [1, 0, 1])"), "/scene/objects/0/scale/1");
    EXPECT_EQ(where(R"("rotate": [1, 2])"), "/scene/objects/0/rotate");
    EXPECT_EQ(where(R"("up": "x")"), "/scene/objects/0/up");
    EXPECT_EQ(where(R"("matrix": [[1, 0, 0, 0], [0, 1, 0, 0]])"), "/scene/objects/0/matrix");
    EXPECT_EQ(where(R"("matrix": [[1, 0, 0, 0], [0, 0, 0, 0], [0, 0, 1, 0]])"), "/scene/objects/0/matrix");
    EXPECT_THAT(failure(triangle, R"("matrix": [[1, 1, 2, 0], [1, 1, 5, 0], [1, 1, 7, 0]])").message(),
                HasSubstr("one plane"));
    EXPECT_EQ(where(R"("scale": 1e18, "translate": [1e18, 0, 0])"), "/scene/objects/0");
    EXPECT_THAT(failure(ball, R"("scale": 1e18)").message(), HasSubstr("beyond"));
    EXPECT_THAT(failure(R"("type": "sphere", "centre": [0, 0, 0], "radius": 1e-10)", R"("scale": 1e-10)").message(),
                HasSubstr("a radius"));
    EXPECT_THAT(
        failure(R"("type": "cloud", "size": [2, 2, 2])", R"("translate": [1e18, 0, 0], "scale": 1e17)").message(),
        HasSubstr("the volume runs"));
    EXPECT_THAT(failure(R"("type": "hair_ball", "strands": 2)", R"("translate": [1e17, 1e17, 1e17])").message(),
                HasSubstr("no strands that have a length"));
}

}  // namespace
}  // namespace shadowbench::scene
