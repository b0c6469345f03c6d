// The alpha of a glTF file's materials, as the one alpha texture of its mesh.
#include <OpenImageIO/imageio.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "scene/data_file.h"
#include "scene/describe_file.h"
#include "scene/gltf_maker.h"
#include "scene/new_scenario.h"
#include "scene/readers/files.h"
#include "scene/scenario.h"
#include "scene/support.h"

namespace shadowbench::scene {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::error_of;
using test::GltfMaker;
using testing::HasSubstr;

constexpr int width = 4, height = 3;

// Alphas that all differ, row after row from the top.
std::vector<float> alphas() {
    std::vector<float> list;
    for (int i = 0; i < width * height; ++i) list.push_back(static_cast<float>(1 + i * 5 % 12) / 16.0f);
    return list;
}

// An image of these alphas, black, or only black without them.
fs::path write_image(const std::string& name, bool with_alpha) {
    const fs::path file = test::fresh_path(name);
    OIIO::ImageSpec spec(width, height, with_alpha ? 4 : 3, OIIO::TypeDesc::FLOAT);
    const auto output = OIIO::ImageOutput::create(file.string());
    EXPECT_TRUE(output && output->open(file.string(), spec));
    std::vector<float> pixels;
    for (const float alpha : alphas()) {
        pixels.insert(pixels.end(), {0.0f, 0.0f, 0.0f});
        if (with_alpha) pixels.push_back(alpha);
    }
    EXPECT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, pixels.data()));
    output->close();
    return file;
}

