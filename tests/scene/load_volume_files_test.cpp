// The keys of volumes in files of every format.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scene/packed_volume.h"
#include "scene/scenario.h"
#include "scene/support.h"

namespace shadowbench::scene {
namespace {

using nlohmann::json;
using test::bytes_of;
using test::error_of;
using testing::HasSubstr;

GridVolume load(const std::string& file, const std::string& bytes, const std::string& keys) {
    const auto folder = test::write_file(file, bytes).parent_path();
    json document = json::parse(R"({"name": "objects", "techniques": [{"type": "deep"}],
                                    "lights": [{"type": "directional", "direction": [0, -1, 0]}]})");
    document["scene"]["objects"] = {json::parse(fmt::format(R"({{"type": "volume", "file": "{}"{}}})", file, keys))};
    return std::get<GridVolume>(load_scenario(document, {folder}).scene.objects[0].shape);
}

std::string where_of(const std::string& file, const std::string& bytes, const std::string& keys) {
    return error_of([&] { load(file, bytes, keys); }).where();
}

const std::string pvm = "PVM2\n2 1 1\n1 1 4\n1\nab";

TEST(LoadVolumeFiles, PvmHasItsOwnBoxUnlessTheScenarioGivesOne) {
    const GridVolume own = load("a.pvm", pvm, ""),
                     given = load("b.PVM", pvm, R"(, "lower": [-1, -1, -1], "upper": [1, 0, 0])");
    EXPECT_EQ(own.lower, Vec3d(0, 0, 0));
    EXPECT_EQ(own.upper, Vec3d(2, 1, 4));
    EXPECT_EQ(own.step, 0.5);
    EXPECT_EQ(given.lower, Vec3d(-1, -1, -1));
    EXPECT_EQ(given.upper, Vec3d(1, 0, 0));
    EXPECT_EQ(load("a.pvm", pvm, R"(, "upper": [3, 3, 3])").upper, Vec3d(3, 3, 3));
    EXPECT_EQ(where_of("a.pvm", pvm, R"(, "lower": [3, 0, 0])"), "/scene/objects/0/upper");
}

// A volume of one texel: blue 0.2, green 0.4, red 0.6, alpha 0.8.
std::string dds() {
    return "DDS " + bytes_of(124u, 0x801007u, 1u, 1u, 0u, 1u, 0u) + std::string(44, '\0') +
           bytes_of(32u, 0x41u, 0u, 32u, 0xff0000u, 0xff00u, 0xffu, 0xff000000u, 0x401008u, 0x200000u, 0u, 0u, 0u) +
           "\x33\x66\x99\xcc";
}

TEST(LoadVolumeFiles, DdsNeedsABoxAndMayChooseAChannel) {
    const std::string box = R"(, "lower": [0, 0, 0], "upper": [1, 2, 4])";
    EXPECT_EQ(load("a.dds", dds(), box).density[0], 0.8f);
    EXPECT_EQ(load("A.DDS", dds(), box).upper, Vec3d(1, 2, 4));
    EXPECT_EQ(load("a.dds", dds(), box).step, 0.5);
    for (const auto& [channel, density] : {std::pair{"red", 0.6f}, {"green", 0.4f}, {"blue", 0.2f}, {"alpha", 0.8f}})
        EXPECT_EQ(load("a.dds", dds(), fmt::format(R"({}, "channel": "{}")", box, channel)).density[0], density);
    EXPECT_THAT(error_of([&] { load("a.dds", dds(), R"(, "lower": [0, 0, 0])"); }).message(),
                HasSubstr("\"upper\" is missing"));
    EXPECT_THAT(error_of([&] { load("a.dds", dds(), box + R"(, "channel": "grey")"); }).message(),
                HasSubstr("red, green"));
}

const std::string nrrd = "NRRD0001\ntype: uchar\ndimension: 3\nsizes: 2 1 1\nencoding: raw\nspacings: 1 1 4\n\nab",
                  mha =
                      "NDims = 3\nDimSize = 2 1 1\nElementSpacing = 1 1 4\nElementType = MET_UCHAR\n"
                      "ElementDataFile = LOCAL\nab",
                  vol = "VOL\x03" + bytes_of(3, 2, 1, 1, 1, 0.0f, 0.0f, 0.0f, 2.0f, 1.0f, 4.0f) + "ab";

const std::string slc = "11111 2 1 1 8 1 1 4 0 0 0 0 0 0 Xab";

TEST(LoadVolumeFiles, FilesWithABoxHaveItUnlessTheScenarioGivesOne) {
    for (const auto& [name, bytes] : {std::pair{"a.nrrd", nrrd},
                                      {"A.NHDR", nrrd},
                                      {"a.mha", mha},
                                      {"a.Mhd", mha},
                                      {"a.vol", vol},
                                      {"a.slc", slc},
                                      {"A.VOL", vol}}) {
        SCOPED_TRACE(name);
        const GridVolume own = load(name, bytes, ""),
                         given = load(name, bytes, R"(, "lower": [-1, -1, -1], "upper": [1, 0, 0])");
        EXPECT_EQ(own.upper - own.lower, Vec3d(2, 1, 4));
        EXPECT_EQ(own.step, 0.5);
        EXPECT_EQ(own.density[1], 'b' / 255.0f);
        EXPECT_EQ(given.lower, Vec3d(-1, -1, -1));
        EXPECT_EQ(given.upper, Vec3d(1, 0, 0));
        for (const char* key :
             {R"(, "format": "uint8")", R"(, "size": [1, 1, 1])", R"(, "grid": 0)", R"(, "channel": "red")",
              R"(, "byte_order": "big")", R"(, "skip": 1)", R"(, "spacing": [1, 1, 1])"})
            EXPECT_TRUE(where_of(name, bytes, key).starts_with("/scene/objects/0/")) << key;
    }
}

// Set in the grid's own space, the box would be turned with it.
TEST(LoadVolumeFiles, ABoxOfTheScenarioLiesInTheWorldAroundATurnedGrid) {
    const std::string turned = "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 1\nencoding: raw\n"
                               "space directions: (3,4,0) (-4,3,0) (0,0,5)\n\nabcd";
    const GridVolume own = load("a.nrrd", turned, ""),
                     given = load("a.nrrd", turned, R"(, "lower": [-1, -1, -1], "upper": [1, 6, 0])");
    ASSERT_TRUE(own.frame && given.frame);
    EXPECT_DOUBLE_EQ(own.step, 2.5) << "half of a voxel's edge";
    for (int a = 0; a < 3; ++a) {
        EXPECT_NEAR(world_box(own).max[a], a == 2 ? 5.0 : 14.0, 1e-12);
        EXPECT_NEAR(world_box(given).min[a], -1.0, 1e-12);
        EXPECT_NEAR(world_box(given).max[a], Vec3d(1, 6, 0)[a], 1e-12);
    }
}

TEST(LoadVolumeFiles, DensitiesBelow0AreRefusedIfTheScenarioSaysSo) {
    const std::string negative = R"(, "negative": "refuse")", below = bytes_of(1.0f, -1.0f);
    const std::string head = "NRRD0001\ntype: float\nendian: little\ndimension: 3\nsizes: 2 1 1\nencoding: raw\n\n";
    EXPECT_EQ(load("a.nrrd", head + below, "").notes.lines.size(), 1u);
    EXPECT_THAT(error_of([&] { load("a.nrrd", head + below, negative); }).message(), HasSubstr("below 0"));
    const std::string float_mha = "NDims = 3\nDimSize = 2 1 1\nElementType = MET_FLOAT\nElementDataFile = LOCAL\n";
    EXPECT_THAT(error_of([&] { load("a.mha", float_mha + below, negative); }).message(), HasSubstr("below 0"));
    const std::string float_vol = "VOL\x03" + bytes_of(1, 2, 1, 1, 1, 0.0f, 0.0f, 0.0f, 2.0f, 1.0f, 4.0f);
    EXPECT_THAT(error_of([&] { load("a.vol", float_vol + below, negative); }).message(), HasSubstr("below 0"));
}

TEST(LoadVolumeFiles, RawValuesHaveATypeAByteOrderAHeaderAndASpacing) {
    const std::string bytes("abc\x01\x02\xff\xff", 7),
        keys = R"(, "format": "uint16", "size": [2, 1, 1], "skip": 3, "byte_order": "big", "spacing": [0.5, 2, 1])";
    const GridVolume volume = load("a.raw", bytes, keys);
    EXPECT_THAT(volume.density, testing::ElementsAre(258.0f / 65535.0f, 1.0f));
    EXPECT_EQ(volume.lower, Vec3d(0, 0, 0));
    EXPECT_EQ(volume.upper, Vec3d(1, 2, 1));
    EXPECT_EQ(load("a.raw", bytes, keys + R"(, "lower": [1, 1, 1])").upper, Vec3d(2, 3, 2));
    EXPECT_EQ(where_of("a.raw", bytes, keys + R"(, "upper": [1, 1, 1])"), "/scene/objects/0/upper");
    const std::string far = R"(, "format": "uint8", "size": [7, 1, 1], "spacing": [1e18, 1, 1])";
    EXPECT_EQ(where_of("a.raw", bytes, far), "/scene/objects/0/spacing");
    EXPECT_THAT(error_of([&] { load("a.raw", bytes, R"(, "format": "uint8", "size": [7, 1, 1])"); }).message(),
                HasSubstr("without \"spacing\""));
    EXPECT_THAT(load("a.raw.gz", test::packed(bytes, 16 + 15), keys).density, testing::SizeIs(2));
}

TEST(LoadVolumeFiles, KeysOfOtherFormatsAreRefused) {
    for (const char* key :
         {R"(, "format": "uint8")", R"(, "size": [1, 1, 1])", R"(, "grid": 0)", R"(, "channel": "red")"})
        EXPECT_TRUE(where_of("a.pvm", pvm, key).starts_with("/scene/objects/0/")) << key;
    for (const char* key : {R"(, "format": "uint8")", R"(, "size": [1, 1, 1])", R"(, "grid": 0)"})
        EXPECT_TRUE(where_of("a.dds", dds(), key).starts_with("/scene/objects/0/")) << key;
    const std::string raw = R"(, "format": "uint8", "size": [1, 1, 1], "lower": [0, 0, 0], "upper": [1, 1, 1])";
    EXPECT_EQ(where_of("a.raw", "a", raw + R"(, "channel": "red")"), "/scene/objects/0/channel");
}

}  // namespace
}  // namespace shadowbench::scene
