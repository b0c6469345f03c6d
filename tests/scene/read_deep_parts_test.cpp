// Deep EXR files of several parts.
#include <OpenImageIO/deepdata.h>
#include <OpenImageIO/imageio.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scene/readers/files.h"
#include "scene/support.h"

namespace shadowbench::scene {
namespace {

using test::bytes_of;
using test::error_of;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

// Deep parts with one sample each, at depth 1, 2, ...
std::filesystem::path write_parts(const std::vector<std::string>& names) {
    const std::filesystem::path file = test::fresh_path("parts.exr");
    std::vector<OIIO::ImageSpec> specs;
    for (const std::string& name : names) {
        OIIO::ImageSpec spec(2, 1, 2, OIIO::TypeDesc::FLOAT);
        spec.channelnames = {"A", "Z"};
        spec.deep = true;
        spec.attribute("compression", "zips");
        spec.attribute("oiio:subimagename", name);
        specs.push_back(spec);
    }
    const auto output = OIIO::ImageOutput::create(file.string());
    EXPECT_TRUE(output->open(file.string(), static_cast<int>(specs.size()), specs.data())) << output->geterror();
    for (std::size_t part = 0; part < specs.size(); ++part) {
        if (part > 0) {
            EXPECT_TRUE(output->open(file.string(), specs[part], OIIO::ImageOutput::AppendSubimage))
                << output->geterror();
        }
        OIIO::DeepData data;
        data.init(specs[part]);
        data.set_samples(0, 1);
        data.set_deep_value(0, 0, 0, 0.5f);
        data.set_deep_value(0, 1, 0, static_cast<float>(part + 1));
        EXPECT_TRUE(output->write_deep_image(data)) << output->geterror();
    }
    output->close();
    return file;
}

TEST(ReadDeepParts, TakesAPartByNumberOrNameAndAsksForOneOfSeveral) {
    const auto file = write_parts({"left", "centre", "right"});
    EXPECT_THAT(error_of([&] { read_deep_image(file); }).message(),
                AllOf(HasSubstr("\"part\""), HasSubstr("0 \"left\", 1 \"centre\", 2 \"right\"")));
    EXPECT_THAT(read_deep_image(file, {{}, 0}).z_front, ElementsAre(1));
    EXPECT_THAT(read_deep_image(file, {{}, 2}).z_front, ElementsAre(3));
    EXPECT_THAT(read_deep_image(file, {{}, "right"}).z_front, ElementsAre(3));
    for (const DeepChoice& gone : {DeepChoice{{}, 3}, DeepChoice{{}, -1}, DeepChoice{{}, "middle"}})
        EXPECT_THAT(error_of([&] { read_deep_image(file, gone); }).message(),
                    AllOf(HasSubstr("no such \"part\""), HasSubstr("2 \"right\"")));
}

TEST(ReadDeepParts, TellsWhichPartIsReadAndWhichAreNot) {
    const auto file = write_parts({"left", "centre", "right"});
    EXPECT_THAT(read_deep_image(file, {{}, "centre"}).notes.lines,
                ElementsAre("of 3 parts 1 \"centre\" is read; passed over: 0 \"left\", 2 \"right\""));
    std::vector<std::string> names;
    for (int i = 0; i < 10; ++i) names.push_back("p" + std::to_string(i));
    EXPECT_THAT(
        read_deep_image(write_parts(names), {{}, 0}).notes.lines,
        ElementsAre(AllOf(HasSubstr("of 10 parts 0 \"p0\""), HasSubstr("8 \"p8\", ..."), Not(HasSubstr("p9")))));
}

std::string attribute(const std::string& name, const std::string& type, const std::string& value) {
    return name + '\0' + type + '\0' + bytes_of(static_cast<std::uint32_t>(value.size())) + value;
}

// The header of a part of one pixel without compression; its channels are floats.
std::string part_header(const std::string& name, const std::string& type, const std::vector<std::string>& channels) {
    std::string list;
    for (const std::string& channel : channels) list += channel + '\0' + bytes_of(2, 0, 1, 1);
    const std::string window = bytes_of(0, 0, 0, 0), zero(1, '\0');
    return attribute("channels", "chlist", list + '\0') + attribute("chunkCount", "int", bytes_of(1)) +
           attribute("compression", "compression", zero) + attribute("dataWindow", "box2i", window) +
           attribute("displayWindow", "box2i", window) + attribute("lineOrder", "lineOrder", zero) +
           attribute("name", "string", name) + attribute("pixelAspectRatio", "float", bytes_of(1.0f)) +
           attribute("screenWindowCenter", "v2f", bytes_of(0.0f, 0.0f)) +
           attribute("screenWindowWidth", "float", bytes_of(1.0f)) + attribute("type", "string", type) +
           attribute("version", "int", bytes_of(1)) + '\0';
}

// The usual file of a renderer: the picture, and a deep part of it. OpenImageIO cannot write both kinds into one file.
TEST(ReadDeepParts, FindsTheDeepPartBehindAFlatOne) {
    const std::string headers = bytes_of(20000630u, 0x1802u) + part_header("beauty", "scanlineimage", {"Y"}) +
                                part_header("deep", "deepscanline", {"A", "Z"}) + '\0';
    // Number of the part, row, size, values.
    const std::string flat = bytes_of(0, 0, 4, 0.25f);
    // Number of the part, row, sizes of the counts and of the samples, packed and not; counts; A, Z.
    const std::string deep =
        bytes_of(1, 0, std::uint64_t{4}, std::uint64_t{8}, std::uint64_t{8}) + bytes_of(1, 0.5f, 4.0f);
    const std::uint64_t first = headers.size() + 2 * sizeof(std::uint64_t);
    const auto file = test::write_file("mixed.exr", headers + bytes_of(first, first + flat.size()) + flat + deep);
    for (const DeepChoice& choice : {DeepChoice{}, DeepChoice{{}, 1}, DeepChoice{{}, "deep"}}) {
        const DeepImage image = read_deep_image(file, choice);
        EXPECT_THAT(image.z_front, ElementsAre(4));
        EXPECT_THAT(image.transmittance, ElementsAre(0.5f));
        EXPECT_THAT(image.notes.lines,
                    ElementsAre("of 2 parts 1 \"deep\" is read; passed over: 0 \"beauty\" (not deep)"));
    }
    EXPECT_THAT(error_of([&] {
                    read_deep_image(file, {{}, 0});
                }).message(),
                AllOf(HasSubstr("the part 0 \"beauty\" is not a deep image"), HasSubstr("1 \"deep\"")));
}

}  // namespace
}  // namespace shadowbench::scene
