// Tiles beyond their own pixels' sorted segments: aprons, and the order of submission.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "base/parallel.h"
#include "rays/capture.h"
#include "rays/scenes.h"

namespace shadowbench::rays {
namespace {

using base::Vec3f;
using testing::capture_all;
using testing::Captured;

// One object of every kind; the hair moves.
scene::Scene mixed_scene() {
    scene::Scene scene;
    scene.objects.push_back(testing::curly_hair(150, 15, 0.02f, 5));
    scene.objects[0].motion = {0.3f, -0.1f, 0.1f};
    scene.objects.push_back(testing::crumpled_sheet(9));
    scene.objects[1].opacity = {0.25f, 0.5f, 0.75f};
    scene.objects.emplace_back();
    scene.objects.back().shape = scene::Spheres{{{0.2f, 0.1f, 0.3f}, {-0.4f, 0.2f, -0.2f}}, {0.3f, 0.2f}};
    scene.objects.emplace_back();
    scene.objects.back().shape = scene::Particles{{{0.1f, 0.3f, 0.1f}, {0, 0, 0}}, {0.25f, 0.5f}, {2.0f, 0.5f}};
    scene.objects.emplace_back();
    scene.objects.back().shape = testing::slab();
    return scene;
}

scene::Scene surfaces_alone() {
    scene::Scene scene = mixed_scene();
    scene.objects.resize(3);
    scene.objects[1].opacity = Vec3f(0.5f);
    return scene;
}

// A map of 23 x 19 pixels in tiles of 7 x 5, which do not fit at both edges.
MapLayout small_tiles(const scene::Scene& scene, const LightView& view) {
    MapLayout layout = make_layout(scene, view, testing::rays(1, 4));
    layout.tile_width = 7;
    layout.tile_height = 5;
    return layout;
}

LightView view_of(const scene::Scene& scene, const scene::Light& light) {
    return make_light_view(light, scene, {23, 19}, "/lights/0");
}

// The ray in sample s of map pixel (x, y).
std::size_t ray_at(const LightRays& tile, int x, int y, int s) {
    return (static_cast<std::size_t>(y - tile.y0) * tile.width + (x - tile.x0)) * tile.samples + s;
}

using Segment = std::vector<float>;  // front, back, transmittances

Segment segment(const LightRays& t, std::size_t s) {
    Segment all{t.z_front[s], t.back(s)};
    for (int c = 0; c < t.channels; ++c) all.push_back(t.transmittance[s * t.channels + c]);
    return all;
}
std::vector<Segment> segments(const LightRays& t, std::size_t ray) {
    std::vector<Segment> all;
    for (std::size_t s = t.begin[ray]; s < t.begin[ray + 1]; ++s) all.push_back(segment(t, s));
    return all;
}
std::vector<Segment> submitted(const LightRays& t, std::size_t ray) {
    std::vector<Segment> all;
    for (std::size_t s = t.begin[ray]; s < t.begin[ray + 1]; ++s) all.push_back(segment(t, t.submission[s]));
    return all;
}

const LightRays& tile_of(const Captured& c, int x, int y) {
    return c.tiles[static_cast<std::size_t>(y / c.layout.tile_height * c.layout.tiles_x() + x / c.layout.tile_width)];
}

void expect_aprons_of_neighbours(const scene::Scene& scene, const LightView& view, MapLayout layout) {
    layout.submission = true;
    const Captured plain = capture_all(scene, view, layout);
    for (const int apron : {0, 1, 9}) {
        layout.apron = apron;
        const Captured wide = capture_all(scene, view, layout, apron);
        for (std::size_t t = 0; t < plain.tiles.size(); ++t) {
            const LightRays &own = plain.tiles[t], &more = wide.tiles[t];
            EXPECT_EQ(more.tile, own.tile);
            EXPECT_EQ(more.x0, std::max(own.x0 - apron, 0));
            EXPECT_EQ(more.y0, std::max(own.y0 - apron, 0));
            EXPECT_EQ(more.x0 + more.width, std::min(own.x0 + own.width + apron, layout.width));
            EXPECT_EQ(more.y0 + more.height, std::min(own.y0 + own.height + apron, layout.height));
            ASSERT_EQ(more.rays(), static_cast<std::size_t>(more.width) * more.height * more.samples);
            for (int y = more.y0; y < more.y0 + more.height; ++y)
                for (int x = more.x0; x < more.x0 + more.width; ++x)
                    for (int s = 0; s < more.samples; ++s) {
                        const LightRays& neighbour = tile_of(plain, x, y);
                        const std::size_t here = ray_at(more, x, y, s), there = ray_at(neighbour, x, y, s);
                        ASSERT_EQ(segments(more, here), segments(neighbour, there)) << "apron " << apron;
                        ASSERT_EQ(submitted(more, here), submitted(neighbour, there)) << "apron " << apron;
                    }
        }
    }
}

TEST(Aprons, HoldTheNeighbouringTilesRaysBitForBit) {
    for (const scene::Scene& scene : {mixed_scene(), surfaces_alone()})
        for (const auto& light : {testing::directional(), testing::spot({0.5, 0.4, 2}, 50)}) {
            const LightView view = view_of(scene, light);
            expect_aprons_of_neighbours(scene, view, small_tiles(scene, view));
        }
}

scene::Scene deep_image() {
    scene::Scene scene;
    scene.deep_image.emplace();
    scene.deep_image->width = 23;
    scene.deep_image->height = 19;
    scene.deep_image->begin.push_back(0);
    for (int pixel = 0; pixel < 23 * 19; ++pixel) {
        for (int s = 0; s < pixel % 4; ++s) {
            scene.deep_image->z_front.push_back(1.0f + static_cast<float>(s));
            scene.deep_image->z_back.push_back(1.5f + static_cast<float>(s));
            scene.deep_image->transmittance.push_back(0.001f * static_cast<float>(pixel));
        }
        scene.deep_image->begin.push_back(scene.deep_image->z_front.size());
    }
    return scene;
}

TEST(Aprons, OfADeepImageHoldItsOwnPixels) {
    const scene::Scene scene = deep_image();
    scene::Light light;
    light.type = scene::LightType::deep_image;
    const LightView view = make_light_view(light, scene, {23, 19}, "/lights/0");
    expect_aprons_of_neighbours(scene, view, small_tiles(scene, view));
}

TEST(Submission, IsEmptyUnlessAskedFor) {
    for (const scene::Scene& scene : {mixed_scene(), surfaces_alone()}) {
        const LightView view = view_of(scene, testing::directional());
        for (const LightRays& tile : capture_all(scene, view, small_tiles(scene, view)).tiles)
            EXPECT_EQ(tile.submission.capacity(), 0u);
    }
}

TEST(Submission, NamesEverySegmentOfARayOnce) {
    for (const scene::Scene& scene : {mixed_scene(), surfaces_alone()}) {
        const LightView view = view_of(scene, testing::directional());
        MapLayout layout = small_tiles(scene, view);
        layout.submission = true;
        std::size_t turned = 0;
        for (const LightRays& t : capture_all(scene, view, layout).tiles) {
            ASSERT_EQ(t.submission.size(), t.segments());
            for (std::size_t ray = 0; ray < t.rays(); ++ray) {
                std::vector<std::uint32_t> named(t.submission.begin() + t.begin[ray],
                                                 t.submission.begin() + t.begin[ray + 1]);
                turned += !std::is_sorted(named.begin(), named.end());
                std::sort(named.begin(), named.end());
                for (std::uint32_t k = 0; k < named.size(); ++k) ASSERT_EQ(named[k], t.begin[ray] + k);
            }
        }
        EXPECT_GT(turned, 100u) << "submission order is not depth order here";
    }
}

// Captures the objects one by one; appended in turn, their segments must have the order that they have together.
void expect_order_of_objects(const scene::Scene& scene, const LightView& view) {
    MapLayout layout = small_tiles(scene, view);
    layout.submission = true;
    const Captured together = capture_all(scene, view, layout);
    std::vector<Captured> alone;
    for (const scene::Object& object : scene.objects) alone.push_back(capture_all({{object}, {}}, view, layout));
    for (std::size_t t = 0; t < together.tiles.size(); ++t)
        for (std::size_t ray = 0; ray < together.tiles[t].rays(); ++ray) {
            std::vector<Segment> expected;
            for (const Captured& one : alone)
                for (const Segment& s : submitted(one.tiles[t], ray)) expected.push_back(s);
            ASSERT_EQ(submitted(together.tiles[t], ray), expected);
        }
}

TEST(Submission, GoesObjectByObject) {
    for (const scene::Scene& scene : {mixed_scene(), surfaces_alone()})
        for (const auto& light : {testing::directional(), testing::spot({0.5, 0.4, 2}, 50)})
            expect_order_of_objects(scene, view_of(scene, light));
}

TEST(Submission, GoesPrimitiveByPrimitiveInsideAnObject) {
    // The same spheres as one object and as many objects have one order.
    base::Random random(9);
    const auto place = [&] { return static_cast<float>(random.uniform(-0.6, 0.6)); };
    for (const Vec3f& motion : {Vec3f(0, 0, 0), Vec3f(0.4f, 0.1f, 0.2f)}) {
        scene::Scene one, many;
        scene::Spheres all;
        for (int i = 0; i < 30; ++i) {
            all.centres.emplace_back(place(), place(), place());
            all.radii.push_back(0.3f);
            many.objects.emplace_back();
            many.objects.back().shape = scene::Spheres{{all.centres.back()}, {0.3f}};
            many.objects.back().motion = motion;
        }
        one.objects.emplace_back();
        one.objects[0].shape = all;
        one.objects[0].motion = motion;
        const LightView view = view_of(one, testing::directional());
        MapLayout layout = small_tiles(one, view);
        layout.submission = true;
        const Captured a = capture_all(one, view, layout), b = capture_all(many, view, layout);
        for (std::size_t t = 0; t < a.tiles.size(); ++t) {
            EXPECT_EQ(a.tiles[t].z_front, b.tiles[t].z_front);
            EXPECT_EQ(a.tiles[t].submission, b.tiles[t].submission);
        }
    }
}

TEST(Submission, DependsOnTheSceneAloneNotOnTilesOrThreads) {
    const scene::Scene scene = mixed_scene();
    const LightView view = view_of(scene, testing::directional());
    MapLayout layout = small_tiles(scene, view);
    layout.submission = true;
    const Captured small = capture_all(scene, view, layout);
    layout.tile_width = 23;
    layout.tile_height = 19;
    const base::ThreadLimit one_thread(1);
    const Captured whole = capture_all(scene, view, layout);
    for (int y = 0; y < 19; ++y)
        for (int x = 0; x < 23; ++x)
            for (int s = 0; s < 4; ++s) {
                const LightRays& tile = tile_of(small, x, y);
                ASSERT_EQ(submitted(tile, ray_at(tile, x, y, s)),
                          submitted(whole.tiles[0], ray_at(whole.tiles[0], x, y, s)));
            }
}

TEST(Submission, SegmentsThatAreAlikeKeepTheOrderTheyCameIn) {
    scene::Scene scene;
    for (int i = 0; i < 3; ++i) scene.objects.push_back(testing::quad({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, 0.5f));
    const LightView view = view_of(scene, testing::directional());
    MapLayout layout = small_tiles(scene, view);
    layout.submission = true;
    for (const LightRays& t : capture_all(scene, view, layout).tiles)
        EXPECT_TRUE(std::is_sorted(t.submission.begin(), t.submission.end()));
}

TEST(Tiles, OfACaptureWithAnotherSeedAreThoseOfAFreshOne) {
    const scene::Scene scene = mixed_scene();
    const LightView view = view_of(scene, testing::spot({0, 0, 3}, 40));
    MapLayout layout = small_tiles(scene, view);
    const Capture first(scene, view, layout), shared(first, 77);
    layout.seed = 77;
    const Capture fresh(scene, view, layout);
    bool differ = false;
    for (int t = 0; t < layout.tiles(); ++t) {
        const LightRays a = shared.tile(t), b = fresh.tile(t), other = first.tile(t);
        ASSERT_EQ(a.begin, b.begin) << t;
        ASSERT_EQ(a.z_front, b.z_front) << t;
        ASSERT_EQ(a.z_back, b.z_back) << t;
        ASSERT_EQ(a.transmittance, b.transmittance) << t;
        differ = differ || a.z_front != other.z_front;
    }
    EXPECT_TRUE(differ);
}

}  // namespace
}  // namespace shadowbench::rays
