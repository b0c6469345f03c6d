#include "render/render.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "render/exposure.h"
#include "render/shading.h"
#include "render/write_pictures.h"
#include "temporary_folder.h"

namespace shadowbench::render {
namespace {

namespace fs = std::filesystem;
using base::Vec3f;
using nlohmann::json;

// Seen vertically from above: an opaque quad over the left half (x < 0) of a plane, one unit above it; the light comes
// at 45 degrees, so that the shadow falls on x in [-2, 0] moved by one: [-1, 1].
json quad_over_plane() {
    return json::parse(R"({
        "name": "edge",
        "scene": {"objects": [
            {"type": "quad", "corner": [-2, 1, -2], "edge_u": [0, 0, 4], "edge_v": [2, 0, 0]},
            {"type": "quad", "corner": [-3, 0, -3], "edge_u": [0, 0, 6], "edge_v": [6, 0, 0], "casts_shadow": false}]},
        "lights": [{"type": "directional", "direction": [1, -1, 0]}],
        "rays": {"resolution": 256, "samples_per_pixel": 4},
        "receivers": {"type": "camera", "position": [0, 100, 0], "target": [0, 0, 0], "up": [0, 0, -1], "fov": 3,
                      "resolution": [80, 40], "bias": 0.01},
        "reference": {"samples_per_pixel": 16, "queries": 10},
        "techniques": [{"type": "shadow_map"}, {"type": "uncompressed"}]})");
}

// World x of pixel column x on the plane y.
double world_x(double x, double y) {
    const double half = std::tan(1.5 * 3.14159265358979 / 180.0) * (100.0 - y);
    return (x + 0.5 - 40.0) / 20.0 * half;
}

// All surfaces face up, as the fill does: it adds the same to the shadow and to the light, and no map is made for it.
TEST(Render, adds_lights_that_cast_no_shadow) {
    json document = quad_over_plane();
    document["receivers"]["resolution"] = {40, 20};
    const Rendering without = render(document, {}, {});
    document["lights"].push_back(
        {{"type", "directional"}, {"direction", {0, -1, 0}}, {"colour", 0.5}, {"casts_shadow", false}});
    const Rendering with = render(document, {}, {});
    ASSERT_EQ(with.lights.size(), 1u);
    for (const auto& [more, less] : {std::pair(&with.reference, &without.reference),
                                     std::pair(&with.techniques[1].picture, &without.techniques[1].picture)})
        for (std::size_t p = 0; p < with.seen.size(); ++p) {
            const float shadow = 1.0f - less->shadow.pixels[p].y;
            EXPECT_NEAR(more->shaded.pixels[p].y, less->shaded.pixels[p].y + 0.5 * surface_albedo * with.seen[p], 1e-6);
            EXPECT_NEAR(more->shadow.pixels[p].y, 1.0f - 0.5f * shadow, 1e-6) << "half of the lights are shadowed";
        }
}

// The seam of two faces runs along x = 0 of the plane. A spot light at the same place has no seam.
TEST(Render, lights_every_place_by_one_face_of_a_point_light) {
    json document = quad_over_plane();
    document["receivers"]["resolution"] = {41, 21};
    document["rays"] = {{"resolution", 128}, {"samples_per_pixel", 1}};
    document["techniques"] = {{{"type", "ray_traced"}}};
    document["lights"] = {{{"type", "spot"}, {"position", {-4, 4, 0.25}}, {"target", {0, 0, 0}}}};
    const Rendering spot = render(document, {}, {});
    document["lights"] = {{{"type", "point"}, {"position", {-4, 4, 0.25}}}};
    const Rendering point = render(document, {}, {});
    EXPECT_EQ(point.lights.size(), 6u);
    std::size_t lit = 0, shadowed = 0, other = 0;
    for (std::size_t p = 0; p < point.seen.size(); ++p) {
        const float expected = spot.reference.shadow.pixels[p].y;
        if (expected > 0.0f && expected < 1.0f) continue;  // an edge, where the footprints of the maps differ
        ++(expected > 0.0f ? lit : shadowed);
        other += std::abs(point.reference.shadow.pixels[p].y - expected) > 1e-4f ||
                 std::abs(point.reference.shaded.pixels[p].y - spot.reference.shaded.pixels[p].y) > 1e-4f;
    }
    EXPECT_GT(lit, 300u);
    EXPECT_GT(shadowed, 50u);
    EXPECT_LT(other, 12u) << "only where the edge of the shadow lies between the footprints";
}

TEST(Render, puts_the_edge_of_a_shadow_where_geometry_says) {
    const Rendering result = render(quad_over_plane(), {}, {});
    const double lit = surface_albedo * std::sqrt(0.5);
    int compared = 0;
    for (int y = 6; y < 34; ++y)
        for (int x = 0; x < 80; ++x) {
            const double plane = world_x(x, 0.0), quad = world_x(x, 1.0);
            if (std::abs(plane) > 2.95 || std::abs(plane - 1.0) < 0.15 || std::abs(quad) < 0.1) continue;
            if (std::abs(quad + 2.0) < 0.1 || std::abs(plane + 1.0) < 0.15) continue;
            const bool on_quad = quad > -2.0 && quad < 0.0, shadowed = !on_quad && plane > -1.0 && plane < 1.0;
            for (const Picture* picture :
                 {&result.reference, &result.techniques[0].picture, &result.techniques[1].picture}) {
                EXPECT_NEAR(picture->shaded.at(x, y).y, shadowed ? 0.0 : lit, 1e-3) << x << " " << y;
                EXPECT_NEAR(picture->shadow.at(x, y).y, shadowed ? 0.0 : 1.0, 1e-3) << x << " " << y;
            }
            ++compared;
        }
    EXPECT_GT(compared, 800);
    EXPECT_LT(result.techniques[1].shadow.rms, 0.1);
    EXPECT_LT(result.techniques[1].shaded.flip_mean, 0.05);
}

TEST(Render, leaves_the_background_black_and_lit) {
    json document = quad_over_plane();
    document["receivers"]["fov"] = 12;  // the plane's border and beyond
    const Rendering result = render(document, {}, {});
    EXPECT_EQ(result.reference.shaded.at(0, 0), Vec3f(0.0f));
    EXPECT_EQ(result.reference.shadow.at(0, 0), Vec3f(1.0f));
    EXPECT_EQ(result.techniques[0].picture.shaded.at(79, 39), Vec3f(0.0f));
}

// A slab of extinction 1.5 and thickness 2 seen and lit from above: light that reaches depth s is exp(-1.5 s), and so
// is what the eye sees of it; in-scattering is albedo / 2 (1 - exp(-2 * 1.5 * 2)).
TEST(Render, of_a_uniform_slab_meets_the_closed_form_of_single_scattering) {
    // A box of constant density, as a raw volume.
    const TemporaryFolder temporary;
    const fs::path folder = temporary.path();
    std::ofstream(folder / "ones.raw", std::ios::binary) << std::string(8, '\xff');
    json slab = {{"name", "slab"}, {"lights", {{{"type", "directional"}, {"direction", {0, -1, 0}}}}}};
    slab["scene"]["objects"] = json::parse(R"([{"type": "volume", "file": "ones.raw", "format": "uint8",
        "size": [2, 2, 2], "lower": [-5, 0, -5], "upper": [5, 2, 5], "extinction": [1.5, 0.5, 1.5], "step": 0.01}])");
    slab["rays"] = {{"resolution", 16}, {"samples_per_pixel", 1}};
    slab["receivers"] = json::parse(R"({"type": "camera", "position": [0, 500, 0], "target": [0, 0, 0],
        "up": [0, 0, -1], "fov": 0.2, "resolution": [4, 4]})");
    slab["reference"] = {{"samples_per_pixel", 4}, {"queries", 10}};
    slab["techniques"] = {{{"type", "uncompressed"}}};
    RenderOptions options;
    options.run.data = {folder};
    options.media_lookups = 256;
    const Rendering result = render(slab, options, {});
    const double red = medium_albedo * 0.5 * (1.0 - std::exp(-6.0)),
                 green = medium_albedo * 0.5 * (1.0 - std::exp(-2.0));
    for (const Picture* picture : {&result.reference, &result.techniques[0].picture})
        for (const Vec3f& pixel : picture->shaded.pixels) {
            EXPECT_NEAR(pixel.x, red, 1e-3);
            EXPECT_NEAR(pixel.y, green, 1e-3);
        }
    // The light that shadows take: coverage minus in-scattering.
    EXPECT_NEAR(result.reference.shadow.at(1, 1).x, 1.0 - (1.0 - std::exp(-3.0)) + 0.5 * (1.0 - std::exp(-6.0)), 1e-3);
}

