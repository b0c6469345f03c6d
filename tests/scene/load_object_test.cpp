#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scene/procedural.h"
#include "scene/scenario.h"
#include "scene/support.h"

namespace shadowbench::scene {
namespace {

using nlohmann::json;
using test::bytes_of;
using test::error_of;
using testing::ElementsAre;
using testing::HasSubstr;

Object load(const std::string& object, const SearchPath& path = {}) {
    json document = json::parse(R"({"name": "objects", "techniques": [{"type": "deep"}],
                                    "lights": [{"type": "directional", "direction": [0, -1, 0]}]})");
    document["scene"]["objects"] = {json::parse(object)};
    return load_scenario(document, path).scene.objects[0];
}

base::Error failure(const std::string& object, const SearchPath& path = {}) {
    return error_of([&] { load(object, path); });
}

TEST(LoadObject, ReadsTheKeysThatAllHave) {
    const Object surface =
        load(R"({"type": "sphere", "name": "ball", "centre": [1, 2, 3], "radius": 2, "opacity": [0, 0.5, 1]})");
    EXPECT_EQ(surface.name, "ball");
    EXPECT_EQ(surface.opacity, Vec3f(0, 0.5f, 1));
    const Object medium =
        load(R"({"type": "particles", "centres": [[0, 0, 0]], "radii": [1], "density": [2], "extinction": 3})");
    EXPECT_EQ(medium.name, "particles_0");
    EXPECT_EQ(medium.extinction, Vec3f(3, 3, 3));
}

TEST(LoadObject, ReadsTheMotionOfEveryTypeAndObjectsStandStillWithoutIt) {
    EXPECT_EQ(load(R"({"type": "sphere", "centre": [1, 2, 3], "radius": 2})").motion, Vec3f(0, 0, 0));
    EXPECT_EQ(load(R"({"type": "sphere", "centre": [1, 2, 3], "radius": 2, "motion": [1, -2, 0.5]})").motion,
              Vec3f(1, -2, 0.5f));
    for (const auto& reference : scenario_schema()["definitions"]["object"]["allOf"]) {
        const std::string type = reference["if"]["properties"]["type"]["const"];
        const json& motion = scenario_schema()["definitions"][type]["properties"]["motion"];
        EXPECT_EQ(motion["$ref"], "#/definitions/point") << type;
        EXPECT_EQ(motion["default"], json({0, 0, 0})) << type;
    }
}

TEST(LoadObject, RefusesAMotionThatIsNotAFiniteDisplacement) {
    for (const char* motion : {"[1, 2]", "1", "[1, 2, \"fast\"]", "[0, 0, 1e300]"}) {
        const base::Error error =
            failure(std::string(R"({"type": "sphere", "centre": [1, 2, 3], "radius": 2, "motion": )") + motion + "}");
        EXPECT_EQ(error.code(), base::ErrorCode::bad_input) << motion;
        EXPECT_THAT(error.where(), testing::StartsWith("/scene/objects/0/motion")) << motion;
    }
}

TEST(LoadObject, MakesSpheres) {
    const auto one = std::get<Spheres>(load(R"({"type": "sphere", "centre": [1, 2, 3], "radius": 2})").shape);
    EXPECT_THAT(one.centres, ElementsAre(Vec3f(1, 2, 3)));
    EXPECT_THAT(one.radii, ElementsAre(2.0f));
    const auto two =
        std::get<Spheres>(load(R"({"type": "spheres", "centres": [[1, 2, 3], [4, 5, 6]], "radii": [1, 2]})").shape);
    EXPECT_THAT(two.centres, ElementsAre(Vec3f(1, 2, 3), Vec3f(4, 5, 6)));
    EXPECT_EQ(failure(R"({"type": "spheres", "centres": [[1, 2, 3]], "radii": [1, 2]})").where(),
              "/scene/objects/0/radii");
}

TEST(LoadObject, MakesParticles) {
    const auto shape = std::get<Particles>(
        load(R"({"type": "particles", "centres": [[0, 0, 0], [1, 0, 0]], "radii": [1, 2], "density": [0, 4]})").shape);
    EXPECT_THAT(shape.density, ElementsAre(0.0f, 4.0f));
    EXPECT_EQ(failure(R"({"type": "particles", "centres": [[0, 0, 0]], "radii": [1], "density": [1, 2]})").where(),
              "/scene/objects/0/density");
}

TEST(LoadObject, MakesAQuadOfTwoTriangles) {
    const auto mesh = std::get<Mesh>(
        load(R"({"type": "quad", "corner": [1, 0, 0], "edge_u": [2, 0, 0], "edge_v": [0, 0, 3]})").shape);
    EXPECT_THAT(mesh.positions, ElementsAre(Vec3f(1, 0, 0), Vec3f(3, 0, 0), Vec3f(3, 0, 3), Vec3f(1, 0, 3)));
    EXPECT_EQ(mesh.triangles.size(), 2u);
    EXPECT_EQ(failure(R"({"type": "quad", "corner": [0, 0, 0], "edge_u": [2, 0, 0], "edge_v": [-4, 0, 0]})").where(),
              "/scene/objects/0/edge_v");
    EXPECT_EQ(failure(R"({"type": "quad", "corner": [0, 0, 0], "edge_u": [0, 0, 0], "edge_v": [-4, 0, 0]})").where(),
              "/scene/objects/0/edge_u");
}

Mesh layers(const std::string& rest) {
    return std::get<Mesh>(load(R"({"type": "layers", "edge_u": [2, 0, 0], "edge_v": [0, 0, 3], )" + rest + "}").shape);
}

TEST(LoadObject, MakesLayersOfQuads) {
    const Mesh mesh = layers(R"("corner": [1, 0, 0], "offset": [0, -0.5, 0.25], "count": 3)");
    ASSERT_EQ(mesh.positions.size(), 12u);
    ASSERT_EQ(mesh.triangles.size(), 6u);
    for (int i = 0; i < 3; ++i) {
        const auto moved = std::get<Mesh>(load(fmt::format(R"({{"type": "quad", "corner": [1, {}, {}],
                                                               "edge_u": [2, 0, 0], "edge_v": [0, 0, 3]}})",
                                                           -0.5 * i, 0.25 * i))
                                              .shape);
        for (int k = 0; k < 2; ++k)
            for (int corner = 0; corner < 3; ++corner)
                EXPECT_EQ(mesh.positions[mesh.triangles[2 * i + k][corner]],
                          moved.positions[moved.triangles[k][corner]]);
    }
    EXPECT_EQ(layers(R"("corner": [1, 0, 0], "offset": [0, 0, 0], "count": 5)").positions.size(), 20u);
}

