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
    HalfCovered half;
    half.scene.objects = {layer(-1.0f, -1.5f, static_cast<float>(layer_right_edge), 0.6f),
                          layer(-3.0f, -1.5f, 1.5f, 1.0f)};
    half.settings.resolution = {8, 8};
    half.settings.samples_per_pixel = 16;
    half.view.origin = {0, 0, 0};
    half.view.right = {1, 0, 0};
    half.view.up = {0, 0, -1};
    half.view.forward = {0, -1, 0};
    half.view.lower = {-1, -1};
    half.view.pixel = {0.25, 0.25};
    half.view.resolution = {8, 8};
    half.view.z_near = -1e300;
    half.view.z_min = 1.0;
    half.view.z_max = 3.0;
    return half;
}

}  // namespace shadowbench::bench