// Three translucent layers and a floor, each lit through those above it, seen and lit from straight above: layer i is
// seen through what is above it and lit through the same.
TEST(Render, composites_a_stack_of_layers_as_in_the_closed_form) {
    const std::vector<Vec3f> opacities{{0.1f, 0.3f, 0.02f}, {0.49f, 0.2f, 1.0f}, {0.3f, 0.6f, 0.0f}, {1, 1, 1}};
    json document = quad_over_plane();
    json& objects = document["scene"]["objects"] = json::array();
    for (std::size_t i = 0; i < opacities.size(); ++i)
        objects.push_back({{"type", "quad"},
                           {"corner", {-4, 1.0 - 0.25 * static_cast<double>(i), -4}},
                           {"edge_u", {0, 0, 8}},
                           {"edge_v", {8, 0, 0}},
                           {"opacity", {opacities[i].x, opacities[i].y, opacities[i].z}}});
    document["lights"] = json::parse(R"([{"type": "directional", "direction": [0, -1, 0]}])");
    document["rays"]["resolution"] = 16;
    document["receivers"]["resolution"] = {8, 6};
    for (const std::size_t layers : {std::size_t{4}, std::size_t{3}}) {
        if (layers == 3) objects.erase(3);
        const Rendering result = render(document, {}, {});
        EXPECT_EQ(result.points, 8u * 6 * layers);
        for (int c = 0; c < 3; ++c) {
            double left = 1.0, shaded = 0.0, taken = 0.0;
            for (std::size_t i = 0; i < layers; ++i) {
                const double opacity = opacities[i][c];
                shaded += left * opacity * surface_albedo * left;
                taken += left * opacity * (1.0 - left);
                left *= 1.0 - opacity;
            }
            for (const Picture* picture : {&result.reference, &result.techniques[1].picture})
                for (std::size_t p = 0; p < 48; ++p) {
                    EXPECT_NEAR(picture->shaded.pixels[p][c], shaded, 1e-5) << c;
                    EXPECT_NEAR(picture->shadow.pixels[p][c], 1.0 - taken, 1e-5) << c;
                }
            EXPECT_LT(result.techniques[1].shaded.max, 1e-5);
        }
    }
}

