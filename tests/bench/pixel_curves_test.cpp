#include "bench/pixel_curves.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include <nlohmann/json.hpp>

#include "bench/functions.h"
#include "bench/one_light.h"
#include "document/technique_choice.h"
#include "errors.h"
#include "rays/capture.h"

namespace shadowbench::bench {
namespace {

using nlohmann::json;

// Half of the map is under a quad of three opacities, with hair and a medium over the rest; several tiles.
json scene_of(const json& techniques, const char* more = "[]") {
    json document = json::parse(R"({
        "name": "probe",
        "scene": {"objects": [
            {"type": "quad", "corner": [-1, 0.5, -1], "edge_u": [0, 0, 2], "edge_v": [1, 0, 0], "opacity": 0.5},
            {"type": "quad", "corner": [-1, 0, -1], "edge_u": [0, 0, 2], "edge_v": [2, 0, 0], "opacity": 0.25},
            {"type": "hair_ball", "strands": 300, "segments": 4, "centre": [0, -1, 0], "ball_radius": 0.8,
             "length": 0.3, "radius": 0.01, "opacity": 0.6}]},
        "lights": [{"type": "directional", "name": "sun", "direction": [0, -1, 0]}],
        "rays": {"resolution": 48, "samples_per_pixel": 16},
        "receivers": {"type": "probes", "count": 10}
    })");
    for (const json& object : json::parse(more)) document["scene"]["objects"].push_back(object);
    document["techniques"] = techniques;
    return document;
}

json every_technique() {
    json list = json::array();
    for (const techniques::Technique& row : techniques::all()) list.push_back({{"type", row.id}});
    return list;
}

// The oracle's transmittance of the pixel at these depths: the mean over its rays.
std::vector<double> oracle(const OneLight& light, int x, int y, const std::vector<float>& depths) {
    std::vector<double> sums(depths.size());
    int count = 0;
    light.for_each_batch(
        [&](RaySource::Batch batch) {
            for (const rays::LightRays& tile : batch) {
                if (x < tile.x0 || y < tile.y0 || x >= tile.x0 + tile.width || y >= tile.y0 + tile.height) continue;
                const std::size_t pixel = static_cast<std::size_t>((y - tile.y0) * tile.width + x - tile.x0);
                const std::size_t samples = static_cast<std::size_t>(tile.samples);
                for (std::size_t s = 0; s < samples; ++s, ++count)
                    for (std::size_t i = 0; i < depths.size(); ++i)
                        sums[i] += rays::transmittance(tile, pixel * samples + s, 0, depths[i]);
            }
        },
        {});
    EXPECT_GT(count, 0);
    for (double& sum : sums) sum /= count;
    return sums;
}

std::vector<float> even_depths(const PixelCurves& curves) {
    std::vector<float> depths;
    for (int i = 0; i <= 40; ++i)
        depths.push_back(static_cast<float>(curves.z_min + (curves.z_max - curves.z_min) * i / 40.0));
    return depths;
}

void expect_exact(const OneLight& light, const PixelCurves& curves, double within) {
    const std::vector<float> depths = even_depths(curves);
    const std::vector<double> truth = oracle(light, curves.x, curves.y, depths);
    for (std::size_t i = 0; i < depths.size(); ++i)
        EXPECT_NEAR(curves::evaluate(curves.exact[0], depths[i]), truth[i], within)
            << curves.x << " " << curves.y << " " << depths[i];
}

TEST(PixelCurves, the_exact_one_agrees_with_the_oracle) {
    const json document = scene_of(json::array({{{"type", "uncompressed"}}}));
    PixelProbe probe(document, {}, "", 0);
    const OneLight light(document, {}, "");
    for (const auto& [x, y] : {std::pair(0, 0), std::pair(47, 47), std::pair(20, 24)}) {
        const PixelCurves curves = probe.at(x, y);
        EXPECT_EQ(curves.rays, 16);
        ASSERT_EQ(curves.exact.size(), 1u);
        expect_exact(light, curves, 1e-5);
    }
}

// A technique must store the same functions if it is given only one tile.
TEST(PixelCurves, are_those_of_the_whole_map) {
    const json document = scene_of(every_technique());
    PixelProbe probe(document, {}, "sun", 0);
    const OneLight light(document, {}, "sun");
    ASSERT_GT(light.layout().tiles(), 1);
    const PixelCurves curves = probe.at(33, 24);
    ASSERT_EQ(curves.curves.size(), techniques::all().size());
    for (const TechniqueCurve& curve : curves.curves) {
        if (!curve.absent.empty()) continue;
        const Contender whole = light.build(document::read_any_technique(curve.technique), {});
        const std::vector<float> depths = even_depths(curves);
        const int nx = curve.cells == techniques::Cells::sample ? 4 : 1;
        std::vector<double> mean(depths.size());
        for (int sy = 0; sy < nx; ++sy)
            for (int sx = 0; sx < nx; ++sx) {
                curves::Curve stored_curve;
                stored(whole.maps, 33 * nx + sx, 24 * nx + sy, 0, depths, stored_curve);
                for (std::size_t i = 0; i < depths.size(); ++i)
                    mean[i] += curves::evaluate(stored_curve, depths[i]) / static_cast<double>(nx * nx);
            }
        for (std::size_t i = 0; i < depths.size(); ++i)
            EXPECT_NEAR(curves::evaluate(curve.channels[0], depths[i]), mean[i], 0.02)
                << curve.technique << " " << depths[i];
    }
}

TEST(PixelCurves, of_a_technique_keep_its_promised_bound) {
    PixelProbe probe(scene_of(json::array({{{"type", "deep"}, {"tolerance", 0.02}}, {{"type", "uncompressed"}}})), {},
                     "", 0);
    std::uint64_t nodes = 0;
    for (int x = 3; x < 48; x += 11) {
        const PixelCurves curves = probe.at(x, 25);
        EXPECT_LE(curves.curves[0].error_max, 0.02 + 1e-5);
        nodes += curves.curves[0].nodes;
        EXPECT_LE(curves.curves[1].error_max, 1e-5) << "every segment is kept";
        EXPECT_EQ(curves.curves[0].title, "deep tolerance=0.02");
    }
    EXPECT_GT(nodes, 0u);
}

TEST(PixelCurves, a_technique_without_functions_says_so) {
    PixelProbe probe(scene_of(json::array({{{"type", "ray_traced"}}, {{"type", "deep"}}})), {}, "", 0);
    const nlohmann::ordered_json out = to_json(probe.at(1, 2));
    EXPECT_EQ(out["curves"][0]["absent"], "stores no function");
    EXPECT_FALSE(out["curves"][0].contains("z"));
    EXPECT_EQ(out["curves"][1]["z"].size(), out["curves"][1]["v"].size());
    EXPECT_EQ(out["curves"][1]["z"].front(), out["z_min"]);
    EXPECT_EQ(out["curves"][1]["z"].back(), out["z_max"]);
    EXPECT_EQ(out["x"], 1);
    EXPECT_EQ(out["y"], 2);
    EXPECT_FALSE(out["exact"].contains("channels")) << "one channel";
}

TEST(PixelCurves, of_coloured_light_rays_have_three_channels) {
    const json document =
        scene_of(json::array({{{"type", "deep"}, {"tolerance", 0.01}}, {{"type", "avsm"}}}),
                 R"([{"type": "sphere", "centre": [0, 2, 0], "radius": 0.7, "opacity": [0.1, 0.5, 0.9]}])");
    PixelProbe probe(document, {}, "", 0);
    const PixelCurves curves = probe.at(24, 24);
    ASSERT_EQ(curves.exact.size(), 3u);
    const float behind = static_cast<float>(curves.z_max);
    EXPECT_GT(curves::evaluate(curves.exact[0], behind), curves::evaluate(curves.exact[2], behind));
    ASSERT_EQ(curves.curves[0].channels.size(), 3u);
    EXPECT_LE(curves.curves[0].error_max, 0.01 + 1e-5) << "of the worst channel";
    EXPECT_EQ(to_json(curves)["exact"]["channels"].size(), 3u);
}

TEST(PixelCurves, of_media_join_the_exponential_closely) {
    const json document =
        scene_of(json::array({{{"type", "uncompressed"}}}),
                 R"([{"type": "density_box", "lower": [-1, -3, -1], "upper": [1, -2, 1], "extinction": 2}])");
    PixelProbe probe(document, {}, "", 0);
    const OneLight light(document, {}, "");
    const PixelCurves curves = probe.at(24, 24);
    expect_exact(light, curves, 2e-4);
}

TEST(PixelCurves, refuse_places_lights_and_variants_that_do_not_exist) {
    json document = scene_of(json::array({{{"type", "deep"}}}));
    PixelProbe probe(document, {}, "0", 0);
    const auto refused = [](const auto& action, const std::string& where) {
        EXPECT_NE(test::error_of(action, base::ErrorCode::usage, where), "");
    };
    refused([&] { probe.at(-1, 0); }, "(-1, 0)");
    refused([&] { probe.at(0, -1); }, "(0, -1)");
    refused([&] { probe.at(48, 0); }, "(48, 0)");
    refused([&] { probe.at(0, 48); }, "(0, 48)");
    refused([&] { PixelProbe(document, {}, "moon", 0); }, "light=moon");
    refused([&] { PixelProbe(document, {}, "", 1); }, "variant=1");
    refused([&] { check_light(document, "moon", 0); }, "light=moon");
    refused([&] { check_light(document, "1", 0); }, "light=1");
    refused([&] { check_light(document, "", 1); }, "variant=1");
    for (const char* light : {"", "0", "sun"}) EXPECT_NO_THROW(check_light(document, light, 0)) << light;
    document["sweeps"] = {{"/rays/samples_per_pixel", {4, 9}}};
    EXPECT_EQ(PixelProbe(document, {}, "", 1).at(0, 0).rays, 9);
}

}  // namespace
}  // namespace shadowbench::bench