// Summed in float, layers far from the origin would drift or coincide.
TEST(LoadObject, PutsLayersOneUlpApart) {
    const double ulp = std::ldexp(1.0, -13);  // of floats in [1024, 2048)
    const Mesh mesh = layers(fmt::format(R"("corner": [0, 1024.1, 0], "offset": [0, {}, 0], "count": 5000)", ulp));
    ASSERT_EQ(mesh.positions.size(), 20000u);
    float y = 1024.1f;
    for (std::size_t i = 0; i < mesh.positions.size(); i += 4) {
        for (std::size_t k = 0; k < 4; ++k) ASSERT_EQ(mesh.positions[i + k].y, y) << i;
        y = std::nextafter(y, 2048.0f);
    }
    // A third of an ulp apart, positions are those of exact multiples rounded once: three layers fall onto one float.
    const Mesh close = layers(fmt::format(R"("corner": [0, 1024, 0], "offset": [0, {}, 0], "count": 3000)", ulp / 3));
    for (int i = 0; i < 3000; ++i)
        ASSERT_EQ(close.positions[4 * i].y, static_cast<float>(1024.0L + static_cast<long double>(ulp) / 3 * i)) << i;
}

TEST(LoadObject, RefusesLayersThatAreNone) {
    const auto where = [](const std::string& rest) {
        return failure(R"({"type": "layers", "corner": [0, 0, 0], "edge_v": [0, 0, 3], )" + rest + "}").where();
    };
    EXPECT_EQ(where(R"("edge_u": [2, 0, 0], "offset": [0, 1, 0], "count": 0)"), "/scene/objects/0/count");
    EXPECT_EQ(where(R"("edge_u": [2, 0, 0], "offset": [0, 1, 0], "count": 1000001)"), "/scene/objects/0/count");
    EXPECT_EQ(where(R"("edge_u": [2, 0, 0], "offset": [0, 1e17, 0], "count": 100)"), "/scene/objects/0");
    EXPECT_EQ(where(R"("edge_u": [0, 0, 2], "offset": [0, 1, 0], "count": 1)"), "/scene/objects/0/edge_v");
}