// An error of a technique behind a faint layer shows in its picture in proportion to the layer's transmittance.
TEST(Render, shows_errors_through_the_layers_before_them) {
    json document = quad_over_plane();
    document["scene"]["objects"][0]["opacity"] = 0.4;  // a shadow map takes it as opaque
    const Rendering result = render(document, {}, {});
    const auto column = [](double x) {
        return static_cast<int>(40.0 + 20.0 * x / (std::tan(1.5 * 3.14159265 / 180) * 100));
    };
    const double lit = surface_albedo * std::sqrt(0.5);
    const Picture& wrong = result.techniques[0].picture;
    // At -0.5 the plane lies in the quad's shadow and behind the quad; at 0.5 only in its shadow.
    EXPECT_NEAR(result.reference.shaded.at(column(-0.5), 20).x, lit * (0.4 + 0.6 * 0.6), 1e-3);
    EXPECT_NEAR(wrong.shaded.at(column(-0.5), 20).x, lit * 0.4, 1e-3);
    EXPECT_NEAR(difference_times_four(wrong.shaded, result.reference.shaded).at(column(-0.5), 20).x, 4 * lit * 0.36,
                4e-3);
    EXPECT_NEAR(pixel_errors(wrong.shadow, result.reference.shadow)[static_cast<std::size_t>(20 * 80 + column(-0.5))],
                0.36, 1e-3);
    EXPECT_NEAR(wrong.shaded.at(column(0.5), 20).x, 0.0, 1e-3);
    EXPECT_NEAR(result.reference.shaded.at(column(0.5), 20).x, lit * 0.6, 1e-3);
}

TEST(Render, adds_the_lights_in_their_colours) {
    json document = quad_over_plane();
    document["lights"] = json::parse(R"([{"type": "directional", "direction": [1, -1, 0], "colour": [1, 0, 0]},
                                         {"type": "directional", "direction": [-1, -1, 0], "colour": [0, 0.5, 0]}])");
    const Rendering result = render(document, {}, {});
    const double lit = surface_albedo * std::sqrt(0.5);
    const auto column = [](double x) {
        return static_cast<int>(40.0 + 20.0 * x / (std::tan(1.5 * 3.14159265 / 180) * 100));
    };
    // The second light's shadow falls on [-3, -1]; x = 0.5 is only in the first one's.
    const Vec3f pixel = result.techniques[0].picture.shaded.at(column(0.5), 20);
    EXPECT_NEAR(pixel.x, 0.0, 1e-3);
    EXPECT_NEAR(pixel.y, 0.5 * lit, 1e-3);
    EXPECT_NEAR(result.techniques[0].picture.shadow.at(column(0.5), 20).x, 0.5, 1e-3);
    EXPECT_NEAR(result.techniques[0].picture.shaded.at(column(2.0), 20).x, lit, 1e-3);
}