json material(const char* mode, double factor, bool textured) {
    json result{{"alphaMode", mode}, {"pbrMetallicRoughness", {{"baseColorFactor", {0, 0, 0, factor}}}}};
    if (textured) result["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
    return result;
}

// A triangle of this material, with these texture coordinates.
void add_triangle(GltfMaker& maker, const json& of, const std::vector<Vec2f>& uvs) {
    const int points = maker.points({Vec3f(0, 0, 0), Vec3f(1, 0, 0), Vec3f(0, 1, 0)}), set = maker.uvs(uvs);
    maker.mesh(
        {{"attributes", {{"POSITION", points}, {"TEXCOORD_0", set}}}, {"material", maker.push("materials", of)}});
}

// A file of one textured triangle; the image is in leaf.tif.
GltfMaker textured(const json& of, const std::vector<Vec2f>& uvs, const json& sampler = json::object()) {
    GltfMaker maker;
    add_triangle(maker, of, uvs);
    maker.push("images", json{{"uri", "leaf.tif"}});
    maker.push("samplers", sampler);
    maker.push("textures", json{{"source", 0}, {"sampler", 0}});
    return maker;
}

Mesh read(const GltfMaker& maker) {
    return read_mesh(test::write_file("a.glb", maker.glb())).mesh;
}

// What the mesh's texture holds at a point of a triangle: the shares of its corners.
float alpha_at(const Mesh& mesh, std::size_t triangle, const Vec3d& shares) {
    Vec2d uv(0, 0);
    for (int corner = 0; corner < 3; ++corner)
        uv += Vec2d(mesh.corner_uv.at(3 * triangle + static_cast<std::size_t>(corner))) * shares[corner];
    return sample(*mesh.alpha, static_cast<float>(uv.x), static_cast<float>(uv.y));
}

// Points spread over a triangle, with its corners.
std::vector<Vec3d> spread() {
    std::vector<Vec3d> list;
    constexpr int steps = 12;
    for (int i = 0; i <= steps; ++i)
        for (int j = 0; i + j <= steps; ++j) list.push_back(Vec3d(i, j, steps - i - j) / static_cast<double>(steps));
    return list;
}

Vec2d mixed(const std::vector<Vec2f>& uvs, const Vec3d& shares) {
    return Vec2d(uvs[0]) * shares.x + Vec2d(uvs[1]) * shares.y + Vec2d(uvs[2]) * shares.z;
}

// Against the image itself, sampled where glTF says: (0, 0) is its top left corner.
TEST(ReadGltfAlpha, BlendIsTheAlphaOfTheTextureWhereverItRepeats) {
    write_image("leaf.tif", true);
    const AlphaTexture image{width, height, alphas()};
    for (const std::vector<Vec2f>& uvs :
         {std::vector<Vec2f>{Vec2f(0, 0), Vec2f(1, 0), Vec2f(0, 1)},
          std::vector<Vec2f>{Vec2f(0.3f, 0.2f), Vec2f(0.4f, 0.3f), Vec2f(0.35f, 0.9f)},
          std::vector<Vec2f>{Vec2f(-7.5f, 3.25f), Vec2f(-5.25f, 4.0f), Vec2f(-6.0f, 6.5f)}}) {
        const Mesh mesh = read(textured(material("BLEND", 0.5, true), uvs));
        ASSERT_TRUE(mesh.alpha);
        for (const Vec3d& shares : spread()) {
            const Vec2d at = mixed(uvs, shares);
            const float expected = 0.5f * sample(image, static_cast<float>(at.x), static_cast<float>(1.0 - at.y));
            EXPECT_NEAR(alpha_at(mesh, 0, shares), expected, 1e-4f) << at;
        }
    }
}

TEST(ReadGltfAlpha, TexturesAreMirroredOrClamped) {
    write_image("leaf.tif", true);
    const AlphaTexture image{width, height, alphas()};
    const std::vector<Vec2f> uvs{Vec2f(1.25f, -0.75f), Vec2f(2.0f, -0.75f), Vec2f(1.25f, -0.25f)};
    const auto inside = [](double at, int texels) { return std::clamp(at, 0.5 / texels, 1.0 - 0.5 / texels); };
    const Mesh mirrored = read(textured(material("BLEND", 1.0, true), uvs, {{"wrapS", 33648}, {"wrapT", 33648}}));
    const Mesh clamped = read(textured(material("BLEND", 1.0, true), uvs, {{"wrapS", 33071}, {"wrapT", 33071}}));
    for (const Vec3d& shares : spread()) {
        const Vec2d at = mixed(uvs, shares);
        const double u = inside(2.0 - at.x, width), v = inside(-at.y, height);
        EXPECT_NEAR(alpha_at(mirrored, 0, shares), sample(image, static_cast<float>(u), static_cast<float>(1.0 - v)),
                    1e-4f)
            << at;
        EXPECT_NEAR(alpha_at(clamped, 0, shares), alphas()[width - 1], 1e-4f) << at;
    }
}

TEST(ReadGltfAlpha, TheFileMayMoveATexture) {
    write_image("leaf.tif", true);
    const std::vector<Vec2f> uvs{Vec2f(0, 0), Vec2f(1, 0), Vec2f(0, 1)};
    json moved = material("BLEND", 1.0, true);
    moved["pbrMetallicRoughness"]["baseColorTexture"]["extensions"]["KHR_texture_transform"] = {
        {"scale", json::array({0.5, 0.25})}, {"offset", json::array({0.125, 0.5})}};
    const Mesh mesh = read(textured(moved, uvs));
    const AlphaTexture image{width, height, alphas()};
    for (const Vec3d& shares : spread()) {
        const Vec2d at = mixed(uvs, shares);
        const float expected =
            sample(image, static_cast<float>(0.5 * at.x + 0.125), static_cast<float>(1.0 - (0.25 * at.y + 0.5)));
        EXPECT_NEAR(alpha_at(mesh, 0, shares), expected, 1e-4f) << at;
    }
    moved["pbrMetallicRoughness"]["baseColorTexture"]["extensions"]["KHR_texture_transform"]["rotation"] = 1;
    const base::Error error = error_of([&] { read(textured(moved, uvs)); });
    EXPECT_THAT(error.where(), testing::EndsWith("/materials/0"));
}

// At the centres of texels, where nothing is interpolated.
TEST(ReadGltfAlpha, MaskCutsTexels) {
    write_image("leaf.tif", true);
    json mask = material("MASK", 0.5, true);
    mask["alphaCutoff"] = 0.25;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const Vec2f centre((static_cast<float>(x) + 0.5f) / width, (static_cast<float>(y) + 0.5f) / height);
            const Mesh mesh = read(textured(mask, {centre, Vec2f(0, 0), Vec2f(1, 1)}));
            const bool kept = 0.5f * alphas()[static_cast<std::size_t>(y * width + x)] >= 0.25f;
            EXPECT_NEAR(alpha_at(mesh, 0, Vec3d(1, 0, 0)), kept ? 1.0f : 0.0f, 1e-4f);
        }
}

TEST(ReadGltfAlpha, EveryMaterialKeepsItsOwn) {
    write_image("leaf.tif", true);
    const std::vector<Vec2f> uvs{Vec2f(0, 0), Vec2f(1, 0), Vec2f(0, 1)};
    GltfMaker maker = textured(material("BLEND", 1.0, true), uvs);
    add_triangle(maker, material("OPAQUE", 0.25, true), uvs);
    add_triangle(maker, material("BLEND", 0.25, false), uvs);
    add_triangle(maker, material("MASK", 0.25, false), uvs);
    add_triangle(maker, material("BLEND", 0.5, true), uvs);
    const Mesh mesh = read(maker);
    ASSERT_EQ(mesh.triangles.size(), 5u);
    const AlphaTexture image{width, height, alphas()};
    for (const Vec3d& shares : spread()) {
        const Vec2d at = mixed(uvs, shares);
        EXPECT_NEAR(alpha_at(mesh, 0, shares), sample(image, static_cast<float>(at.x), static_cast<float>(1.0 - at.y)),
                    1e-4f);
        EXPECT_EQ(alpha_at(mesh, 1, shares), 1.0f);
        EXPECT_EQ(alpha_at(mesh, 2, shares), 0.25f);
        EXPECT_EQ(alpha_at(mesh, 3, shares), 0.0f);
        EXPECT_NEAR(alpha_at(mesh, 4, shares), 0.5f * alpha_at(mesh, 0, shares), 1e-4f) << "the same image";
    }
}