TEST(LoadObject, PutsATextureOnAQuad) {
    // A grey TGA image of one texel.
    std::string grey(19, '\0');
    grey[2] = 3;
    grey[12] = grey[14] = 1;
    grey[16] = 8;
    grey[18] = 0x33;
    const auto folder = test::write_file("grey.tga", grey).parent_path();
    const auto mesh =
        std::get<Mesh>(load(R"({"type": "quad", "corner": [0, 0, 0], "edge_u": [2, 0, 0], "edge_v": [0, 0, 3],
                                              "alpha_texture": "grey.tga"})",
                            {folder})
                           .shape);
    ASSERT_TRUE(mesh.alpha);
    EXPECT_NEAR(sample(*mesh.alpha, 0.5f, 0.5f), 0.2f, 1e-6f);
    EXPECT_THAT(mesh.corner_uv,
                ElementsAre(Vec2f(0, 0), Vec2f(1, 0), Vec2f(1, 1), Vec2f(0, 0), Vec2f(1, 1), Vec2f(0, 1)));
}

TEST(LoadMesh, ReadsInlineTriangles) {
    const auto mesh = std::get<Mesh>(load(R"({"type": "mesh", "vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]],
                                              "triangles": [[0, 1, 2]], "scale": 2, "translate": [0, 0, 5]})")
                                         .shape);
    EXPECT_THAT(mesh.positions, ElementsAre(Vec3f(0, 0, 5), Vec3f(2, 0, 5), Vec3f(0, 2, 5)));
    EXPECT_THAT(mesh.triangles, ElementsAre(Vec3i(0, 1, 2)));
}

TEST(LoadMesh, PointsAtWhatDoesNotFit) {
    const auto where = [](const std::string& rest) {
        return failure(R"({"type": "mesh", "vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], )" + rest + "}").where();
    };
    EXPECT_EQ(where(R"("triangles": [[0, 1, 2], [0, 1, 3]])"), "/scene/objects/0/triangles/1/2");
    EXPECT_EQ(where(R"("triangles": [[0, 1, 2]], "uvs": [[0, 0]])"), "/scene/objects/0/uvs");
    EXPECT_EQ(where(R"("triangles": [[0, 1, 2]], "file": "a.obj")"), "/scene/objects/0/vertices");
    EXPECT_EQ(where(R"("triangles": [[0, 1, 2]], "alpha_texture": "a.png")"), "/scene/objects/0/alpha_texture");
    EXPECT_EQ(where(R"("triangles": [[0, 1, 2]], "scale": 1e18, "translate": [1e18, 0, 0])"), "/scene/objects/0");
    EXPECT_THAT(failure(R"({"type": "mesh"})").message(), HasSubstr("a file, or vertices and triangles"));
}

TEST(LoadMesh, RefusesAFileWithoutTriangles) {
    const auto folder = test::write_file("a.obj", "v 0 0 0\n").parent_path();
    const base::Error hollow = failure(R"({"type": "mesh", "file": "a.obj"})", {folder});
    EXPECT_THAT(hollow.message(), HasSubstr((folder / "a.obj").string()));
    EXPECT_THAT(hollow.message(), HasSubstr("a point cloud: 1 vertices and no faces"));
    EXPECT_EQ(hollow.where(), "/scene/objects/0/file") << "where an editor marks it";
    const base::Error missing = failure(R"({"type": "mesh", "file": "b.obj"})", {folder});
    EXPECT_EQ(missing.code(), base::ErrorCode::no_such_file);
    EXPECT_EQ(missing.where(), "/scene/objects/0/file");
}

TEST(LoadObject, HairNeedsAWidth) {
    std::string bytes = bytes_of(3.0f, 1u, 2u);
    bytes.resize(296, '\0');
    bytes += bytes_of(0.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f);
    const auto folder = test::write_file("a.tfx", bytes).parent_path();
    EXPECT_THAT(failure(R"({"type": "hair", "file": "a.tfx"})", {folder}).message(),
                HasSubstr("\"radius\" is missing"));
    EXPECT_EQ(std::get<Hair>(load(R"({"type": "hair", "file": "a.tfx", "radius": 0.5})", {folder}).shape).radii[0],
              0.5f);
    test::write_file("none.tfx", bytes_of(3.0f, 0u, 2u) + std::string(300, '\0'));
    EXPECT_THAT(failure(R"({"type": "hair", "file": "none.tfx", "radius": 1})", {folder}).message(),
                HasSubstr("no strands"));
    test::write_file("points.tfx", bytes_of(3.0f, 1u, 2u) + std::string(400, '\0'));
    EXPECT_THAT(failure(R"({"type": "hair", "file": "points.tfx", "radius": 1})", {folder}).message(),
                HasSubstr("no strands"));
    test::write_file("a.abc", "");
    const base::Error unknown = failure(R"({"type": "hair", "file": "a.abc", "radius": 1})", {folder});
    EXPECT_EQ(unknown.message(), "the name of a hair file must end in .tfx, .hair, .txt or .pbrt; .abc is not read");
    EXPECT_EQ(unknown.where(), "/scene/objects/0/file");
}

