// pbrt scenes, against values written by hand and closed forms.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "scene/packed_volume.h"
#include "scene/readers/pbrt_files.h"
#include "scene/support.h"

namespace shadowbench::scene {
namespace {

namespace fs = std::filesystem;
using test::error_of;
using testing::ElementsAre;
using testing::HasSubstr;

PbrtFile read(const std::string& text, const PbrtLimits& limits = {}) {
    return read_pbrt(test::write_file("scene.pbrt", text), limits);
}

std::string refused(const std::string& text, const PbrtLimits& limits = {}) {
    const base::Error error = error_of([&] { read(text, limits); });
    EXPECT_EQ(error.code(), base::ErrorCode::bad_input);
    EXPECT_THAT(error.where(), HasSubstr("scene.pbrt:"));
    return error.message();
}

// "what (count), ..." of all that is passed over.
std::string passed(const PbrtFile& file) {
    std::string text;
    for (const PassedOver& each : file.passed_over) text += fmt::format("{} ({}); ", each.what, each.count);
    return text;
}

const std::string triangle = "Shape \"trianglemesh\" \"point3 P\" [1 0 0  0 2 0  0 0 3] \"integer indices\" [0 1 2]\n";

// The vertices of the triangle after these statements.
std::vector<Vec3f> placed(const std::string& statements) {
    return read(statements + triangle).mesh.positions;
}

TEST(ReadPbrt, TheSampleHasOneOfEachKind) {
    const PbrtFile file = read_pbrt(fs::path(SHADOWBENCH_SOURCE_DIR) / "tests/cases/scene.pbrt");
    EXPECT_EQ(file.mesh.triangles.size(), 2u);
    EXPECT_EQ(file.mesh.positions[5], Vec3f(0, 1, 4));
    // Two curves that join; both are straight, so each is one segment.
    EXPECT_THAT(file.hair.strand_begin, ElementsAre(0u, 3u));
    EXPECT_THAT(file.hair.radii, ElementsAre(0.25f, 0.25f, 0.125f));
    EXPECT_EQ(file.hair.points[2], Vec3f(0, 6, 0));
    EXPECT_THAT(file.particles.centres, ElementsAre(Vec3f(5, 0, 0)));
    EXPECT_THAT(file.particles.radii, ElementsAre(3.0f));
    EXPECT_THAT(file.particles.density, ElementsAre(0.25f));
    ASSERT_EQ(file.media.size(), 1u);
    EXPECT_EQ(file.media[0].name, "smoke");
    const GridVolume& smoke = file.media[0].volume;
    EXPECT_EQ(smoke.size, Vec3i(1, 2, 3));
    EXPECT_EQ(smoke.lower, Vec3d(0, 0, 0));
    EXPECT_EQ(smoke.upper, Vec3d(1, 2, 3));
    // The mean of (sigma_a + sigma_s) * scale is 2.
    EXPECT_THAT(smoke.density, ElementsAre(2.0f, 4.0f, 6.0f, 8.0f, 10.0f, 12.0f));
    ASSERT_EQ(file.facts.size(), 1u);
    EXPECT_THAT(file.facts[0], HasSubstr("medium \"smoke\": extinction [1.5, 2, 2.5]"));
    EXPECT_EQ(passed(file), "shapes of the type disk (1); ");
}

// Each against the vertices that the transform gives by hand.
TEST(ReadPbrt, TransformsApplyTheLastOneFirst) {
    EXPECT_EQ(placed("Translate 1 2 3\n")[0], Vec3f(2, 2, 3));
    EXPECT_EQ(placed("Translate 1 2 3 Scale 2 3 4\n")[2], Vec3f(1, 2, 15));
    EXPECT_EQ(placed("Scale 2 3 4 Translate 1 2 3\n")[2], Vec3f(2, 6, 24));
    EXPECT_EQ(placed("Rotate 90 0 0 1\n")[0], Vec3f(0, 1, 0)) << "counter-clockwise";
    EXPECT_EQ(placed("Rotate 90 1 0 0\n")[1], Vec3f(0, 0, 2));
    EXPECT_EQ(placed("Rotate -90 0 2 0\n")[2], Vec3f(-3, 0, 0));
    const std::string rows = "[1 0 0 0  0 0 1 0  0 -1 0 0  7 8 9 1]";
    EXPECT_EQ(placed("Translate 9 9 9 Transform " + rows + "\n")[1], Vec3f(7, 8, 11));
    EXPECT_EQ(placed("Scale 2 2 2 ConcatTransform " + rows + "\n")[1], Vec3f(14, 16, 22));
    EXPECT_EQ(placed("Scale 2 2 2 Identity\n")[0], Vec3f(1, 0, 0));
    // From (0, 0, 5), down the z axis with y up, x points to the left.
    EXPECT_EQ(placed("LookAt 0 0 5  0 0 0  0 1 0\n")[0], Vec3f(-1, 0, 5));
    EXPECT_EQ(placed("LookAt 0 0 5  0 0 0  0 1 0 Camera \"perspective\" WorldBegin\n")[0], Vec3f(1, 0, 0));
    EXPECT_EQ(placed("Translate 0 0 5 Camera \"perspective\" WorldBegin CoordSysTransform \"camera\"\n")[0],
              Vec3f(1, 0, -5));
    EXPECT_EQ(placed("Scale 2 2 2 CoordinateSystem \"s\" Identity CoordSysTransform \"s\"\n")[0], Vec3f(2, 0, 0));
}

TEST(ReadPbrt, SavedTransformsComeBack) {
    EXPECT_EQ(placed("AttributeBegin Translate 1 0 0 AttributeEnd\n")[0], Vec3f(1, 0, 0));
    EXPECT_EQ(placed("TransformBegin Material \"interface\" Translate 1 0 0 TransformEnd\n").size(), 0u)
        << "a transform is saved without the material";
    EXPECT_EQ(placed("AttributeBegin Material \"interface\" AttributeEnd\n").size(), 3u);
    EXPECT_THAT(refused("AttributeBegin TransformEnd\n"), HasSubstr("TransformEnd ends no TransformBegin"));
    EXPECT_THAT(refused("AttributeEnd\n"), HasSubstr("AttributeEnd ends no AttributeBegin"));
    const PbrtFile moving = read("ActiveTransform EndTime Translate 9 0 0 ActiveTransform All\n" + triangle);
    EXPECT_EQ(moving.mesh.positions[0], Vec3f(1, 0, 0));
    EXPECT_EQ(passed(moving), "transforms when the shutter closes (1); ");
}

// Half a circle, nearly: the curve's own points, and its width under a scale.
TEST(ReadPbrt, CurvesKeepTheirShapeAndWidth) {
    const PbrtFile file = read(
        "Scale 2 2 2\nShape \"curve\" \"point P\" [0 0 0  0 1 0  1 1 0  1 0 0] \"float width0\" 0.2 \"float width1\" "
        "0.1\n");
    EXPECT_GT(file.hair.points.size(), 4u);
    EXPECT_FLOAT_EQ(file.hair.radii.front(), 0.2f);
    EXPECT_FLOAT_EQ(file.hair.radii.back(), 0.1f);
    for (std::size_t i = 0; i < file.hair.points.size(); ++i) {
        const double u = (0.2 - static_cast<double>(file.hair.radii[i])) / 0.1;  // the width falls evenly
        EXPECT_NEAR(file.hair.points[i].x, 2.0 * (3 * u * u * (1 - u) + u * u * u), 1e-5);
        EXPECT_NEAR(file.hair.points[i].y, 2.0 * 3 * u * (1 - u), 1e-5);
    }
}

TEST(ReadPbrt, CurvesMayBeQuadraticAndSplines) {
    const auto curve = [](const std::string& keys) {
        return read("Shape \"curve\" \"float width\" 0.01 " + keys).hair;
    };
    const auto parabola = [](const Hair& hair) {
        ASSERT_GT(hair.points.size(), 4u);
        for (const Vec3f& point : hair.points) EXPECT_NEAR(point.y, point.x * point.x, 1e-6f);
    };
    parabola(curve("\"integer degree\" 2 \"point3 P\" [0 0 0  0.5 0 0  1 1 0]"));
    // The control points of x^2 as a quadratic B-spline lie at x^2 - 1/4, here over two pieces.
    const Hair quadratic = curve(
        "\"integer degree\" 2 \"string basis\" \"bspline\" "
        "\"point3 P\" [-0.5 0 0  0.5 0 0  1.5 2 0  2.5 6 0]");
    parabola(quadratic);
    EXPECT_FLOAT_EQ(quadratic.points.front().x, 0.0f);
    EXPECT_FLOAT_EQ(quadratic.points.back().x, 2.0f);
    EXPECT_THAT(refused("Shape \"curve\" \"point3 P\" [0 0 0 1 1 1]"), HasSubstr("2 points; a curve of degree 3"));
    EXPECT_THAT(refused("Shape \"curve\" \"point3 P\" [0 0 0 1 1 1 2 2 2 3 3 3 4 4 4]"), HasSubstr("multiple of 3"));
    EXPECT_THAT(refused("Shape \"curve\" \"float width\" -1 \"point3 P\" [0 0 0 1 1 1 2 2 2 3 3 3]"),
                HasSubstr("a width of -1"));
}

TEST(ReadPbrt, CurvesThatDoNotJoinAreStrandsOfTheirOwn) {
    const std::string first = "Shape \"curve\" \"point3 P\" [0 0 0  0 1 0  0 2 0  0 3 0]\n";
    EXPECT_EQ(read(first + "Shape \"curve\" \"point3 P\" [0 3 0  0 4 0  0 5 0  0 6 0]\n").hair.strand_begin.size(), 2u);
    EXPECT_EQ(read(first + first).hair.strand_begin.size(), 3u);
    const std::string object = "ObjectBegin \"o\"\n" + first + "ObjectEnd\nScale 2 2 2\nObjectInstance \"o\"\n";
    const Hair hair = read(object + "Translate 1 0 0 ObjectInstance \"o\"").hair;
    EXPECT_THAT(hair.strand_begin, ElementsAre(0u, 2u, 4u));
    EXPECT_EQ(hair.points[3], Vec3f(2, 6, 0));
    EXPECT_FLOAT_EQ(hair.radii[3], 1.0f);
}

std::string grid(const std::string& place, const std::string& values = "\"float density\" [1 2 3 4 5 6]") {
    return place + " MakeNamedMedium \"m\" \"string type\" \"uniformgrid\" \"integer nx\" 1 \"integer ny\" 2 " +
           "\"integer nz\" 3 " + values + " MediumInterface \"m\" \"\" Material \"\" Shape \"sphere\"\n";
}

TEST(ReadPbrt, GridsKeepTheirValuesThroughTransforms) {
    const PbrtFile turned = read(grid("Translate 5 0 0 Rotate 90 0 0 1 Scale 4 2 3"));
    ASSERT_EQ(turned.media.size(), 1u);
    const GridVolume& volume = turned.media[0].volume;
    // y of the grid runs along -x of the world, from 5 to 3.
    EXPECT_EQ(volume.size, Vec3i(2, 1, 3));
    EXPECT_EQ(volume.lower, Vec3d(3, 0, 0));
    EXPECT_EQ(volume.upper, Vec3d(5, 4, 3));
    EXPECT_THAT(volume.density, ElementsAre(4.0f, 2.0f, 8.0f, 6.0f, 12.0f, 10.0f));
    EXPECT_EQ(passed(read(grid("Rotate 30 0 0 1"))), "grids of media that are turned by other than right angles (1); ");
    const GridVolume clamped = read(grid("", "\"float density\" [1 -2 3 4 5 6]")).media.at(0).volume;
    EXPECT_EQ(clamped.density[1], 0.0f);
    EXPECT_THAT(clamped.notes.lines.at(0), HasSubstr("1 of 6 densities are below 0"));
    EXPECT_THAT(refused(grid("", "\"float density\" [1 2]")), HasSubstr("2 values of \"density\" for 1 x 2 x 3"));
}

// Twelve triangles that are a box whatever their order; with one turned to the other diagonal they are none.
std::string box(const std::string& last) {
    return "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0 0 0 1 1 0 1 0 1 1 1 1 1] \"integer indices\" "
           "[0 1 2 1 2 3  4 5 6 5 6 7  0 1 4 1 4 5  2 3 6 3 6 7  0 2 4 2 4 6  1 3 5 " +
           last + "]\n";
}

TEST(ReadPbrt, BoxesAndSpheresOfAHomogeneousMedium) {
    const std::string fog =
        "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [1 2 3] \"rgb sigma_s\" [0 0 0] "
        "MediumInterface \"fog\" \"\" Material \"interface\" Rotate 90 1 0 0 Scale 2 3 4\n";
    const PbrtFile boxed = read(fog + box("3 5 7"));
    ASSERT_EQ(boxed.media.size(), 1u);
    EXPECT_EQ(boxed.media[0].volume.lower, Vec3d(0, -4, 0));
    EXPECT_EQ(boxed.media[0].volume.upper, Vec3d(2, 0, 3));
    EXPECT_THAT(boxed.media[0].volume.density, ElementsAre(2.0f));
    EXPECT_EQ(passed(boxed), "");
    const std::string lost = "homogeneous media in shapes other than spheres and boxes (1); ";
    EXPECT_THAT(passed(read(fog + box("1 5 7"))), HasSubstr(lost)) << "two halves that overlap";
    EXPECT_THAT(passed(read(fog + "Shape \"sphere\"")), HasSubstr(lost)) << "a sphere that is stretched";
    const PbrtFile round = read(fog + "Identity Scale -2 2 2 Shape \"sphere\" \"float radius\" 3");
    EXPECT_THAT(round.particles.radii, ElementsAre(6.0f));
    EXPECT_THAT(round.particles.density, ElementsAre(2.0f));
}

TEST(ReadPbrt, CountsWhatIsPassedOver) {
    const std::string text =
        "MakeNamedMedium \"v\" \"string type\" \"nanovdb\" \"string filename\" \"a.nvdb\"\n"
        "MediumInterface \"\" \"v\"\nAttribute \"shape\" \"float radius\" 2\n"
        "Shape \"sphere\" Shape \"sphere\" Shape \"bilinearmesh\" \"point3 P\" [0 0 0]\n"
        "Shape \"disk\" \"float alpha\" 0\n";
    EXPECT_EQ(passed(read(text)),
              "media outside of shapes (1); attributes of shapes (1); shapes of the type sphere (2); "
              "shapes of the type bilinearmesh (1); shapes of alpha 0 (1); media of the type nanovdb (1); ");
}

TEST(ReadPbrt, IncludesFilesOfItsFolderThatMayBePacked) {
    const std::string ply =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    const fs::path folder =
        test::write_file("part.pbrt.gz", test::packed("Translate 7 0 0\n" + triangle, 16 + 15)).parent_path();
    fs::create_directories(folder / "parts");
    test::write_file("parts/a.ply", ply);
    test::write_file("parts/b.ply.gz", test::packed(ply, 16 + 15));
    const PbrtFile file = read(
        "Import \"part.pbrt.gz\"\nShape \"plymesh\" \"string filename\" \"parts/a.ply\"\n"
        "Include \"part.pbrt.gz\" Shape \"plymesh\" \"string filename\" \"parts/b.ply.gz\"\n");
    ASSERT_EQ(file.mesh.triangles.size(), 4u);
    EXPECT_EQ(file.mesh.positions[0], Vec3f(8, 0, 0));
    EXPECT_EQ(file.mesh.positions[3], Vec3f(0, 0, 0)) << "what an import sets ends with it";
    EXPECT_EQ(file.mesh.positions[9], Vec3f(7, 0, 0));
}

// The public smoke plume states its extinction so.
TEST(ReadPbrt, ParametersGoOnAfterAnInclude) {
    test::write_file(
        "grid.pbrt",
        "MakeNamedMedium \"m\" \"string type\" \"uniformgrid\" \"integer nx\" 2 \"float density\" [1 3]\n");
    const PbrtFile file = read(
        "Include \"grid.pbrt\"\n\"spectrum sigma_a\" [300 20 830 20]\n\"spectrum sigma_s\" [300 160 830 160]\n"
        "MediumInterface \"m\" \"\" Material \"interface\" Shape \"sphere\"");
    ASSERT_EQ(file.media.size(), 1u);
    EXPECT_THAT(file.media[0].volume.density, ElementsAre(180.0f, 540.0f));
}

TEST(ReadPbrt, RefusesFilesThatLeadOutAndEndlessOnes) {
    EXPECT_THAT(refused("Include \"../scene.pbrt\""), HasSubstr("leads out of the folder"));
    EXPECT_THAT(refused("Shape \"plymesh\" \"string filename\" \"/etc/passwd\""), HasSubstr("leads out of the folder"));
    EXPECT_EQ(error_of([] { read("Include \"nowhere.pbrt\""); }).code(), base::ErrorCode::no_such_file);
    EXPECT_THAT(refused("Include \"scene.pbrt\""), HasSubstr("over 32 deep"));
    test::write_file("leaf.pbrt", "Identity");
    std::string many;
    for (int i = 0; i < 20; ++i) many += "Include \"leaf.pbrt\"\n";
    PbrtLimits few;
    few.files = 10;
    EXPECT_THAT(error_of([&] { read(many, few); }).message(), HasSubstr("reads over 10 files"));
    PbrtLimits small;
    small.bytes = many.size() + 10;
    EXPECT_THAT(error_of([&] { read(many, small); }).message(), HasSubstr("bytes, of all files together"));
    // A small file that is read again and again, also by another name, would cost the time of all limits at once.
    PbrtLimits repeats;
    repeats.repeats = 19 * std::string("Identity").size();
    EXPECT_NO_THROW(read(many, repeats));
    for (const char* name : {"leaf.pbrt", "./leaf.pbrt"})
        EXPECT_THAT(error_of([&] { read(many + "Include \"" + name + "\"", repeats); }).message(),
                    HasSubstr("reads over 152 bytes again"));
    PbrtLimits elements;
    elements.elements = 10;
    const std::string object = "ObjectBegin \"o\" " + triangle + "ObjectEnd ObjectInstance \"o\" ";
    EXPECT_THAT(refused(object + "ObjectInstance \"o\" ObjectInstance \"o\" ObjectInstance \"o\"", elements),
                HasSubstr("over 10 vertices"));
    EXPECT_THAT(refused("Shape \"curve\" \"float width\" 0.001 \"point3 P\" [0 0 0 0 9 0 9 9 0 9 0 0]", elements),
                HasSubstr("over 10 points of hair"));
    EXPECT_THAT(refused("MakeNamedMedium \"\xe4\" \"string type\" \"nanovdb\""), HasSubstr("of UTF-8"));
    PbrtLimits voxels;
    voxels.voxels = 5;
    EXPECT_THAT(refused(grid(""), voxels), HasSubstr("6 voxels; the limit"));
}

// Small files that include others many times, or save what they state many times, would otherwise fill the memory.
TEST(ReadPbrt, BoundsWhatASceneHolds) {
    const std::string fog = "MakeNamedMedium \"f\" \"string type\" \"homogeneous\" MediumInterface \"f\" ";
    const std::string sphere = "Shape \"sphere\" ";
    PbrtLimits two;
    two.elements = 2;
    EXPECT_THAT(refused(fog + sphere + sphere + sphere, two), HasSubstr("over 2 spheres of media"));
    const std::string box =
        "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0 0 0 1 1 0 1 0 1 1 1 1 1] \"integer indices\" "
        "[0 1 3 0 3 2 4 5 7 4 7 6 0 1 5 0 5 4 2 3 7 2 7 6 0 2 6 0 6 4 1 3 7 1 7 5]\n";
    std::string boxes = fog + "Material \"interface\" ";
    for (int i = 0; i < 1000; ++i) boxes += box;
    EXPECT_EQ(read(boxes).media.size(), 1000u);
    EXPECT_THAT(refused(boxes + box), HasSubstr("over 1000 boxes of media"));
    // Boxes take no voxels from the grids that follow.
    PbrtLimits voxels;
    voxels.voxels = 6;
    EXPECT_THAT(refused(fog + box + grid("") +
                            "MakeNamedMedium \"n\" \"string type\" \"uniformgrid\" "
                            "\"float density\" 1",
                        voxels),
                HasSubstr("1 voxels; the limit"));
    EXPECT_THAT(refused("MediumInterface \"" + std::string(257, 'm') + "\""), HasSubstr("over 256 bytes"));
    PbrtLimits objects;
    objects.elements = 3;
    const std::string two_objects =
        "ObjectBegin \"o\" " + triangle + "ObjectEnd ObjectBegin \"p\" " + triangle + "ObjectEnd ";
    EXPECT_TRUE(read(two_objects, objects).mesh.positions.empty());
    const std::string third = "ObjectBegin \"q\" " + triangle;
    EXPECT_THAT(refused(two_objects + third + "ObjectEnd", objects), HasSubstr("over 9 vertices"));
    EXPECT_THAT(error_of([&] { read(two_objects + third); }).message(), HasSubstr("inside the object \"q\""));
}

// A transform of the shutter's end would go on after the block that states it.
TEST(ReadPbrt, ABlockOfTransformsAlsoEndsWhichOnesHold) {
    EXPECT_EQ(placed("TransformBegin ActiveTransform EndTime TransformEnd Translate 5 0 0 ")[0], Vec3f(6, 0, 0));
}

TEST(ReadPbrt, NamesTheLineOfAFault) {
    const base::Error error = error_of([] { read("WorldBegin # of \"it\nTranslate 1 2\nScale 1 1 1\n"); });
    EXPECT_THAT(error.where(), HasSubstr("scene.pbrt:3"));
    EXPECT_THAT(error.message(), HasSubstr("Translate needs 3 numbers"));
    EXPECT_THAT(refused("solid cube\n"), HasSubstr("\"solid\" is not a statement of pbrt"));
    EXPECT_THAT(refused("Shape \"sphere"), HasSubstr("no other one on its line"));
    EXPECT_THAT(refused("Shape \"sphere\" \"radius\" 1"), HasSubstr("begins with its type and its name"));
    EXPECT_THAT(refused("Shape \"sphere\" \"float radius\" [1 2"), HasSubstr("has no end"));
    EXPECT_THAT(refused("Shape \"sphere\" \"float radius\" 1e999"), HasSubstr("not a finite number"));
    EXPECT_THAT(refused("Scale 1e30 1 1 Shape \"trianglemesh\" \"point3 P\" [1 0 0 0 1 0 0 0 1]"), HasSubstr("beyond"));
    EXPECT_THAT(refused("Transform [0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0]"), HasSubstr("parallel"));
    EXPECT_THAT(refused("MediumInterface \"m\" Shape \"sphere\""), HasSubstr("there is no medium \"m\""));
    EXPECT_THAT(refused("ObjectInstance \"o\""), HasSubstr("there is no object \"o\""));
    EXPECT_THAT(refused("Shape \"trianglemesh\" \"point3 P\" [0 0 0] \"integer indices\" [0 0 1]"),
                HasSubstr("names point 1, but there are 1"));
}

TEST(ReadPbrt, MediaAreChosenByNameOrNumber) {
    const auto file = test::write_file("media.pbrt", grid("") + "Material \"\" Shape \"sphere\"\n");
    EXPECT_EQ(read_pbrt_medium(file, {}).density.size(), 6u);
    EXPECT_EQ(read_pbrt_medium(file, 0).density.size(), 6u);
    EXPECT_EQ(read_pbrt_medium(file, std::string("m")).density.size(), 6u);
    const auto message = [&](const GridChoice& choice) {
        return error_of([&] { read_pbrt_medium(file, choice); }).message();
    };
    EXPECT_THAT(message(1), HasSubstr("no medium number 1, counted from 0; the media of the file: \"m\""));
    EXPECT_THAT(message(std::string("x")), HasSubstr("there is no medium \"x\""));
    const auto none = test::write_file("none.pbrt", triangle);
    EXPECT_THAT(error_of([&] { read_pbrt_medium(none, {}); }).message(), HasSubstr("give \"grid\""));
}

}  // namespace
}  // namespace shadowbench::scene
