#include "claims/seen.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "render/shading.h"

namespace shadowbench::claims {
namespace {

using nlohmann::json;

// A sphere above the ground under a spot, both seen by a camera.
json document() {
    return json::parse(R"({
        "name": "seen",
        "scene": {"objects": [
            {"type": "sphere", "centre": [0, 1, 0], "radius": 0.5},
            {"type": "quad", "corner": [-4, 0, -4], "edge_u": [0, 0, 8], "edge_v": [8, 0, 0], "casts_shadow": false}]},
        "lights": [{"type": "spot", "position": [1, 6, 1], "target": [0, 0.5, 0], "angle": 30}],
        "rays": {"resolution": 256, "samples_per_pixel": 1, "pattern": "regular"},
        "receivers": {"type": "camera", "position": [0, 4, 5], "target": [0, 0.3, 0], "resolution": [64, 48],
                      "filter_width": 1e-6, "bias": 0.05},
        "reference": {"samples_per_pixel": 4},
        "techniques": [{"type": "shadow_map"}, {"type": "pcf", "res_factor": 4}]})");
}

TEST(Seen, LooksUpWhatEachPixelSees) {
    const Seen seen(document(), {});
    ASSERT_GT(seen.queries().size(), 500u);
    ASSERT_LE(seen.queries().size(), 64u * 48u);
    for (std::size_t q = 1; q < seen.queries().size(); ++q) EXPECT_LT(seen.pixel(q - 1), seen.pixel(q));
    const bench::Truth truth = seen.truth(seen.queries());
    std::size_t shadowed = 0, other = 0, soft = 0;
    for (std::size_t q = 0; q < seen.queries().size(); ++q) {
        shadowed += truth.value[q] < 0.5;
        other += std::abs(static_cast<double>(seen.visibility(0)[q]) - truth.value[q]) > 1e-6;
        soft += seen.visibility(1)[q] > 0.01f && seen.visibility(1)[q] < 0.99f;
    }
    EXPECT_GT(shadowed, 30u);
    EXPECT_LT(other, seen.queries().size() / 50) << "a fine shadow map errs only along the edges of the shadow";
    EXPECT_GT(soft, 10u) << "a wide filter has soft edges";
}

TEST(Seen, PlacesLieOnTheSurfacesThatPixelsSee) {
    const Seen seen(document(), {});
    std::size_t sphere = 0, ground = 0;
    for (std::size_t q = 0; q < seen.queries().size(); ++q) {
        const base::Vec3d& place = seen.place(q);
        if (std::abs(place.y) < 1e-4) {
            ++ground;
            EXPECT_LE(std::max(std::abs(place.x), std::abs(place.z)), 4.0 + 1e-4);
            const double cosine = (base::Vec3d(1, 6, 1) - place).normalized().y;
            EXPECT_NEAR(seen.shade(q), render::surface_albedo * cosine, 1e-4);
        } else {
            ++sphere;
            EXPECT_NEAR((place - base::Vec3d(0, 1, 0)).length(), 0.5, 1e-4);
        }
    }
    EXPECT_GT(sphere, 30u);
    EXPECT_GT(ground, 300u);
}

TEST(Seen, MakesPicturesOfValues) {
    const Seen seen(document(), {});
    std::vector<float> values(seen.queries().size(), 0.25f);
    const render::Image image = seen.picture(values);
    ASSERT_EQ(image.width, 64);
    ASSERT_EQ(image.height, 48);
    std::size_t grey = 0, white = 0;
    for (const base::Vec3f& pixel : image.pixels) {
        grey += pixel == base::Vec3f(0.25f);
        white += pixel == base::Vec3f(1.0f);
    }
    EXPECT_EQ(grey, values.size());
    EXPECT_EQ(grey + white, image.pixels.size());
}

TEST(Seen, ChoosesDifferentQueriesOverTheWholePicture) {
    const Seen seen(document(), {});
    const std::vector<std::size_t> chosen = seen.chosen(100);
    EXPECT_EQ(std::set<std::size_t>(chosen.begin(), chosen.end()).size(), 100u);
    EXPECT_LT(chosen.front(), seen.queries().size() / 50);
    EXPECT_GT(chosen.back(), seen.queries().size() - seen.queries().size() / 50);
}

TEST(Seen, LiesInAMapThatIsMovedByCells) {
    const Seen still(document(), {}), moved(document(), {}, {0.5, 0.25});
    std::size_t both = 0, m = 0;
    for (std::size_t q = 0; q < still.queries().size(); ++q) {
        while (m < moved.queries().size() && moved.pixel(m) < still.pixel(q)) ++m;
        if (m == moved.queries().size() || moved.pixel(m) != still.pixel(q)) continue;  // at the border of the map
        ++both;
        EXPECT_NEAR(moved.queries()[m].x, still.queries()[q].x - 0.5f, 1e-3f);
        EXPECT_NEAR(moved.queries()[m].y, still.queries()[q].y - 0.25f, 1e-3f);
        EXPECT_EQ(moved.queries()[m].z, still.queries()[q].z);
    }
    EXPECT_GT(both, still.queries().size() * 9 / 10);
}

TEST(Seen, RefusesATechniqueThatFails) {
    json with_tracer = document();
    with_tracer["techniques"] = json::parse(R"([{"type": "ray_traced"}])");
    EXPECT_THROW(Seen(with_tracer, {}), base::Error) << "it needs a scene to trace, which is not given here";
}

// The middle of a cell of the unmoved map moves by less than one cell, differently for each seed.
TEST(MovedMap, MovesByLessThanACell) {
    const json before = document();
    const double distance = std::sqrt(1.0 + 5.5 * 5.5 + 1.0),
                 cell = distance * 2.0 * std::tan(0.26179938779914943) / 256;
    std::set<double> places;
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        const json moved = with_moved_map(before, seed);
        EXPECT_EQ(moved, with_moved_map(before, seed));
        for (int axis = 0; axis < 3; ++axis) {
            const double step =
                moved["lights"][0]["target"][axis].get<double>() - before["lights"][0]["target"][axis].get<double>();
            EXPECT_LE(std::abs(step), 0.5 * cell);
            places.insert(step);
        }
        json back = moved;
        back["lights"][0]["target"] = before["lights"][0]["target"];
        EXPECT_EQ(back, before) << "nothing else changes";
    }
    EXPECT_EQ(places.size(), 60u);
}

}  // namespace
}  // namespace shadowbench::claims