TEST(ReadGltfAlpha, AnImageMayBeInTheFileOrHaveNoAlpha) {
    const std::string bytes = test::read_bytes(write_image("elsewhere.tif", true));
    const std::vector<Vec2f> uvs{Vec2f(0.125f, 0.5f), Vec2f(1, 0), Vec2f(0, 1)};
    GltfMaker inside = textured(material("BLEND", 1.0, true), uvs);
    inside.document["images"][0] = {{"bufferView", inside.view(bytes)}, {"mimeType", "image/tiff"}};
    EXPECT_NEAR(alpha_at(read(inside), 0, Vec3d(1, 0, 0)), alphas()[width], 1e-4f);

    write_image("leaf.tif", false);
    const Mesh opaque = read(textured(material("BLEND", 1.0, true), uvs));
    EXPECT_FALSE(opaque.alpha);
    EXPECT_TRUE(opaque.corner_uv.empty());

    inside.document["images"][0]["bufferView"] = 0;
    const base::Error error = error_of([&] { read(inside); });
    EXPECT_THAT(error.where(), testing::EndsWith("a.glb: /images/0"));
    GltfMaker gone = textured(material("BLEND", 1.0, true), uvs);
    gone.document["images"][0]["uri"] = "gone.tif";
    EXPECT_EQ(error_of([&] { read(gone); }).code(), base::ErrorCode::no_such_file);
}

TEST(ReadGltfAlpha, OlderMaterialsHaveADiffuseColour) {
    json older{{"alphaMode", "BLEND"}};
    older["extensions"]["KHR_materials_pbrSpecularGlossiness"]["diffuseFactor"] = json::array({1, 1, 1, 0.75});
    const Mesh mesh = read(textured(older, {Vec2f(0, 0), Vec2f(1, 0), Vec2f(0, 1)}));
    ASSERT_TRUE(mesh.alpha);
    EXPECT_EQ(alpha_at(mesh, 0, Vec3d(1, 0, 0)), 0.75f);
}

TEST(ReadGltfAlpha, OpaqueMaterialsNeedNoImage) {
    const Mesh mesh = read(textured(material("OPAQUE", 0.5, true), {Vec2f(0, 0), Vec2f(1, 0), Vec2f(0, 1)}));
    EXPECT_FALSE(mesh.alpha);
    EXPECT_EQ(mesh.corner_uv.size(), 3u);
}

TEST(ReadGltfAlpha, RefusesTexturesThatRepeatTooOften) {
    write_image("leaf.tif", true);
    const std::vector<Vec2f> uvs{Vec2f(0, 0), Vec2f(1e5f, 0), Vec2f(0, 1)};
    const base::Error error = error_of([&] { read(textured(material("BLEND", 1.0, true), uvs)); });
    EXPECT_EQ(error.code(), base::ErrorCode::bad_input);
    EXPECT_THAT(error.message(), HasSubstr("repeat the texture less often"));
}

TEST(ReadGltfAlpha, ScenariosTakeItAndInspectTellsIt) {
    GltfMaker maker;
    add_triangle(maker, material("BLEND", 0.5, false), {Vec2f(0, 0), Vec2f(1, 0), Vec2f(0, 1)});
    const fs::path file = test::write_file("a.glb", maker.glb());
    std::vector<DataFile> files;
    files.push_back(read_data_file(file, {}));
    EXPECT_THAT(describe_file(files[0]),
                HasSubstr("3 vertices, 1 triangle\n  the materials as one alpha texture: 3 x 3 "
                          "pixels, alpha 0.5\n"));
    EXPECT_FALSE(is_opaque(files));
    EXPECT_EQ(scene_objects(files[0], "a.glb").at(0).dump(), R"({"type":"mesh","name":"a","file":"a.glb"})");

    json document = json::parse(R"({"name": "alpha", "techniques": [{"type": "deep"}],
        "lights": [{"type": "directional", "direction": [0, -1, 0]}]})");
    document["scene"]["objects"] = json::array({{{"type", "mesh"}, {"file", "a.glb"}}});
    const Scenario scenario = load_scenario(document, {file.parent_path()});
    EXPECT_EQ(alpha_at(std::get<Mesh>(scenario.scene.objects[0].shape), 0, Vec3d(0, 0, 1)), 0.5f);
    write_image("leaf.tif", true);
    document["scene"]["objects"][0]["alpha_texture"] = "leaf.tif";
    EXPECT_EQ(error_of([&] { load_scenario(document, {file.parent_path()}); }).where(),
              "/scene/objects/0/alpha_texture");
}

}  // namespace
}  // namespace shadowbench::scene