TEST(LoadObject, HairOfMitsubaMayBeSplines) {
    const auto folder = test::write_file("s.txt", "-1 1 0 1\n0 0 0 1\n1 1 0 1\n2 4 0 1\n").parent_path();
    const auto first = [&](const char* keys) {
        const Object object = load(fmt::format(R"({{"type": "hair", "file": "s.txt"{}}})", keys), {folder});
        return std::get<Hair>(object.shape).points[0];
    };
    EXPECT_EQ(first(""), Vec3f(-1, 1, 0));
    EXPECT_EQ(first(R"(, "basis": "bspline")").x, 0.0f);
    test::write_file("a.tfx", "");
    EXPECT_EQ(failure(R"({"type": "hair", "file": "a.tfx", "basis": "linear"})", {folder}).where(),
              "/scene/objects/0/basis");
}

TEST(LoadObject, LimitsHair) {
    EXPECT_THAT(failure(R"({"type": "hair_ball", "strands": 100000000, "segments": 2})").message(),
                HasSubstr("limit is 200000000"));
    // Taken for the ball's, the width of hair would make each ray cross a thousand, for hours.
    const base::Error wide = failure(R"({"type": "hair_ball", "radius": 0.5})");
    EXPECT_EQ(wide.where(), "/scene/objects/0/radius");
    EXPECT_THAT(wide.message(), HasSubstr("about 1353 hairs"));
}

TEST(LoadVolume, ReadsRawValuesIntoTheirBox) {
    const auto folder = test::write_file("a.raw", bytes_of(0.0f, 1.0f, 2.0f, 3.0f)).parent_path();
    const std::string raw = R"({"type": "volume", "file": "a.raw", "format": "float32", "size": [4, 1, 1],
                                "lower": [0, 0, 0], "upper": [8, 1, 1])";
    const auto volume = std::get<GridVolume>(load(raw + "}", {folder}).shape);
    EXPECT_EQ(volume.upper, Vec3d(8, 1, 1));
    EXPECT_EQ(volume.step, 0.5);  // half of the smallest voxel edge
    EXPECT_EQ(std::get<GridVolume>(load(raw + R"(, "step": 0.125})", {folder}).shape).step, 0.125);
    EXPECT_EQ(failure(raw + R"(, "step": 1e-8})", {folder}).where(), "/scene/objects/0/step");
    for (const char* grid : {"\"density\"", "0"})
        EXPECT_EQ(failure(raw + ", \"grid\": " + grid + "}", {folder}).where(), "/scene/objects/0/grid");
    EXPECT_TRUE(volume.notes.lines.empty());
}

TEST(LoadVolume, TakesOrRefusesDensitiesBelow0) {
    const auto folder = test::write_file("a.raw", bytes_of(0.0f, -1.0f, 2.0f, 3.0f)).parent_path();
    const std::string raw = R"({"type": "volume", "file": "a.raw", "format": "float32", "size": [4, 1, 1],
                                "lower": [0, 0, 0], "upper": [8, 1, 1])";
    for (const char* more : {"}", R"(, "negative": "clamp"})"})
        EXPECT_EQ(std::get<GridVolume>(load(raw + more, {folder}).shape).notes.lines.size(), 1u);
    EXPECT_THAT(failure(raw + R"(, "negative": "refuse"})", {folder}).message(), HasSubstr("below 0"));
    EXPECT_THAT(failure(raw + R"(, "negative": "keep"})", {folder}).message(), HasSubstr("clamp, refuse"));
}

