// Data files without a scenario: which reader takes them, and what is said of them.
#include <OpenImageIO/imageio.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <set>

#include <nlohmann/json.hpp>

#include "scene/data_file.h"
#include "scene/describe_file.h"
#include "scene/packed_volume.h"
#include "scene/readers/kinds.h"
#include "scene/scenario.h"
#include "scene/support.h"

namespace shadowbench::scene {
namespace {

using test::bytes_of;
using test::error_of;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

std::filesystem::path case_file(const char* name) {
    return std::filesystem::path(SHADOWBENCH_SOURCE_DIR) / "tests/cases" / name;
}

std::string described(const std::filesystem::path& file) {
    return describe_file(read_data_file(file, {}));
}

// What is wrong with an object of this type that names a file of no format.
std::string message_of_loader(const std::string& type) {
    const std::filesystem::path folder = test::write_file("a.nothing", "nothing").parent_path();
    nlohmann::json document = nlohmann::json::parse(R"({
        "name": "n", "lights": [{"type": "directional", "direction": [0, -1, 0]}], "techniques": [{"type": "deep"}]})");
    document["scene"]["objects"] = nlohmann::json::array({nlohmann::json{{"type", type}, {"file", "a.nothing"}}});
    return error_of([&] { load_scenario(document, {folder}); }).message();
}

// A format that a loader knows and the table does not, or the other way round, would be seen here.
TEST(DataFile, TheTableHasTheExtensionsThatLoadersName) {
    for (const char* type : {"mesh", "hair", "volume", "particles"}) {
        const std::string message = message_of_loader(type);
        std::set<std::string> named, loaded;
        for (const FileFormat& format : file_formats()) {
            const std::string extension(format.extension);
            if (format.loader == type || format.loader == several_objects) loaded.insert(extension);
            if (message.find(extension) != std::string::npos) named.insert(extension);
        }
        EXPECT_EQ(named, loaded) << message;
        EXPECT_FALSE(loaded.empty()) << type;
    }
}

TEST(DataFile, NamesWhatIsReadInsteadOfAnUnknownExtension) {
    const auto file = test::write_file("a.abc", "11111\n");
    const base::Error error = error_of([&] { read_data_file(file, {}); });
    EXPECT_EQ(error.code(), base::ErrorCode::bad_input);
    EXPECT_EQ(error.where(), file.string());
    for (const char* known : {".obj", ".vdb", ".exr", ".slc", ".abc is not read"})
        EXPECT_THAT(error.message(), HasSubstr(known));
    EXPECT_EQ(error_of([&] { read_data_file(file.parent_path() / "gone.obj", {}); }).code(),
              base::ErrorCode::no_such_file);
    EXPECT_EQ(error_of([&] { read_data_file(file.parent_path(), {}); }).code(), base::ErrorCode::io);
}

TEST(DataFile, AFlatImageIsATextureAndADeepOneIsAScene) {
    const auto flat = test::fresh_path("flat.exr");
    const auto output = OIIO::ImageOutput::create(flat.string());
    ASSERT_TRUE(output && output->open(flat.string(), OIIO::ImageSpec(4, 2, 1, OIIO::TypeDesc::FLOAT)));
    const float pixels[] = {0, 0, 0, 0, 1, 1, 1, 1};
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, pixels));
    output->close();
    const DataFile texture = read_data_file(flat, {});
    EXPECT_EQ(texture.format->loader, "quad");
    EXPECT_EQ(bounds(texture).min, Vec3d(-1, 0, 0));  // twice as wide as high
    EXPECT_EQ(bounds(texture).max, Vec3d(1, 1, 0));
    EXPECT_THAT(describe_file(texture), HasSubstr("4 x 2 pixels, alpha 0 to 1, mean 0.5\n"));

    const DataFile deep = read_data_file(case_file("zback0.exr"), {});
    EXPECT_EQ(deep.format->loader, "deep_image");
    EXPECT_TRUE(bounds(deep).isEmpty());
    EXPECT_TRUE(casts_shadow(deep));
    EXPECT_THAT(describe_file(deep), AllOf(HasSubstr("64 samples, 1 a pixel; 1 channel of alpha"),
                                           HasSubstr("64 surfaces, 0 slabs, 0 behind everything"),
                                           HasSubstr("note: 64 of 64 samples have their ZBack before Z")));
}

