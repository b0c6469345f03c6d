// Captures a quad that lets a quarter of the light through, stores it as a deep shadow map, and asks the map before,
// behind and beside the quad. The answers are known: 1, 1/4 and 1.
#include <cmath>
#include <cstdio>
#include <memory>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "rays/capture.h"
#include "rays/light_view.h"
#include "scene/scene.h"
#include "techniques/technique.h"

using namespace shadowbench;

namespace {

scene::Scene quad_scene() {
    scene::Mesh quad;
    quad.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    quad.triangles = {{0, 1, 2}, {0, 2, 3}};
    scene::Object object;
    object.opacity = base::Vec3f(0.75f);
    object.shape = quad;
    scene::Scene scene;
    scene.objects.push_back(object);
    return scene;
}

bool check() {
    const scene::Scene scene = quad_scene();
    scene::Light light;
    light.direction = {0, 0, -1};
    light.extent = base::Vec2d(4, 4);
    scene::RaySettings settings;
    settings.resolution = {16, 16};
    const rays::LightView view = rays::make_light_view(light, scene, settings.resolution, "/lights/0");
    const rays::MapLayout layout = rays::make_layout(scene, view, settings);
    const rays::Capture capture(scene, view, layout);

    const techniques::Technique& row = techniques::find("deep", "/techniques/0");
    const auto values =
        techniques::read_parameters(row.parameters, nlohmann::json{{"tolerance", 0.001}}, "/techniques/0");
    const std::unique_ptr<techniques::Map> map = row.create(values);
    map->begin({layout, view, nullptr});
    for (int tile = 0; tile < layout.tiles(); ++tile) map->add(capture.tile(tile, map->needs().apron));
    map->finish();

    const base::Vec3d places[] = {{0.1, 0.1, 0.5}, {0.1, 0.1, -0.5}, {1.6, 1.6, -0.5}};
    const float expected[] = {1.0f, 0.25f, 1.0f};
    std::vector<techniques::Query> queries;
    for (const base::Vec3d& place : places) {
        const base::Vec3d at = rays::to_light(view, place);
        queries.push_back({static_cast<float>(at.x), static_cast<float>(at.y), static_cast<float>(at.z), 1.0f});
    }
    std::vector<float> visibility(queries.size(), -1.0f);
    map->lookup(queries, visibility);
    bool right = true;
    for (std::size_t i = 0; i < queries.size(); ++i) {
        std::printf("visibility %.4f, expected %.4f\n", visibility[i], expected[i]);
        right = right && std::abs(visibility[i] - expected[i]) <= 0.001f;
    }
    return right;
}

}  // namespace

int main() {
    try {
        return check() ? 0 : 1;
    } catch (const base::Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return static_cast<int>(error.code());
    }
}