TEST(LoadVolume, PointsAtWhatIsMissingOrWrong) {
    const auto folder = test::write_file("a.raw", std::string(4, '\0')).parent_path();
    const auto message = [&](const std::string& rest) {
        return failure(R"({"type": "volume", "file": "a.raw", "format": "uint8", "size": [4, 1, 1], )" + rest + "}",
                       {folder});
    };
    EXPECT_THAT(message(R"("lower": [0, 0, 0])").message(), HasSubstr("\"upper\" is missing"));
    EXPECT_EQ(message(R"("lower": [0, 0, 0], "upper": [1, 0, 1])").where(), "/scene/objects/0/upper");
    EXPECT_THAT(message(R"("lower": [0, 0, 0], "upper": [1, 1, 1])").message(), HasSubstr("0 everywhere"));
}

class ProceduralVolume : public testing::TestWithParam<const char*> {
protected:
    static base::Error refusal(const std::string& rest) {
        return failure(std::string(R"({"type": ")") + GetParam() + "\", " + rest + "}");
    }
};

TEST_P(ProceduralVolume, RefusesSizesBoxesAndStepsThatCannotBe) {
    EXPECT_THAT(refusal(R"("size": [2000, 2000, 2000])").message(), HasSubstr("limit is 1000000000"));
    EXPECT_EQ(refusal(R"("size": [2000, 2000, 2000])").where(), "/scene/objects/0/size");
    EXPECT_EQ(refusal(R"("lower": [0, 0, 2])").where(), "/scene/objects/0/upper");
    EXPECT_EQ(refusal(R"("step": 1e-7)").where(), "/scene/objects/0/step");
}

TEST_P(ProceduralVolume, TakesItsSizeBoxAndStep) {
    const std::string text = std::string(R"({"type": ")") + GetParam() +
                             R"(", "size": [8, 9, 10], "lower": [0, 1, 2], "upper": [4, 5, 6], "step": 0.125,
                                 "extinction": 3})";
    const Object object = load(text);
    const auto& volume = std::get<GridVolume>(object.shape);
    EXPECT_EQ(volume.size, base::Vec3i(8, 9, 10));
    EXPECT_EQ(volume.lower, Vec3d(0, 1, 2));
    EXPECT_EQ(volume.upper, Vec3d(4, 5, 6));
    EXPECT_EQ(volume.step, 0.125);
    EXPECT_EQ(object.extinction, Vec3f(3));
}

INSTANTIATE_TEST_SUITE_P(Objects, ProceduralVolume, testing::Values("cloud", "density_box", "crossed_rods"));

TEST(LoadVolume, TakesTheRadiusOfRodsAndRefusesRodsThatReachNoVoxel) {
    const auto filled = [](const std::string& radius) {
        const auto rods = std::get<GridVolume>(load(R"({"type": "crossed_rods", "radius": )" + radius + "}").shape);
        return std::count(rods.density.begin(), rods.density.end(), 1.0f);
    };
    EXPECT_LT(filled("0.1"), filled("0.2"));
    EXPECT_THAT(failure(R"({"type": "crossed_rods", "radius": 0.01})").message(), HasSubstr("0 everywhere"));
}

GridVolume default_volume(const std::string& type) {
    return type == "cloud" ? make_cloud({}) : type == "density_box" ? make_density_box({}) : make_crossed_rods({});
}

// Objects whose every key has the default that the schema documents are equal to those without any key.
class Procedural : public testing::TestWithParam<const char*> {};

TEST_P(Procedural, SchemaDocumentsTheDefaultsOfTheStruct) {
    json written = {{"type", GetParam()}};
    for (const auto& [name, property] : scenario_schema()["definitions"][GetParam()]["properties"].items())
        if (property.contains("default")) written[name] = property["default"];
    json plain = {{"type", GetParam()}};
    const Object a = load(written.dump()), b = load(plain.dump());
    EXPECT_EQ(a.opacity, b.opacity);
    EXPECT_EQ(a.extinction, b.extinction);
    Scene scene_a{{a}, {}}, scene_b{{b}, {}};
    EXPECT_EQ(bounds(scene_a, true), bounds(scene_b, true));
    ASSERT_EQ(a.shape.index(), b.shape.index());
    if (const auto* hair = std::get_if<Hair>(&a.shape)) {
        EXPECT_EQ(hair->points, std::get<Hair>(b.shape).points);
        EXPECT_EQ(hair->points, make_hair_ball(HairBall{}).points);
        EXPECT_EQ(hair->radii, make_hair_ball(HairBall{}).radii);
    } else if (const auto* volume = std::get_if<GridVolume>(&a.shape)) {
        EXPECT_EQ(volume->density, std::get<GridVolume>(b.shape).density);
        EXPECT_EQ(volume->density, default_volume(GetParam()).density);
        EXPECT_EQ(volume->step, default_volume(GetParam()).step);
    } else {
        EXPECT_EQ(std::get<Particles>(a.shape).centres, make_smoke_column(SmokeColumn{}).centres);
        EXPECT_EQ(std::get<Particles>(a.shape).radii, make_smoke_column(SmokeColumn{}).radii);
        EXPECT_EQ(std::get<Particles>(a.shape).density, make_smoke_column(SmokeColumn{}).density);
    }
}

