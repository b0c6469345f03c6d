#include "scene/scene.h"

#include <gtest/gtest.h>

namespace shadowbench::scene {
namespace {

// 2 x 2: the upper row 0 and 1, the lower row 0.25 and 0.5.
const AlphaTexture four{2, 2, {0.0f, 1.0f, 0.25f, 0.5f}};

Object object(decltype(Object::shape) shape) {
    Object result;
    result.shape = std::move(shape);
    return result;
}

TEST(AlphaTexture, TexelCentresGiveTheTexelAndRowZeroIsOnTop) {
    EXPECT_FLOAT_EQ(sample(four, 0.25f, 0.75f), 0.0f);
    EXPECT_FLOAT_EQ(sample(four, 0.75f, 0.75f), 1.0f);
    EXPECT_FLOAT_EQ(sample(four, 0.25f, 0.25f), 0.25f);
    EXPECT_FLOAT_EQ(sample(four, 0.75f, 0.25f), 0.5f);
}

TEST(AlphaTexture, IsBilinearBetweenCentres) {
    EXPECT_FLOAT_EQ(sample(four, 0.5f, 0.75f), 0.5f);
    EXPECT_FLOAT_EQ(sample(four, 0.5f, 0.5f), 0.4375f);
}

TEST(AlphaTexture, RepeatsOutsideTheUnitSquare) {
    for (const float turns : {-3.0f, 1.0f, 7.0f}) {
        EXPECT_FLOAT_EQ(sample(four, 0.25f + turns, 0.75f), sample(four, 0.25f, 0.75f));
        EXPECT_FLOAT_EQ(sample(four, 0.3f, 0.4f + turns), sample(four, 0.3f, 0.4f));
    }
    // The left edge lies half way between the last column and the first.
    EXPECT_FLOAT_EQ(sample(four, 0.0f, 0.75f), 0.5f);
}

TEST(AlphaTexture, OfOneTexelIsThatTexelEverywhere) {
    const AlphaTexture one{1, 1, {0.7f}};
    for (const float at : {-2.3f, 0.0f, 0.5f, 0.99f, 1e6f}) EXPECT_FLOAT_EQ(sample(one, at, -at), 0.7f);
}

TEST(Bounds, OfAnEmptySceneAreEmpty) {
    EXPECT_TRUE(bounds(Scene{}, false).isEmpty());
    EXPECT_TRUE(bounds(Scene{}, true).isEmpty());
}

TEST(Bounds, HoldTheWholeOfRoundThings) {
    Scene scene;
    scene.objects.push_back(object(Spheres{{{1, 2, 3}}, {0.5f}}));
    scene.objects.push_back(object(Hair{{{0, 0, 0}, {0, 4, 0}}, {0.25f, 0.0f}, {0, 2}}));
    const Box3d box = bounds(scene, true);
    EXPECT_EQ(box.min, Vec3d(-0.25, -0.25, -0.25));
    EXPECT_EQ(box.max, Vec3d(1.5, 4.0, 3.5));
}

TEST(Bounds, IgnoreVerticesThatNoTriangleUses) {
    Scene scene;
    scene.objects.push_back(object(Mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {100, 100, 100}}, {{0, 1, 2}}, {}, nullptr}));
    EXPECT_EQ(bounds(scene, true).max, Vec3d(1, 1, 0));
}

TEST(Bounds, LeaveReceiversOutWhenOnlyCastersCount) {
    Scene scene;
    scene.objects.push_back(object(Spheres{{{0, 0, 0}}, {1.0f}}));
    scene.objects.push_back(object(Particles{{{9, 0, 0}}, {1.0f}, {1.0f}}));
    scene.objects.back().casts_shadow = false;
    EXPECT_EQ(bounds(scene, true).max.x, 1.0);
    EXPECT_EQ(bounds(scene, false).max.x, 10.0);
}

TEST(Bounds, OfAVolumeAreItsBox) {
    GridVolume volume;
    volume.lower = Vec3d(-1, -2, -3);
    volume.upper = Vec3d(1, 2, 3);
    Scene scene;
    scene.objects.push_back(object(volume));
    EXPECT_EQ(bounds(scene, true).min, volume.lower);
    EXPECT_EQ(bounds(scene, true).max, volume.upper);
}

