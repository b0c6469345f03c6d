#include "bench/half_covered.h"

namespace shadowbench::bench {
namespace {

using scene::Vec3f;

// Two triangles at height y over [x0, x1] x [-1.5, 1.5].
scene::Object layer(float y, float x0, float x1, float opacity) {
    scene::Mesh mesh;
    mesh.positions = {{x0, y, -1.5f}, {x1, y, -1.5f}, {x1, y, 1.5f}, {x0, y, 1.5f}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    scene::Object object;
    object.opacity = Vec3f(opacity, opacity, opacity);
    object.shape = mesh;
    return object;
}

}  // namespace

HalfCovered half_covered(double layer_right_edge) {
    HalfCovered made;
    made.scene.objects = {layer(-1.0f, -1.5f, static_cast<float>(layer_right_edge), 0.6f),
                          layer(-3.0f, -1.5f, 1.5f, 1.0f)};
    made.settings.resolution = {8, 8};
    made.settings.samples_per_pixel = 16;
    made.view.origin = {0, 0, 0};
    made.view.right = {1, 0, 0};
    made.view.up = {0, 0, -1};
    made.view.forward = {0, -1, 0};
    made.view.lower = {-1, -1};
    made.view.pixel = {0.25, 0.25};
    made.view.resolution = {8, 8};
    made.view.z_near = -1e300;
    made.view.z_min = 1.0;
    made.view.z_max = 3.0;
    return made;
}

}  // namespace shadowbench::bench