INSTANTIATE_TEST_SUITE_P(Objects, Procedural,
                         testing::Values("hair_ball", "cloud", "density_box", "crossed_rods", "smoke_column"));

TEST(LoadParticles, AreThePointsOfAFile) {
    const std::string head =
        "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n";
    const auto folder = test::write_file("plain.ply", head + "end_header\n1 2 3\n4 5 6\n").parent_path();
    test::write_file("own.ply", head + "property float radius\nend_header\n1 2 3 0.5\n4 5 6 0.25\n");
    const auto load_points = [&](const char* keys) {
        return std::get<Particles>(load(fmt::format(R"({{"type": "particles", {}}})", keys), {folder}).shape);
    };
    EXPECT_EQ(load_points(R"("file": "plain.ply", "radius": 2)").radii, (std::vector<float>{2, 2}));
    EXPECT_EQ(load_points(R"("file": "own.ply")").radii, (std::vector<float>{0.5f, 0.25f}));
    EXPECT_EQ(load_points(R"("file": "own.ply", "radius": 2)").radii, (std::vector<float>{2, 2}));
    const auto refused = [&](const char* keys) {
        return failure(fmt::format(R"({{"type": "particles", {}}})", keys), {folder});
    };
    EXPECT_THAT(refused(R"("file": "plain.ply")").message(), HasSubstr("\"radius\" is missing"));
    EXPECT_EQ(refused(R"("file": "own.ply", "radii": [1])").where(), "/scene/objects/0/radii");
    EXPECT_THAT(refused(R"("centres": [[0, 0, 0]], "radii": [1])").message(), HasSubstr("\"density\" is missing"));
    EXPECT_EQ(refused(R"("centres": [[0, 0, 0]], "radii": [1], "density": [1], "radius": 1)").where(),
              "/scene/objects/0/radius");
}

TEST(LoadObject, NamesAPointCloudAndWhatToDoWithIt) {
    const std::string ply =
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nend_header\n"
        "0 1 0\n1 1 0\n1 1 -1\n0 1 -1\n";
    for (const auto& [name, text] :
         {std::pair<std::string, std::string>{"points.ply", ply}, {"points.obj", "v 0 1 0\nv 1 1 0\n"}}) {
        const auto file = test::write_file(name, text);
        const base::Error error = failure(R"({"type": "mesh", "file": ")" + name + "\"}", {file.parent_path()});
        EXPECT_EQ(error.code(), base::ErrorCode::bad_input);
        EXPECT_EQ(error.where(), "/scene/objects/0/file");
        EXPECT_THAT(error.message(), HasSubstr("a point cloud"));
        EXPECT_THAT(error.message(), HasSubstr("of type particles"));
    }
    const auto file = test::write_file("lines.obj", "v 0 0 0\nv 1 0 0\nl 1 2\nf 1 2\n");
    EXPECT_THAT(failure(R"({"type": "mesh", "file": "lines.obj"})", {file.parent_path()}).message(),
                HasSubstr("no triangles; passed over: lines (1), faces of fewer than 3 corners (1)"));
}

TEST(LoadObject, KeepsTheCountsOfWhatItsFileHeldBesides) {
    const auto file = test::write_file("edge.obj", "v 0 1 0\nv 1 1 0\nv 1 1 -1\nv 0 1 -1\nf 1 2 3 4\nf 1 2\n");
    const Object object = load(R"({"type": "mesh", "file": "edge.obj"})", {file.parent_path()});
    ASSERT_EQ(object.passed_over.size(), 1u);
    EXPECT_EQ(object.passed_over[0].what, "faces of fewer than 3 corners");
    EXPECT_EQ(object.passed_over[0].count, 1u);
    EXPECT_EQ(std::get<Mesh>(object.shape).triangles.size(), 2u);
}

}  // namespace
}  // namespace shadowbench::scene
