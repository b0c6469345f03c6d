#include "kernels/inputs.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/random.h"
#include "curves/sweep.h"
#include "kernels/kernel.h"
#include "rays/capture.h"
#include "scene/procedural.h"

namespace shadowbench::kernels {
namespace {

constexpr double linearisation = 1e-3;  // of functions made from media

scene::Object object_of(decltype(scene::Object::shape) shape, float opacity, float extinction) {
    scene::Object object;
    object.opacity = base::Vec3f(opacity);
    object.extinction = base::Vec3f(extinction);
    object.shape = std::move(shape);
    return object;
}

scene::Particles make_smoke() {
    scene::SmokeColumn column;
    column.particles = 100;
    column.base = {0, -1, 0};
    column.height = 2.0;
    return scene::make_smoke_column(column);
}

scene::GridVolume make_cloud() {
    scene::Cloud cloud;
    cloud.size = {32, 32, 32};
    scene::GridVolume volume = scene::make_cloud(cloud);
    volume.step = 1.0 / 8;
    return volume;
}

std::vector<scene::Object> objects_of(Kind kind) {
    std::vector<scene::Object> objects;
    if (kind == Kind::hair || kind == Kind::mixed) objects.push_back(object_of(make_hair(), 0.6f, 1.0f));
    if (kind == Kind::mesh) objects.push_back(object_of(make_mesh(48), 0.5f, 1.0f));
    if (kind == Kind::smoke || kind == Kind::mixed) objects.push_back(object_of(make_smoke(), 1.0f, 1.0f));
    if (kind == Kind::cloud) objects.push_back(object_of(make_cloud(), 1.0f, 4.0f));
    return objects;
}

}  // namespace

const char* name_of(Kind kind) {
    switch (kind) {
        case Kind::hair:
            return "hair";
        case Kind::mesh:
            return "mesh";
        case Kind::smoke:
            return "smoke";
        case Kind::cloud:
            return "cloud";
        case Kind::mixed:
            return "mixed";
    }
    return "";
}

scene::Hair make_hair() {
    scene::HairBall ball;
    ball.strands = 1500;
    ball.segments = 12;
    ball.ball_radius = 0.6;
    ball.length = 0.4;
    ball.radius = 0.006;
    return scene::make_hair_ball(ball);
}

scene::Mesh make_mesh(int cells) {
    const float cell = 2.0f / static_cast<float>(cells);
    base::Random random(3);
    const auto shift = [&] { return 0.4f * cell * static_cast<float>(random.uniform(-1.0, 1.0)); };
    scene::Mesh mesh;
    for (int y = 0; y <= cells; ++y)
        for (int x = 0; x <= cells; ++x) {
            const float u = static_cast<float>(x) * cell - 1.0f + shift();
            const float v = static_cast<float>(y) * cell - 1.0f + shift();
            mesh.positions.emplace_back(u, shift(), v);
        }
    for (int y = 0; y < cells; ++y)
        for (int x = 0; x < cells; ++x) {
            const int a = y * (cells + 1) + x, b = a + cells + 1;
            mesh.triangles.emplace_back(a, a + 1, b);
            mesh.triangles.emplace_back(a + 1, b + 1, b);
        }
    return mesh;
}

SharedInput make_input(Kind kind, int map, int samples) {
    auto input = std::make_shared<Input>();
    input->scene.objects = objects_of(kind);
    input->light.direction = base::Vec3d(0.2, -1.0, 0.1).normalized();
    input->settings.resolution = {map, map};
    input->settings.samples_per_pixel = samples;
    input->view = rays::make_light_view(input->light, input->scene, input->settings.resolution, "");
    input->layout = rays::make_layout(input->scene, input->view, input->settings);
    return input;
}

std::vector<rays::LightRays> capture_all(const Input& input) {
    const rays::Capture capture(input.scene, input.view, input.layout);
    std::vector<rays::LightRays> tiles;
    for (int t = 0; t < input.layout.tiles(); ++t) tiles.push_back(capture.tile(t));
    return tiles;
}

std::size_t segments_of(const std::vector<rays::LightRays>& tiles) {
    std::size_t segments = 0;
    for (const rays::LightRays& tile : tiles) segments += tile.segments();
    return segments;
}

void append_lines(const std::vector<rays::LightRays>& tiles, std::vector<const void*>& lines) {
    for (const rays::LightRays& tile : tiles) {
        append_lines(tile.begin, lines);
        append_lines(tile.z_front, lines);
        append_lines(tile.z_back, lines);
        append_lines(tile.transmittance, lines);
    }
}

std::vector<curves::Curve> functions_of(Kind kind, int map, int samples) {
    std::vector<curves::Curve> functions;
    curves::SweepScratch scratch;
    curves::Curve function;
    for (const rays::LightRays& tile : capture_all(*make_input(kind, map, samples)))
        for (std::size_t ray = 0; ray < tile.rays(); ray += static_cast<std::size_t>(samples)) {
            curves::visibility(tile, ray, static_cast<std::size_t>(samples), linearisation, scratch, function);
            if (!function.empty()) functions.push_back(function);
        }
    return functions;
}

std::string argument(const char* name, double value) {
    return fmt::format("/{}:{}", name, value);
}

}  // namespace shadowbench::kernels
