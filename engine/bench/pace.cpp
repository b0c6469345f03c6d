#include "bench/pace.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "base/random.h"
#include "bench/clock.h"
#include "rays/capture.h"
#include "rays/light_view.h"
#include "scene/scene.h"

namespace shadowbench::bench {
namespace {

constexpr int tries = 8, triangles = 2000;
constexpr double seconds_there = 1.3e-3;  // measured where the constants of work.cpp and estimate.cpp come from

// Small triangles in a cube.
scene::Scene some_triangles() {
    scene::Mesh mesh;
    base::Random random(1);
    const auto place = [&] {
        base::Vec3f at;
        for (int axis = 0; axis < 3; ++axis) at[axis] = static_cast<float>(random.below(1000));
        return at;
    };
    for (int t = 0; t < triangles; ++t) {
        const base::Vec3f corner = place();
        for (int c = 0; c < 3; ++c) mesh.positions.push_back(corner + place() * 0.1f);
        mesh.triangles.emplace_back(3 * t, 3 * t + 1, 3 * t + 2);
    }
    scene::Object object;
    object.opacity = {0.5f, 0.5f, 0.5f};
    object.shape = std::move(mesh);
    scene::Scene scene;
    scene.objects.push_back(std::move(object));
    return scene;
}

}  // namespace

double measure_pace() {
    const scene::Scene scene = some_triangles();
    scene::RaySettings settings;
    settings.resolution = {32, 32};
    const rays::LightView view = rays::make_light_view({}, scene, settings.resolution, "");
    const rays::MapLayout layout = rays::make_layout(scene, view, settings);
    const rays::Capture capture(scene, view, layout);
    double least = std::numeric_limits<double>::infinity();
    for (int t = 0; t < tries; ++t) {
        const Stopwatch stopwatch;
        for (int tile = 0; tile < layout.tiles(); ++tile) capture.tile(tile);
        least = std::min(least, stopwatch.seconds());
    }
    return std::clamp(least / seconds_there, 0.1, 10.0);
}

}  // namespace shadowbench::bench