// 1 x 1 x 1 texels of 32 bits, with the given flags for volumes.
std::string dds(unsigned caps) {
    return "DDS " + bytes_of(124u, 0x801007u, 1u, 1u, 0u, 1u, 0u) + std::string(44, '\0') +
           bytes_of(32u, 0x41u, 0u, 32u, 0xff0000u, 0xff00u, 0xffu, 0xff000000u, 0x401008u, caps, 0u, 0u, 0u) +
           "\x33\x66\x99\xcc";
}

TEST(DataFile, ADdsFileIsAVolumeByItsHeader) {
    EXPECT_TRUE(is_dds_volume(test::write_file("volume.dds", dds(0x200000u))));
    EXPECT_FALSE(is_dds_volume(test::write_file("flat.dds", dds(0u))));
    EXPECT_EQ(error_of([] { is_dds_volume(test::write_file("cut.dds", dds(0u).substr(0, 60))); }).code(),
              base::ErrorCode::bad_input);
    const DataFile volume = read_data_file(test::write_file("volume.dds", dds(0x200000u)), {});
    EXPECT_EQ(volume.format->loader, "volume");
    EXPECT_EQ(bounds(volume).max, Vec3d(1, 1, 1));
    EXPECT_THAT(describe_file(volume), HasSubstr("1 x 1 x 1 voxels, 1 in all, 1 above 0"));
}

TEST(DataFile, RawValuesHaveTheSizeOfTheirNameOrAreACube) {
    const auto expect = [](const char* name, std::uint64_t bytes, const Vec3i& size, const char* type) {
        const RawLayout layout = raw_layout(name, bytes);
        EXPECT_EQ(layout.size, size) << name;
        EXPECT_EQ(layout.type, type) << name;
    };
    expect("ball_32x32x24.raw", 24576, Vec3i(32, 32, 24), "uint8");
    expect("ball_32X32X24_float32.raw", 98304, Vec3i(32, 32, 24), "float32");
    expect("folder_2x2x2/3x4x5.raw", 60, Vec3i(3, 4, 5), "uint8");
    expect("v1_12x1_7x8x9.raw", 504, Vec3i(7, 8, 9), "uint8");
    expect("cube.raw", 27, Vec3i(3, 3, 3), "uint8");
    expect("cube.raw", 256, Vec3i(4, 4, 4), "float32");
}

// Collections of volumes name their files so.
TEST(DataFile, RawValuesHaveTheTypeOfTheirName) {
    const auto expect = [](const char* name, std::uint64_t bytes, const Vec3i& size, const char* type) {
        const RawLayout layout = raw_layout(name, bytes);
        EXPECT_EQ(layout.size, size) << name;
        EXPECT_EQ(layout.type, type) << name;
        EXPECT_TRUE(layout.type_stated) << name;
    };
    expect("ball_32x32x24_uint16.raw", 49152, Vec3i(32, 32, 24), "uint16");
    expect("INT16_ball.raw", 54, Vec3i(3, 3, 3), "int16");
    expect("ball_2x3x4_float64.raw.gz", 192, Vec3i(2, 3, 4), "float64");
    expect("a_int8.raw", 8, Vec3i(2, 2, 2), "int8");
    EXPECT_FALSE(raw_layout("uint16s_2x2x2.raw", 8).type_stated) << "another word";
    EXPECT_EQ(raw_layout("muint16_2x2x2.raw", 8).type, "uint8") << "another word";
}

TEST(DataFile, PackedRawValuesAreAsManyAsTheirEndStates) {
    const std::string packed = test::packed(bytes_of(std::int16_t{0}, std::int16_t{32767}), 16 + 15);
    const DataFile volume = read_data_file(test::write_file("a_2x1x1_int16.raw.gz", packed), {});
    EXPECT_THAT(std::get<GridVolume>(volume.scene.objects[0].shape).density, testing::ElementsAre(0.0f, 1.0f));
    EXPECT_THAT(describe_file(volume), AllOf(HasSubstr("volume of packed raw values"),
                                             HasSubstr("read as int16, little-endian, as its name says\n")));
}