TEST(Bounds, HoldTheWholeMovement) {
    Scene scene;
    scene.objects.push_back(object(Spheres{{{1, 2, 3}}, {0.5f}}));
    scene.objects[0].motion = {2, -4, 0};
    EXPECT_EQ(bounds(scene, true).min, Vec3d(0.5, -2.5, 2.5));
    EXPECT_EQ(bounds(scene, true).max, Vec3d(3.5, 2.5, 3.5));
}

TEST(HasMotion, CountsOnlyCasters) {
    Scene scene;
    scene.objects.push_back(object(Spheres{{{0, 0, 0}}, {1.0f}}));
    EXPECT_FALSE(has_motion(scene));
    scene.objects.push_back(scene.objects[0]);
    scene.objects[1].motion = {0, 0, 1};
    EXPECT_TRUE(has_motion(scene));
    scene.objects[1].casts_shadow = false;
    EXPECT_FALSE(has_motion(scene));
}

TEST(Channels, AreThreeOnlyForColourThatCastsShadows) {
    Scene scene;
    scene.objects.push_back(object(Spheres{{{0, 0, 0}}, {1.0f}}));
    EXPECT_EQ(channels(scene), 1);
    // A surface's extinction and a medium's opacity mean nothing.
    scene.objects[0].extinction = Vec3f(1, 2, 3);
    EXPECT_EQ(channels(scene), 1);
    scene.objects[0].opacity = Vec3f(1.0f, 0.5f, 1.0f);
    EXPECT_EQ(channels(scene), 3);
    scene.objects[0].casts_shadow = false;
    EXPECT_EQ(channels(scene), 1);
    scene.objects.push_back(object(Particles{{{9, 0, 0}}, {1.0f}, {1.0f}}));
    scene.objects[1].extinction = Vec3f(1, 1, 2);
    EXPECT_EQ(channels(scene), 3);
}

TEST(HasMedia, CountsOnlyCasters) {
    Scene scene;
    scene.objects.push_back(object(Spheres{{{0, 0, 0}}, {1.0f}}));
    EXPECT_FALSE(has_media(scene));
    scene.objects.push_back(object(GridVolume{}));
    EXPECT_TRUE(has_media(scene));
    scene.objects[1].casts_shadow = false;
    EXPECT_FALSE(has_media(scene));
}

TEST(HasMedia, SeesSamplesWithDepthInADeepImage) {
    Scene scene;
    scene.deep_image = DeepImage{1, 1, {0, 1}, {2.0f}, {2.0f}, {0.5f}};
    EXPECT_FALSE(has_media(scene));
    scene.deep_image->z_back[0] = 3.0f;
    EXPECT_TRUE(has_media(scene));
    scene.deep_image->z_back[0] = 1e30f;
    EXPECT_FALSE(has_media(scene)) << "no place is in it";
}

TEST(Channels, AreThoseOfADeepImage) {
    Scene scene;
    scene.deep_image = DeepImage{1, 1, {0, 1}, {2.0f}, {2.0f}, {0.5f}};
    EXPECT_EQ(channels(scene), 1);
    scene.deep_image->transmittance = {0.5f, 0.25f, 1.0f};
    scene.deep_image->channels = 3;
    EXPECT_EQ(channels(scene), 3);
}

TEST(ReadNotes, NameTheirPlacesAndQuoteFilesSafely) {
    Scene scene;
    scene.objects.push_back(object(Spheres{{{0, 0, 0}}, {1.0f}}));
    scene.objects.push_back(object(GridVolume{}));
    EXPECT_TRUE(read_notes(scene).empty());
    std::get<GridVolume>(scene.objects[1].shape).notes.lines = {"a\n\xff", "b"};
    scene.objects[0].passed_over = {{"faces without area", 2}, {"points", 1}};
    scene.deep_image.emplace();
    scene.deep_image->notes.lines = {"c"};
    EXPECT_EQ(read_notes(scene),
              (std::vector<std::string>{"/scene/objects/0: passed over: faces without area (2), points (1)",
                                        "/scene/objects/1: a ?", "/scene/objects/1: b", "/scene/deep_image: c"}));
}

}  // namespace
}  // namespace shadowbench::scene
