// Small scenes, made by hand, whose light rays are known.
#pragma once

#include <cmath>

#include "base/random.h"
#include "rays/capture.h"
#include "scene/scene.h"

namespace shadowbench::rays::testing {

inline scene::Object quad(base::Vec3f corner, base::Vec3f u, base::Vec3f v, float opacity = 1.0f) {
    scene::Mesh mesh;
    mesh.positions = {corner, corner + u, corner + u + v, corner + v};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    scene::Object object;
    object.name = "quad";
    object.opacity = base::Vec3f(opacity);
    object.shape = mesh;
    return object;
}

// Density 2 throughout |z| <= 0.5, wider than the view of the lights below.
inline scene::GridVolume slab() {
    scene::GridVolume grid;
    grid.size = {4, 4, 4};
    grid.density.assign(64, 2.0f);
    grid.lower = {-3, -3, -0.5};
    grid.upper = {3, 3, 0.5};
    grid.step = 0.1;
    return grid;
}

// Looks along -z of the world at [-1, 1]^2; world z = 1 is far above everything.
inline scene::Light directional(double extent = 2.0) {
    scene::Light light;
    light.direction = {0, 0, -1};
    light.up = base::Vec3d(0, 1, 0);
    light.extent = base::Vec2d(extent, extent);
    return light;
}

inline scene::Light spot(base::Vec3d position, double angle) {
    scene::Light light;
    light.type = scene::LightType::spot;
    light.position = position;
    light.target = {0, 0, 0};
    light.up = base::Vec3d(0, 1, 0);
    light.angle = angle;
    return light;
}

inline scene::RaySettings rays(int resolution, int samples, scene::Pattern pattern = scene::Pattern::jittered) {
    scene::RaySettings settings;
    settings.resolution = {resolution, resolution};
    settings.samples_per_pixel = samples;
    settings.pattern = pattern;
    return settings;
}

struct Captured {
    LightView view;
    MapLayout layout;
    std::vector<LightRays> tiles;
};

inline Captured capture(const scene::Scene& scene, const scene::Light& light, const scene::RaySettings& settings,
                        int apron = 0) {
    Captured c;
    c.view = make_light_view(light, scene, settings.resolution, "/lights/0");
    c.layout = make_layout(scene, c.view, settings);
    c.layout.apron = apron;
    const Capture capture(scene, c.view, c.layout);
    for (int t = 0; t < c.layout.tiles(); ++t) c.tiles.push_back(capture.tile(t, apron));
    return c;
}

inline Captured capture_all(const scene::Scene& scene, const LightView& view, const MapLayout& layout, int apron = 0) {
    Captured c{view, layout, {}};
    const Capture capture(scene, view, layout);
    for (int t = 0; t < layout.tiles(); ++t) c.tiles.push_back(capture.tile(t, apron));
    return c;
}

// Calls visit(tile, ray, sample cell i, j) for every ray.
template <class Visit>
void for_each_ray(const Captured& c, const Visit& visit) {
    for (const LightRays& tile : c.tiles)
        for (std::size_t ray = 0; ray < tile.rays(); ++ray) {
            const int pixel = static_cast<int>(ray) / tile.samples, sample = static_cast<int>(ray) % tile.samples;
            const int i = (tile.x0 + pixel % tile.width) * c.layout.samples_x + sample % c.layout.samples_x;
            const int j = (tile.y0 + pixel / tile.width) * c.layout.samples_y + sample / c.layout.samples_x;
            visit(tile, ray, i, j);
        }
}

// Strands of straight pieces that wind through the unit cube.
inline scene::Object curly_hair(int strands, int segments, float radius, std::uint64_t seed) {
    base::Random random(seed);
    scene::Hair hair;
    hair.strand_begin.push_back(0);
    for (int s = 0; s < strands; ++s) {
        base::Vec3f p(static_cast<float>(random.uniform(-0.7, 0.7)), static_cast<float>(random.uniform(-0.7, 0.7)),
                      static_cast<float>(random.uniform(-0.7, 0.7)));
        base::Vec3f d(static_cast<float>(random.uniform(-1, 1)), static_cast<float>(random.uniform(-1, 1)),
                      static_cast<float>(random.uniform(-1, 1)));
        for (int i = 0; i <= segments; ++i) {
            hair.points.push_back(p);
            hair.radii.push_back(radius * (1.0f - 0.5f * static_cast<float>(i) / static_cast<float>(segments)));
            d += base::Vec3f(static_cast<float>(random.uniform(-.6, .6)), static_cast<float>(random.uniform(-.6, .6)),
                             static_cast<float>(random.uniform(-.6, .6)));
            d.normalize();
            p += d * 0.03f;
        }
        hair.strand_begin.push_back(static_cast<std::uint32_t>(hair.points.size()));
    }
    scene::Object object;
    object.name = "hair";
    object.opacity = base::Vec3f(0.5f);
    object.shape = hair;
    return object;
}

// A grid of triangles over [-1, 1]^2 whose inner vertices are moved about in all directions.
inline scene::Object crumpled_sheet(int cells) {
    base::Random random(3);
    scene::Mesh mesh;
    for (int y = 0; y <= cells; ++y)
        for (int x = 0; x <= cells; ++x) {
            const bool inner = x > 0 && y > 0 && x < cells && y < cells;
            const double s = inner ? 0.45 / cells : 0.0;
            mesh.positions.emplace_back(static_cast<float>(2.0 * x / cells - 1 + random.uniform(-s, s)),
                                        static_cast<float>(2.0 * y / cells - 1 + random.uniform(-s, s)),
                                        static_cast<float>(random.uniform(-0.01, 0.01)));
        }
    const auto at = [&](int x, int y) { return y * (cells + 1) + x; };
    for (int y = 0; y < cells; ++y)
        for (int x = 0; x < cells; ++x) {
            mesh.triangles.emplace_back(at(x, y), at(x + 1, y), at(x, y + 1));
            if ((x + y) % 2)  // both windings occur
                mesh.triangles.emplace_back(at(x + 1, y), at(x, y + 1), at(x + 1, y + 1));
            else
                mesh.triangles.emplace_back(at(x + 1, y), at(x + 1, y + 1), at(x, y + 1));
        }
    scene::Object object;
    object.shape = mesh;
    return object;
}

}  // namespace shadowbench::rays::testing