TEST(DataFile, RawValuesOfAnotherLayoutAreRefused) {
    const auto message = [](const char* name, std::uint64_t bytes) {
        return error_of([&] { raw_layout(name, bytes); }).message();
    };
    EXPECT_THAT(message("ball_32x32x24.raw", 49152),
                AllOf(HasSubstr("states 32 x 32 x 24 voxels"), HasSubstr("of uint8 or float32: state the type")));
    EXPECT_THAT(message("ball_32x32x24_int8.raw", 49152), HasSubstr("not as many of int8"));
    EXPECT_THAT(message("ball.raw", 28), HasSubstr("as in ball_32x32x24_int16.raw"));
    EXPECT_THAT(message("ball.raw", 0), HasSubstr("no cube"));
    EXPECT_THAT(message("ball_0x1x1.raw", 5), HasSubstr("no cube"));
    EXPECT_THAT(message("2000x2000x2000.raw", 8'000'000'000), HasSubstr("the limit is"));
}

TEST(DataFile, HairWithoutAWidthGetsOneOfItsSize) {
    std::string bytes = bytes_of(3.0f, 2u, 2u);
    bytes.resize(296, '\0');
    // A strand along the diagonal of a box of 6 x 8 x 0, and one without length.
    bytes += bytes_of(0.0f, 0.0f, 0.0f, 6.0f, 8.0f, 0.0f, 1.0f, 1.0f, 0.0f, 1.0f, 1.0f, 0.0f);
    const DataFile hair = read_data_file(test::write_file("a.TFX", bytes), {});
    EXPECT_TRUE(hair.guessed_radius);
    EXPECT_EQ(std::get<Hair>(hair.scene.objects[0].shape).radii[0], 0.2f);
    EXPECT_THAT(describe_file(hair),
                AllOf(HasSubstr("a.TFX: TressFX hair, 344 B\n"), HasSubstr("  1 strand, 2 points; 2 a strand\n"),
                      HasSubstr("a half-width of 0.2 is a guess"), HasSubstr("left out: 1 strand without length\n")));
}

// Two strands as thin as those of a head of hair would not be seen.
TEST(DataFile, TheGuessOfAWidthFallsWithTheNumberOfStrands) {
    const auto guess = [](std::uint32_t strands) {
        std::string bytes = bytes_of(3.0f, strands, 2u);
        bytes.resize(296, '\0');
        for (std::uint32_t i = 0; i < strands; ++i) bytes += bytes_of(0.0f, 0.0f, 0.0f, 6.0f, 8.0f, 0.0f);
        const DataFile hair = read_data_file(test::write_file("b.tfx", bytes), {});
        return std::get<Hair>(hair.scene.objects[0].shape).radii[0];
    };
    EXPECT_EQ(guess(1), 0.2f);
    EXPECT_EQ(guess(100), 0.05f);
    EXPECT_EQ(guess(30'000), 0.005f);
}

TEST(DataFile, MeshesAreDescribedWithWhatIsPassedOver) {
    EXPECT_THAT(described(case_file("points.ply")),
                AllOf(HasSubstr("points.ply: PLY point cloud, 126 B\n"), HasSubstr("  4 points, density 1\n"),
                      HasSubstr("the file has no radius of points; a radius of 0.4 is a guess"),
                      HasSubstr("bounds [-0.4, 0.6, -1.4] to [1.4, 1.4, 0.4], size [1.8, 0.8, 1.8]\n")));
    const auto lone = test::write_file("lone.obj", "v 0 1 0\nv 1 1 -1\n");
    EXPECT_THAT(described(lone), HasSubstr("a point cloud: 2 points and no faces\n"));
    EXPECT_FALSE(casts_shadow(read_data_file(lone, {})));
    EXPECT_THAT(described(case_file("placed.gltf")),
                AllOf(HasSubstr("placed.gltf: glTF mesh, "), HasSubstr("12 vertices, 6 triangles\n"),
                      HasSubstr("alpha texture: 3 x 3 pixels, alpha 0.5\n"),
                      HasSubstr("bounds [-2, 0, 0] to [12, 3, 5], size [14, 3, 5]\n")));
    EXPECT_THAT(described(case_file("edge.obj")),
                AllOf(HasSubstr("4 vertices, 2 triangles\n"),
                      HasSubstr("note: passed over: faces of fewer than 3 corners (1)\n")));
    // The spare vertex at 9 casts no shadow.
    EXPECT_THAT(described(case_file("bom.obj")), HasSubstr("to [1, 1, 0], size [1, 0, 1]\n"));
}

TEST(DataFile, AnObjectOfEachTypeIsReadFromAPbrtScene) {
    EXPECT_THAT(
        described(case_file("scene.pbrt")),
        AllOf(HasSubstr("scene.pbrt: pbrt scene, "), HasSubstr("  1 strand, 3 points; 3 a strand\n"),
              HasSubstr("  1 point, density 0.25\n  radius 3\n"),
              HasSubstr("  medium \"smoke\":\n  1 x 2 x 3 voxels, 6 in all"), HasSubstr("  6 vertices, 2 triangles\n"),
              HasSubstr("note: passed over: shapes of the type disk (1)\n"), HasSubstr("note: it fills its own box")));
}

TEST(DataFile, GridsAreDescribedWithTheirAxesAndActiveVoxels) {
    EXPECT_THAT(described(case_file("noname.vdb")),
                AllOf(HasSubstr("16 x 16 x 16 voxels, 4096 in all, 4096 above 0; edges [1, 1, 1]\n"),
                      HasSubstr("density 0.5\n"), HasSubstr("grid \"(no name)\", 4096 active voxels\n"),
                      HasSubstr("note: the grid \"(no name)\" is read, the only one\n")));
    EXPECT_THAT(described(case_file("ramp.nvdb")),
                AllOf(HasSubstr("ramp.nvdb: NanoVDB grid, 964 B\n"), HasSubstr("edges [1, 2, 0.5]\n"),
                      HasSubstr("grid \"density\", 64 active voxels\n")));
    EXPECT_THAT(described(case_file("ramp.slc")),
                AllOf(HasSubstr("ramp.slc: volume of VolVis, "), HasSubstr("edges [1, 2, 0.5]\n"),
                      HasSubstr("  values of uint8, packed, divided by 255\n")));
    EXPECT_THAT(described(case_file("rot90.vdb")), HasSubstr("; its axes run along x, z, -y\n"));
    EXPECT_THAT(described(case_file("yzswap.vdb")), HasSubstr("; its axes run along x, z, y\n"));
    EXPECT_THAT(described(case_file("nonuniform.vdb")),
                AllOf(HasSubstr("edges [0.1, 0.2, 0.3]\n"), Not(HasSubstr("its axes"))));
    EXPECT_THAT(described(case_file("tinyneg.vdb")), AllOf(HasSubstr("4095 above 0"), HasSubstr("note: 1 of 4096")));
}

TEST(DataFile, VolumesAreDescribedWithTheirTypeAxesAndSpace) {
    const auto nrrd = test::write_file("a.nrrd",
                                       "NRRD0005\ntype: uchar\ndimension: 3\nsizes: 1 1 1\nencoding: raw\n"
                                       "space: scanner-xyz\nspace directions: (0,2,0) (-2,0,0) (0,0,2)\n"
                                       "space origin: (0,0,0)\n\nab");
    EXPECT_THAT(described(nrrd),
                AllOf(HasSubstr("a.nrrd: NRRD volume, "), HasSubstr("  values of uint8, divided by 255\n"),
                      HasSubstr("  its axes run along y, -x, z\n"), HasSubstr("  space: scanner-xyz\n"),
                      HasSubstr("bounds [-1, -1, -1] to [1, 1, 1]"),
                      HasSubstr("note: what follows its last voxel is passed over\n")));
}

// A grid that stands alone is read by any number that it has, and no other.
TEST(DataFile, AGridIsChosen) {
    FileChoice choice;
    choice.grid = 0;
    EXPECT_EQ(read_data_file(case_file("noname.vdb"), choice).vdb->active, 4096u);
    choice.grid = 1;
    EXPECT_THAT(error_of([&] { read_data_file(case_file("noname.vdb"), choice); }).message(),
                HasSubstr("there is no grid number 1"));
}

}  // namespace
}  // namespace shadowbench::scene
