// The keys of volumes in .pvm and .dds files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

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