// Four columns of view rays a pixel: what a pixel shows is the share of its rays that are not shadowed.
TEST(Render, with_more_view_rays_a_pixel_averages_them) {
    RenderOptions coarse, fine;
    coarse.size = base::Vec2i(20, 10);
    coarse.rays_per_side = 4;
    fine.size = base::Vec2i(80, 40);
    const Rendering few = render(quad_over_plane(), coarse, {}), many = render(quad_over_plane(), fine, {});
    for (int y = 0; y < 10; ++y)
        for (int x = 0; x < 20; ++x) {
            double shaded = 0.0, shadow = 0.0;
            for (int j = 0; j < 4; ++j)
                for (int i = 0; i < 4; ++i) {
                    shaded += many.reference.shaded.at(4 * x + i, 4 * y + j).y / 16.0;
                    shadow += many.reference.shadow.at(4 * x + i, 4 * y + j).y / 16.0;
                }
            ASSERT_NEAR(few.reference.shaded.at(x, y).y, shaded, 1e-6) << x << " " << y;
            ASSERT_NEAR(few.reference.shadow.at(x, y).y, shadow, 1e-6) << x << " " << y;
        }
    EXPECT_EQ(few.points, many.points);
}

// The picture of four lookups a pixel, from little more than one.
TEST(Render, with_joined_lookups_shows_the_same_from_fewer) {
    RenderOptions apart;
    apart.rays_per_side = 2;
    RenderOptions joined = apart;
    joined.joined = true;
    const Rendering all = render(quad_over_plane(), apart, {}), few = render(quad_over_plane(), joined, {});
    EXPECT_GE(4 * few.points, all.points);
    EXPECT_LT(static_cast<double>(4 * few.points), 1.2 * static_cast<double>(all.points));
    // One lookup for four that disagree errs by at most 3/4 of the light; four that agree are answered as before.
    std::size_t split = 0;
    for (const base::Vec3f& shadow : all.reference.shadow.pixels) split += shadow.y > 1e-6f && shadow.y < 1.0f - 1e-6f;
    EXPECT_LT(compare(few.reference.shaded, all.reference.shaded).rms,
              0.75 * std::sqrt(static_cast<double>(split) / static_cast<double>(all.reference.shadow.pixels.size())));
    std::size_t mixed = 0;
    for (int y = 12; y < 28; ++y)
        for (int x = 0; x < 80; ++x) {
            const float expected = all.reference.shaded.at(x, y).y;
            const double plane = world_x(x, 0.0), quad = world_x(x, 1.0);
            if (std::abs(plane) > 2.9 || std::min(std::abs(plane - 1.0), std::abs(plane + 1.0)) < 0.15) continue;
            EXPECT_NEAR(few.reference.shaded.at(x, y).y, expected, 1e-4 * expected + 1e-6) << x << " " << y;
            mixed += std::abs(quad) < 0.1 || std::abs(quad + 2.0) < 0.1;
        }
    EXPECT_GT(mixed, 20u) << "edges, where a pixel sees two surfaces, were compared too";
}

TEST(Render, enlarges_a_small_picture_in_its_proportions) {
    EXPECT_EQ(enlarged({256, 192}), base::Vec2i(512, 384));
    EXPECT_EQ(enlarged({384, 288}), base::Vec2i(512, 384));
    EXPECT_EQ(enlarged({600, 20}), base::Vec2i(600, 20));
    EXPECT_EQ(enlarged({1, 8192}), base::Vec2i(1, 8192)) << "not 4 million pixels high";
    EXPECT_EQ(enlarged({100, 1000}), base::Vec2i(102, 1024));
    EXPECT_EQ(enlarged({300, 1}), base::Vec2i(512, 2));
    EXPECT_EQ(enlarged({16, 12}), base::Vec2i(128, 96)) << "few pixels are meant to be quick";
    RenderOptions options = usual_options({});
    options.rays_per_side = 1;
    json document = quad_over_plane();
    document["rays"]["resolution"] = 16;
    EXPECT_EQ(render(document, options, {}).size, base::Vec2i(512, 256));
    options.size = base::Vec2i(30, 20);
    EXPECT_EQ(render(document, options, {}).size, base::Vec2i(30, 20)) << "as asked";
}

