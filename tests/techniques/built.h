// Builds a technique's map of a small scene, as the benchmark does.
#pragma once

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "rays/scenes.h"
#include "rays/tracer.h"
#include "techniques/technique.h"

namespace shadowbench::techniques::testing {

using rays::testing::capture;
using rays::testing::Captured;

struct Built {
    scene::Scene scene;
    Captured rays;
    std::unique_ptr<rays::Tracer> tracer;
    std::unique_ptr<Map> map;
    ParameterValues values;

    float lookup(float x, float y, float z, float width = 1.0f, int channel = 0) const {
        const Query q{x, y, z, width};
        std::vector<float> v(static_cast<std::size_t>(map->channels()), -1.0f);
        map->lookup({&q, 1}, v);
        return v[static_cast<std::size_t>(channel)];
    }
};

inline Built build(const Technique& row, scene::Scene scene, const scene::Light& light,
                   const scene::RaySettings& settings, const char* parameters = "{}") {
    Built b;
    b.scene = std::move(scene);
    b.values = read_parameters(row.parameters, nlohmann::json::parse(parameters), "/techniques/0");
    b.map = row.create(b.values);
    b.rays = capture(b.scene, light, settings, b.map->needs().apron);
    b.tracer = std::make_unique<rays::Tracer>(b.scene, true);
    b.map->begin({b.rays.layout, b.rays.view, b.tracer.get(), 0});
    for (const auto& tile : b.rays.tiles) b.map->add(tile);
    b.map->finish();
    return b;
}

inline scene::Object slab(float density, double front, double back, double step) {
    scene::GridVolume grid;
    grid.size = {2, 2, 2};
    grid.density.assign(8, density);
    grid.lower = {-3, -3, back};
    grid.upper = {3, 3, front};
    grid.step = step;
    scene::Object object;
    object.shape = grid;
    return object;
}

// Half of the map is hair over nothing, with a medium in between if asked for.
inline scene::Scene hairy_scene(bool media, float opacity = 0.5f) {
    scene::Scene scene;
    scene.objects.push_back(rays::testing::curly_hair(150, 12, 0.02f, 4));
    scene.objects.back().opacity = base::Vec3f(opacity);
    if (media) {
        scene.objects.emplace_back();
        scene.objects.back().shape = scene::Particles{
            {{0.1f, 0.3f, 0.1f}, {-0.2f, -0.4f, 0.2f}, {0, 0, 0}}, {0.25f, 0.3f, 0.5f}, {3.0f, 1.0f, 0.5f}};
    }
    return scene;
}

}  // namespace shadowbench::techniques::testing
