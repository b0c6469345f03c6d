#include "render/deep_exr.h"

#include <OpenImageIO/deepdata.h>
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>

#include "base/error.h"
#include "base/random.h"
#include "base/read_text.h"
#include "curves/sweep.h"
#include "rays/scenes.h"
#include "render/recomposite.h"
#include "scene/readers/files.h"
#include "temporary_folder.h"

namespace shadowbench::render {
namespace {

using testing::composite;
using testing::Sample;

class DeepExr : public ::testing::Test {
protected:
    const TemporaryFolder folder;
    const std::filesystem::path file = folder.path() / "deep.exr";
};

struct ReadBack {
    OIIO::ImageSpec spec;
    OIIO::DeepData data;

    std::vector<Sample> samples(int x, int y, const char* alpha) const {
        std::vector<Sample> result;
        const std::int64_t pixel = static_cast<std::int64_t>(y) * spec.width + x;
        for (int s = 0; s < data.samples(pixel); ++s)
            result.push_back({data.deep_value(pixel, spec.channelindex("Z"), s),
                              data.deep_value(pixel, spec.channelindex("ZBack"), s),
                              data.deep_value(pixel, spec.channelindex(alpha), s)});
        return result;
    }
};

ReadBack read(const std::filesystem::path& file) {
    const auto input = OIIO::ImageInput::open(file.string());
    EXPECT_TRUE(input) << OIIO::geterror();
    ReadBack result;
    result.spec = input->spec();
    EXPECT_TRUE(result.spec.deep);
    EXPECT_TRUE(input->read_native_deep_image(0, 0, result.data)) << input->geterror();
    return result;
}

scene::Scene hair_and_smoke() {
    scene::Scene scene;
    scene.objects.push_back(rays::testing::curly_hair(150, 12, 0.02f, 4));
    scene.objects.emplace_back();
    scene.objects.back().shape =
        scene::Particles{{{0.1f, 0.3f, 0.1f}, {-0.2f, -0.4f, 0.2f}}, {0.25f, 0.3f}, {3.0f, 1.0f}};
    return scene;
}

std::vector<DeepBlock> blocks_of(const rays::testing::Captured& captured) {
    std::vector<DeepBlock> blocks;
    for (const rays::LightRays& tile : captured.tiles) blocks.push_back(samples_of_rays(tile));
    return blocks;
}

TEST_F(DeepExr, OneRayAPixelComesBackAsTheSameLightRays) {
    const scene::Scene scene = hair_and_smoke();
    auto captured = rays::testing::capture(scene, rays::testing::directional(), rays::testing::rays(70, 1));
    // Opacities as a deep image can hold them: 1 - (1 - t) is t.
    for (rays::LightRays& tile : captured.tiles)
        for (float& t : tile.transmittance) t = 1.0f - (1.0f - t);
    write_deep_exr(file, 70, 70, blocks_of(captured), "");

    scene::Scene read_scene;
    read_scene.deep_image = scene::read_deep_image(file);
    scene::Light light;
    light.type = scene::LightType::deep_image;
    const auto read_rays = rays::testing::capture(read_scene, light, rays::testing::rays(70, 1));
    ASSERT_EQ(read_rays.layout.width, 70);
    const auto ray_of = [](const rays::testing::Captured& c, int x, int y) {
        std::vector<float> values;
        for (const rays::LightRays& tile : c.tiles) {
            if (x < tile.x0 || y < tile.y0 || x >= tile.x0 + tile.width || y >= tile.y0 + tile.height) continue;
            const std::size_t ray = static_cast<std::size_t>(y - tile.y0) * tile.width + (x - tile.x0);
            for (std::uint32_t s = tile.begin[ray]; s < tile.begin[ray + 1]; ++s)
                values.insert(values.end(), {tile.z_front[s], tile.back(s), tile.transmittance[s]});
        }
        return values;
    };
    std::size_t segments = 0;
    for (int y = 0; y < 70; ++y)
        for (int x = 0; x < 70; ++x) {
            ASSERT_EQ(ray_of(read_rays, x, y), ray_of(captured, x, y)) << x << ", " << y;
            segments += ray_of(captured, x, y).size() / 3;
        }
    EXPECT_GT(segments, 1000u);
}

TEST_F(DeepExr, SeveralRaysCompositeToTheVisibilityFunctionOfThePixel) {
    const scene::Scene scene = hair_and_smoke();
    const auto captured = rays::testing::capture(scene, rays::testing::directional(), rays::testing::rays(24, 16));
    write_deep_exr(file, 24, 24, blocks_of(captured), "");
    const ReadBack back = read(file);
    curves::SweepScratch scratch;
    curves::Curve function;
    for (const rays::LightRays& tile : captured.tiles)
        for (int p = 0; p < tile.width * tile.height; ++p) {
            curves::visibility(tile, static_cast<std::size_t>(p) * 16, 16, 1e-4, scratch, function);
            const auto samples = back.samples(tile.x0 + p % tile.width, tile.y0 + p / tile.width, "A");
            EXPECT_EQ(samples.empty(), function.empty());
            for (const curves::Vertex& v : function) {
                ASSERT_NEAR(composite(samples, v.z, false), curves::evaluate(function, v.z), 1e-5);
                ASSERT_NEAR(composite(samples, v.z, true), curves::evaluate_behind(function, v.z), 1e-5);
            }
        }
}

scene::Scene coloured() {
    scene::Scene scene = hair_and_smoke();
    scene.objects[0].opacity = {0.3f, 0.6f, 0.9f};
    scene.objects[1].extinction = {2.0f, 1.0f, 0.1f};
    return scene;
}

rays::testing::Captured captured_from(const std::filesystem::path& file) {
    static scene::Scene scene;  // must outlive the capture
    scene.deep_image = scene::read_deep_image(file);
    scene::Light light;
    light.type = scene::LightType::deep_image;
    return rays::testing::capture(scene, light, rays::testing::rays(1, 1));
}

// Calls visit(tile of the written rays, its pixel, tile of the rays read back, its ray).
template <class Visit>
void for_each_pixel(const rays::testing::Captured& written, const rays::testing::Captured& back, const Visit& visit) {
    for (const rays::LightRays& tile : written.tiles)
        for (int p = 0; p < tile.width * tile.height; ++p) {
            const int x = tile.x0 + p % tile.width, y = tile.y0 + p / tile.width;
            for (const rays::LightRays& other : back.tiles)
                if (x >= other.x0 && y >= other.y0 && x < other.x0 + other.width && y < other.y0 + other.height)
                    visit(tile, static_cast<std::size_t>(p), other,
                          static_cast<std::size_t>((y - other.y0) * other.width + x - other.x0));
        }
}

TEST_F(DeepExr, OneColouredRayAPixelComesBackWithEachTransmittance) {
    const auto written = rays::testing::capture(coloured(), rays::testing::directional(), rays::testing::rays(70, 1));
    ASSERT_EQ(written.layout.channels, 3);
    write_deep_exr(file, 70, 70, blocks_of(written), "");
    const auto back = captured_from(file);
    ASSERT_EQ(back.layout.channels, 3);
    std::size_t segments = 0;
    for_each_pixel(written, back, [&](const auto& tile, std::size_t p, const auto& other, std::size_t ray) {
        const std::size_t a = tile.begin[p], b = other.begin[ray], count = tile.begin[p + 1] - a;
        ASSERT_EQ(other.begin[ray + 1] - b, count);
        for (std::size_t s = 0; s < count; ++s) {
            ASSERT_EQ(other.z_front[b + s], tile.z_front[a + s]);
            ASSERT_EQ(other.back(b + s), tile.back(a + s));
            // As a deep image can hold it: 1 - (1 - t) is t.
            for (std::size_t c = 0; c < 3; ++c)
                ASSERT_EQ(other.transmittance[3 * (b + s) + c], 1.0f - (1.0f - tile.transmittance[3 * (a + s) + c]));
        }
        segments += count;
    });
    EXPECT_GT(segments, 1000u);
}

TEST_F(DeepExr, SeveralColouredRaysComeBackWithTheVisibilityOfEachColour) {
    const auto written = rays::testing::capture(coloured(), rays::testing::directional(), rays::testing::rays(24, 16));
    write_deep_exr(file, 24, 24, blocks_of(written), "");
    const auto back = captured_from(file);
    ASSERT_EQ(back.layout.channels, 3);
    curves::SweepScratch scratch;
    std::array<curves::Curve, 3> functions;
    double apart = 0.0;  // of two colours
    for_each_pixel(written, back, [&](const auto& tile, std::size_t p, const auto& other, std::size_t ray) {
        for (int c = 0; c < 3; ++c) {
            curves::Curve& function = functions[static_cast<std::size_t>(c)];
            curves::visibility(rays::channel(tile, c), p * 16, 16, 1e-4, scratch, function);
            for (const curves::Vertex& v : function) {
                const double behind = std::nextafter(v.z, 1e9f);
                ASSERT_NEAR(rays::transmittance(other, ray, c, v.z), curves::evaluate(function, v.z), 1e-5);
                ASSERT_NEAR(rays::transmittance(other, ray, c, behind), curves::evaluate_behind(function, v.z), 1e-5);
            }
        }
        for (const curves::Vertex& v : functions[0])
            apart = std::max(apart, std::abs(double{v.value} - curves::evaluate(functions[2], v.z)));
    });
    EXPECT_GT(apart, 0.3);
}

TEST_F(DeepExr, EqualColoursComeBackAsOneChannel) {
    DeepBlock block{0, 0, 1, 1, 3, {0, 1}, {2}, {3}, {0.25f, 0.25f, 0.25f}};
    write_deep_exr(file, 1, 1, std::span(&block, 1), "");
    const auto back = captured_from(file);
    EXPECT_EQ(back.layout.channels, 1);
    EXPECT_EQ(back.tiles[0].transmittance, std::vector<float>{0.75f});
}

TEST_F(DeepExr, ColouredSamplesHaveAnAlphaAChannelAndTheirMean) {
    DeepBlock block{1, 0, 1, 2, 3, {0, 0, 1}, {2}, {3}, {0.25f, 0.5f, 0.75f}};
    write_deep_exr(file, 2, 2, std::span(&block, 1), "light key");
    const ReadBack back = read(file);
    EXPECT_EQ(back.spec.get_string_attribute("ImageDescription"), "light key");
    EXPECT_EQ(back.spec.nchannels, 6);
    EXPECT_EQ(back.data.samples(1), 0);
    ASSERT_EQ(back.data.samples(3), 1);
    EXPECT_EQ(back.samples(1, 1, "A")[0].alpha, 0.5f);
    EXPECT_EQ(back.samples(1, 1, "AR")[0].alpha, 0.25f);
    EXPECT_EQ(back.samples(1, 1, "AG")[0].alpha, 0.5f);
    EXPECT_EQ(back.samples(1, 1, "AB")[0].alpha, 0.75f);
    EXPECT_EQ(back.samples(1, 1, "A")[0].z_back, 3.0f);
}

TEST_F(DeepExr, TheSameSamplesGiveTheSameBytes) {
    const DeepBlock block{0, 0, 1, 1, 1, {0, 2}, {1, 2}, {1, 3}, {0.5f, 1.0f}};
    write_deep_exr(file, 1, 1, std::span(&block, 1), "x");
    const std::string first = base::read_text(file);
    write_deep_exr(file, 1, 1, std::span(&block, 1), "x");
    EXPECT_EQ(base::read_text(file), first);
}

TEST_F(DeepExr, AFileThatCannotBeWrittenIsAnError) {
    const DeepBlock block{0, 0, 1, 1, 1, {0, 0}, {}, {}, {}};
    try {
        write_deep_exr("/nowhere/a.exr", 1, 1, std::span(&block, 1), "");
        FAIL();
    } catch (const base::Error& error) {
        EXPECT_EQ(error.code(), base::ErrorCode::io);
        EXPECT_EQ(error.where(), "/nowhere/a.exr");
    }
}

}  // namespace
}  // namespace shadowbench::render