// On a plane seen obliquely, the edges lead from one view ray's point to those of its neighbours.
TEST(ShadingPoints, have_the_edges_of_a_view_rays_footprint) {
    scene::Mesh plane;
    plane.positions = {{-50, 0, -50}, {-50, 0, 50}, {50, 0, 50}, {50, 0, -50}};
    plane.triangles = {{0, 1, 2}, {0, 2, 3}};
    scene::Object object;
    object.shape = plane;
    scene::Scene scene;
    scene.objects.push_back(object);
    ViewSettings settings;
    settings.camera.position = {0, 6, 8};
    settings.camera.fov = 1.0;
    settings.size = {8, 8};
    settings.rays_per_side = 2;
    const std::vector<scene::Light> lights(1);
    const ShadingPoints points = find_shading_points(scene, lights, settings, rays::Tracer(scene, false), {});
    ASSERT_EQ(points.points(), 8u * 8 * 4);
    for (std::size_t pixel = 0; pixel < 64; ++pixel) {
        const std::size_t first = 4 * pixel;  // the second is to its right, the third below it
        const base::Vec3d right = points.place[first + 1] - points.place[first];
        const base::Vec3d down = points.place[first + 2] - points.place[first];
        EXPECT_NEAR((base::Vec3d(points.across[first]) - right).length(), 0.0, 0.01 * right.length());
        EXPECT_NEAR((base::Vec3d(points.down[first]) - down).length(), 0.0, 0.01 * down.length());
        EXPECT_NEAR(points.coverage[first].x, 0.25, 1e-6);
    }
}

TEST(ShadingPoints, say_what_share_of_a_pixel_shows_something) {
    ShadingPoints points;
    points.begin = {0, 2, 2, 3};  // two points, none, and one
    points.coverage = {base::Vec3f(0.25f), base::Vec3f(0.5f, 0.25f, 0.0f), base::Vec3f(0.6f, 0.9f, 0.0f)};
    points.place.resize(3);
    EXPECT_EQ(seen_shares(points), (std::vector<float>{0.5f, 0.0f, 0.5f}));
}

TEST(Render, is_the_same_on_one_thread_and_on_two) {
    std::ifstream file(std::string(SHADOWBENCH_SOURCE_DIR) + "/scenarios/quickstart.json");
    json document = json::parse(file);
    document["rays"]["resolution"] = 32;
    document["receivers"]["resolution"] = {32, 24};
    document["reference"]["samples_per_pixel"] = 16;
    document["scene"]["objects"][0]["strands"] = 300;
    RenderOptions one, two;
    one.run.threads = 1;
    two.run.threads = 2;
    const Rendering a = render(document, one, {}), b = render(document, two, {});
    EXPECT_EQ(to_json(a), to_json(b));
    EXPECT_EQ(a.reference.shaded.pixels, b.reference.shaded.pixels);
    for (std::size_t t = 0; t < a.techniques.size(); ++t) {
        EXPECT_EQ(a.techniques[t].picture.shaded.pixels, b.techniques[t].picture.shaded.pixels);
        EXPECT_EQ(a.techniques[t].picture.shadow.pixels, b.techniques[t].picture.shadow.pixels);
    }
    EXPECT_LT(a.techniques.back().shadow.rms, a.techniques.front().shadow.rms) << "ray_traced against shadow_map";
}

// Where a camera sees a place: 1 at the right and upper border of its picture.
base::Vec2d seen_at(const scene::Camera& camera, double aspect, const base::Vec3d& place) {
    const base::Vec3d forward = (camera.target - camera.position).normalized();
    const base::Vec3d right = forward.cross(camera.up).normalized(), up = right.cross(forward);
    const base::Vec3d p = place - camera.position;
    const double half = std::tan(0.5 * camera.fov * 3.14159265358979 / 180.0) * p.dot(forward);
    return {p.dot(right) / (half * aspect), p.dot(up) / half};
}

