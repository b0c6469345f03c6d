// The six maps of a point light: every receiver has one, and a lookup across a seam answers as if there were none.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/random.h"
#include "bench/queries.h"
#include "bench/reference.h"
#include "bench/variant_runs.h"
#include "scene/cube_face.h"
#include "scene/scenario.h"

namespace shadowbench::bench {
namespace {

using base::Vec3d;

constexpr double degree = std::numbers::pi / 180.0;
constexpr int resolution = 64;
constexpr double border = 0.125, pixel = 2.0 * (1.0 + border) / resolution;  // as a slope
const Vec3d lamp(0.5, 0.25, -0.75);

// Around the y axis, from x towards z.
Vec3d at_azimuth(double degrees, double distance, double height = 0.0) {
    return {std::cos(degrees * degree) * distance, height, std::sin(degrees * degree) * distance};
}

// A wall 2 before the lamp, whose edge is vertical, at this azimuth; it covers the next 20 degrees.
nlohmann::json wall(double edge) {
    const auto list = [](const Vec3d& v) { return nlohmann::json{v.x, v.y, v.z}; };
    return {{"type", "quad"},
            {"corner", list(lamp + at_azimuth(edge, 2.0, -1.5))},
            {"edge_u", list(at_azimuth(edge + 90.0, 2.0 * std::tan(20.0 * degree)))},
            {"edge_v", {0, 3, 0}}};
}

scene::Scenario scenario(const nlohmann::json& object) {
    nlohmann::json document{{"name", "lamp"},
                            {"techniques", {{{"type", "deep"}}}},
                            {"scene", {{"objects", nlohmann::json::array({object})}}}};
    document["lights"] = {{{"type", "point"}, {"position", {lamp.x, lamp.y, lamp.z}}, {"border", border}}};
    document["rays"] = {{"resolution", resolution}, {"samples_per_pixel", 16}};
    return scene::load_scenario(document, {});
}

struct Asked {
    rays::LightView view;
    techniques::Query query;
};

// The faces that answer for a point.
std::vector<Asked> faces_of(const scene::Scenario& made, const Vec3d& point, double width = 1.0) {
    scene::Receivers receivers;
    receivers.filter_width.value = width;
    std::vector<Asked> asked;
    for (const scene::Light& light : made.lights) {
        const rays::LightView view = rays::make_light_view(light, made.scene, made.rays.resolution, light.where);
        if (const auto query = query_of_point({point}, receivers, view)) asked.push_back({view, *query});
    }
    return asked;
}

TEST(PointLight, EveryPointHasOneFaceAndComesBackFromIt) {
    const scene::Scenario made = scenario(wall(0.0));
    ASSERT_EQ(made.lights.size(), 6u);
    std::vector<Vec3d> directions;
    for (int x = -1; x <= 1; ++x)  // middles, seams and corners, exactly
        for (int y = -1; y <= 1; ++y)
            for (int z = -1; z <= 1; ++z)
                if (x != 0 || y != 0 || z != 0) directions.emplace_back(x, y, z);
    base::Random random(4);
    for (int i = 0; i < 300; ++i)
        directions.emplace_back(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    for (const Vec3d& direction : directions) {
        const std::vector<Asked> asked = faces_of(made, lamp + direction * 4.0);
        ASSERT_EQ(asked.size(), 1u) << direction.x << " " << direction.y << " " << direction.z;
        const techniques::Query& q = asked[0].query;
        const Vec3d back = rays::to_world(asked[0].view, rays::unproject(asked[0].view, q.x, q.y, q.z));
        EXPECT_NEAR((back - lamp - direction * 4.0).length(), 0.0, 1e-4);
        for (const float place : {q.x, q.y}) {  // the border of 1/18 of the map is free on all sides
            EXPECT_GE(place, resolution / 18.0 - 1e-3);
            EXPECT_LE(place, resolution * 17.0 / 18.0 + 1e-3);
        }
    }
}

// The share of the light past the wall, by many exact rays over a footprint of `width` map pixels.
double visible(const scene::Scenario& made, const Vec3d& point, double width) {
    const std::vector<Asked> asked = faces_of(made, point, width);
    EXPECT_EQ(asked.size(), 1u);
    scene::RaySettings settings = made.rays;
    settings.samples_per_pixel = 256;
    return reference_visibility(made.scene, asked[0].view, settings, {&asked[0].query, 1}, {}).value[0];
}

// A footprint spans `width` pixels of slope: of tan(azimuth) in the face +x, of -cot(azimuth) in the face +z. The wall
// covers what lies beyond its edge. The rotated cube has the seam of 45 degrees in the middle of its face, where slopes
// change half as fast with the azimuth.
TEST(PointLight, ALookupAcrossASeamEqualsTheOneFromARotatedCube) {
    constexpr double width = 4.0;
    for (const double edge : {43.0, 44.5, 45.0, 45.5, 47.0}) {
        const scene::Scenario seam = scenario(wall(edge)), rotated = scenario(wall(edge - 45.0));
        for (const double azimuth : {43.0, 44.9, 45.1, 46.5}) {
            const auto slope = [&](double degrees) {
                return azimuth < 45.0 ? std::tan(degrees * degree) : -1.0 / std::tan(degrees * degree);
            };
            const double span = width * pixel;
            const double exact = std::clamp((slope(edge) - slope(azimuth)) / span + 0.5, 0.0, 1.0);
            const double across = visible(seam, lamp + at_azimuth(azimuth, 5.0), width);
            EXPECT_NEAR(across, exact, 0.02) << edge << " " << azimuth;
            const double middle = visible(rotated, lamp + at_azimuth(azimuth - 45.0, 5.0), 0.5 * width);
            EXPECT_NEAR(across, middle, 0.06) << edge << " " << azimuth;
        }
    }
}

// The camera of a room rarely looks in all directions from its lamp.
TEST(PointLight, SaysWhichFacesHaveReceivers) {
    scene::Scenario made = scenario(wall(0.0));
    made.receivers.points = {lamp + Vec3d(3, 1, 0), lamp + Vec3d(0, -3, 1), lamp + Vec3d(3, 0, 1)};
    const auto ask = [&](const scene::Light& light) {
        const rays::LightView view = rays::make_light_view(light, made.scene, made.rays.resolution, light.where);
        return scenario_queries(made, light, {}, view).queries.size();
    };
    EXPECT_EQ(ask(made.lights[0]), 2u);
    try {
        ask(made.lights[2]);
        FAIL() << "nothing would be measured in this face";
    } catch (const base::Error& error) {
        EXPECT_EQ(error.where(), "/receivers");
        EXPECT_NE(error.message().find("\"point_0 +y\"; give its light \"faces\": [\"+x\", \"-y\"]"), std::string::npos)
            << error.message();
    }
    made.receivers.points = {lamp + Vec3d(1e-9, 0, 0)};
    try {
        ask(made.lights[0]);
        FAIL() << "it is before the first depth of the map";
    } catch (const base::Error& error) {
        EXPECT_NE(error.message().find("nearer than its \"near\""), std::string::npos) << error.message();
    }
}

TEST(PointLight, SpreadsProbesOverTheFaceWithoutItsBorder) {
    const scene::Scenario made = scenario(wall(0.0));
    scene::Receivers receivers;
    receivers.count = 2000;
    const rays::LightView view =
        rays::make_light_view(made.lights[0], made.scene, made.rays.resolution, made.lights[0].where);
    const QuerySet set = probe_queries(receivers, view);
    EXPECT_EQ(set.dropped, 0u);
    for (const techniques::Query& q : set.queries) {
        const Vec3d world = rays::to_world(view, rays::unproject(view, q.x, q.y, q.z));
        const Vec3d away = world - lamp;
        EXPECT_LE(std::max(std::abs(away.y), std::abs(away.z)), away.x * (1.0 + 1e-5)) << "it belongs to a neighbour";
    }
}

// A map of 64 pixels with a border of 1/8: a pixel is 9/256 of slope, the face begins at pixel 32/9.
TEST(PointLight, CountsLookupsThatReachOverTheBorder) {
    const scene::Scenario made = scenario(wall(0.0));
    const rays::LightView view =
        rays::make_light_view(made.lights[0], made.scene, made.rays.resolution, made.lights[0].where);
    const auto cut = [&](const std::vector<techniques::Query>& queries) { return cut_at_seams(queries, view); };
    constexpr float infinite = std::numeric_limits<float>::infinity();
    EXPECT_EQ(cut({{4.0f, 32.0f, 5.0f, 8.0f}, {32.0f, 60.0f, 5.0f, 8.0f}, {32.0f, 32.0f, 5.0f, 64.0f}}).count, 0u);
    EXPECT_EQ(cut({{32.0f, 32.0f, 5.0f, infinite}}).count, 0u);
    // Slopes -9/8 - 2 pixels, and 9/8 + 12 pixels.
    const CutLookups over = cut({{4.0f, 32.0f, 5.0f, 12.0f}, {32.0f, 32.0f, 5.0f, 8.0f}, {32.0f, 60.0f, 5.0f, 32.0f}});
    EXPECT_EQ(over.count, 2u);
    EXPECT_NEAR(over.border, 0.125 + 12.0 * 9.0 / 256.0, 1e-12);
    EXPECT_NEAR(cut({{4.0f, 32.0f, 5.0f, 12.0f}}).border, 0.125 + 2.0 * 9.0 / 256.0, 1e-12);
}

// The widths of lookups in receiver pixels are known only where they are asked for.
TEST(PointLight, RunsNoteABorderThatIsTooNarrowForReceiverPixels) {
    const auto notes = [](double pixels, const nlohmann::json& sweeps = nlohmann::json::object()) {
        // A floor 2 below the lamp, in its face -y, of which a camera 5 above sees slopes to 0.91, in pixels of 0.11.
        nlohmann::json document{{"name", "lamp"}, {"techniques", {{{"type", "deep"}}}}};
        document["scene"]["objects"] = {
            {{"type", "quad"}, {"corner", {-1.9, -2, -1.9}}, {"edge_u", {3.8, 0, 0}}, {"edge_v", {0, 0, 3.8}}}};
        document["lights"] = {{{"type", "point"}, {"position", {0, 0, 0}}, {"faces", {"-y"}}, {"border", border}}};
        document["rays"] = {{"resolution", resolution}};
        document["receivers"] = {{"type", "camera"},
                                 {"position", {0, 3, 0.1}},
                                 {"target", {0, -2, 0}},
                                 {"resolution", {16, 16}},
                                 {"footprint", {{"receiver_pixels", pixels}}}};
        document["sweeps"] = sweeps;
        VariantRuns runs(document, {});
        runs.load(runs.variants().size() - 1, {});
        return runs.seam_notes();
    };
    EXPECT_TRUE(notes(0.1).empty());
    ASSERT_EQ(notes(8.0).size(), 1u);
    EXPECT_NE(notes(8.0)[0].find("/lights/0: "), std::string::npos);
    EXPECT_NE(notes(8.0)[0].find("reach over the border of their map"), std::string::npos);
    EXPECT_NE(notes(8.0)[0].find("with a border of "), std::string::npos);
    // Otherwise nobody knows which variant of a sweep to change.
    const std::vector<std::string> of_last = notes(8.0, {{"/receivers/footprint/receiver_pixels", {4, 9}}});
    EXPECT_NE(of_last.at(0).find("/lights/0, /receivers/footprint/receiver_pixels = 9: "), std::string::npos);
    EXPECT_EQ(notes(8.0, {{"/reference/seed", {1, 2}}}), notes(8.0)) << "a note that all share is one";
}

}  // namespace
}  // namespace shadowbench::bench