// The quad and its shadow, which falls beside it. A camera of the casters alone would show neither whole.
TEST(Render, finds_a_camera_that_sees_the_casters_and_their_shadows_large) {
    json document = quad_over_plane();
    document["receivers"] = {{"type", "probes"}, {"bias", 0.01}};
    RenderOptions options;
    options.size = base::Vec2i(60, 40);
    const Rendering result = render(document, options, {});
    EXPECT_TRUE(result.default_camera);
    EXPECT_EQ(result.size, base::Vec2i(60, 40));
    double furthest = 0.0;
    for (const double x : {-2.0, 0.0})
        for (const double z : {-2.0, 2.0})
            for (const base::Vec3d& place : {base::Vec3d(x, 1, z), base::Vec3d(x + 1.0, 0, z)}) {
                const base::Vec2d at = seen_at(result.camera, 1.5, place);
                furthest = std::max({furthest, std::abs(at.x), std::abs(at.y)});
            }
    EXPECT_LE(furthest, 0.93);
    EXPECT_GE(furthest, 0.91);
    std::size_t dark = 0;
    for (const Vec3f& pixel : result.reference.shadow.pixels) dark += pixel.y < 0.5f;
    EXPECT_GT(dark, 60u * 40 / 20) << "the shadow is seen";
}

base::Error error_of(const json& document, const RenderOptions& options) {
    try {
        render(document, options, {});
    } catch (const base::Error& error) {
        return error;
    }
    ADD_FAILURE() << "no error";
    return {base::ErrorCode::internal, "", ""};
}

TEST(Render, refuses_a_camera_that_sees_nothing) {
    json document = quad_over_plane();
    document["receivers"]["target"] = {0, 200, 0};
    EXPECT_EQ(error_of(document, {}).where(), "/receivers");
}

TEST(Render, refuses_more_points_than_memory_holds_before_it_looks_up) {
    RenderOptions options;
    options.run.limits.all = std::size_t{1} << 20;
    options.size = base::Vec2i(400, 400);
    EXPECT_EQ(error_of(quad_over_plane(), options).where(), "/receivers/resolution");
}

TEST(Render, takes_the_first_values_of_sweeps_and_says_so) {
    json document = quad_over_plane();
    document["sweeps"] = {{"/rays/samples_per_pixel", {1, 4}}};
    const Rendering result = render(document, {}, {});
    ASSERT_EQ(result.settings.size(), 1u);
    EXPECT_EQ(result.settings[0].value, "1");
    EXPECT_NE(to_table(result).find("samples_per_pixel = 1"), std::string::npos);
}

TEST(WritePictures, writes_exactly_the_files_that_images_json_names) {
    json document = quad_over_plane();
    document["techniques"].push_back({{"type", "uncompressed"}});
    const Rendering result = render(document, {}, {});
    const TemporaryFolder temporary;
    const fs::path folder = temporary.path();
    write_pictures(folder, result);
    std::ifstream stream(folder / "images.json");
    const json written = json::parse(stream);
    std::set<std::string> named{"images.json"}, found;
    for (const std::string name : written["reference"]["files"]) named.insert(name);
    for (const char* several : {"techniques", "lights"})
        for (const json& entry : written[several])
            for (const std::string name : entry["files"]) named.insert(name);
    for (const auto& entry : fs::directory_iterator(folder)) {
        found.insert(entry.path().filename().string());
        EXPECT_GT(entry.file_size(), 0u) << entry.path();
    }
    EXPECT_EQ(found, named);
    EXPECT_EQ(found.size(), 1u + 4 + 2 + 3 * 8);
    EXPECT_TRUE(found.contains("uncompressed_2.heat.png"));
    EXPECT_EQ(written["techniques"][1]["shadow"]["rms"], result.techniques[1].shadow.rms);
    EXPECT_EQ(written["techniques"][0]["status"], "ok");
    EXPECT_EQ(written["exposure"], exposure_of(result.reference.shaded, result.seen));
    EXPECT_EQ(written["lights"][0]["map"], json({256, 256}));
}

TEST(Compare, measures_difference_in_linear_values) {
    Image a({4, 2}, Vec3f(0.5f)), b = a;
    b.at(1, 1) = Vec3f(0.5f, 0.2f, 0.8f);
    const PictureErrors errors = compare(b, a);
    EXPECT_NEAR(errors.max, 0.3, 1e-6);
    EXPECT_NEAR(errors.rms, std::sqrt(2 * 0.09 / 24), 1e-6);
    EXPECT_GT(errors.flip_max, 0.0);
    const Image difference = difference_times_four(b, a);
    EXPECT_NEAR(difference.at(1, 1).y, 1.2, 1e-6);
    EXPECT_EQ(difference.at(0, 0), Vec3f(0.0f));
    EXPECT_NEAR(pixel_errors(b, a)[5], 0.2, 1e-6);
}

}  // namespace
}  // namespace shadowbench::render
