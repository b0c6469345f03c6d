#include "fuzz/expect.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>

#include "scene/limits.h"

namespace shadowbench::fuzz {

using namespace scene;

namespace {

template <typename Vector>
bool is_finite(const Vector& v) {
    for (unsigned i = 0; i < Vector::dimensions(); ++i)
        if (!std::isfinite(v[static_cast<int>(i)])) return false;
    return true;
}

template <typename Vector>
void expect_all_finite(const std::vector<Vector>& values, std::string_view what) {
    expect(std::all_of(values.begin(), values.end(), is_finite<Vector>), what);
}

template <typename Index>
void expect_offsets(const std::vector<Index>& begin, std::size_t items, std::string_view what) {
    expect(!begin.empty() && begin.front() == 0 && begin.back() == items, what);
    expect(std::is_sorted(begin.begin(), begin.end()), what);
}

void expect_colour(const Vec3f& colour, float high, std::string_view what) {
    for (int c = 0; c < 3; ++c) expect(colour[c] >= 0.0f && colour[c] <= high, what);
}

void expect_sound(const Light& light) {
    expect(!light.name.empty(), "a light has a name");
    expect(is_finite(light.position) && is_finite(light.target) && is_finite(light.colour), "a light is finite");
    expect(std::abs(light.direction.length() - 1.0) < 1e-9, "a light's direction has length 1");
    expect(!light.up || is_finite(*light.up), "a light's up is finite");
    expect(!light.extent || (light.extent->x > 0.0 && light.extent->y > 0.0 && is_finite(*light.extent)),
           "a light's extent is above 0");
    expect(!light.angle || (*light.angle > 0.0 && *light.angle < 179.0), "a light's angle is in (0, 179)");
    expect(light.near >= 0.0 && std::isfinite(light.near), "a light's near is at least 0");
}

void expect_sound(const Object& object) {
    expect(!object.name.empty(), "an object has a name");
    expect_colour(object.opacity, 1.0f, "opacity is in [0, 1]");
    expect_colour(object.extinction, static_cast<float>(max_coordinate), "extinction is at least 0");
    expect(is_finite(object.motion), "motion is finite");
    std::visit([](const auto& shape) { fuzz::expect_sound(shape); }, object.shape);
    if (const auto* volume = std::get_if<GridVolume>(&object.shape)) expect_box(*volume);
}

}  // namespace

void expect(bool holds, std::string_view what) {
    if (!holds) throw Broken(std::string(what));
}

void expect_finite(std::span<const float> values, std::string_view what) {
    expect(std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); }), what);
}

void expect_in(std::span<const float> values, float low, float high, std::string_view what) {
    expect(std::all_of(values.begin(), values.end(), [&](float v) { return v >= low && v <= high; }), what);
}

void expect_sound(const Mesh& mesh) {
    expect_all_finite(mesh.positions, "positions are finite");
    const auto count = static_cast<int>(mesh.positions.size());
    for (const Vec3i& triangle : mesh.triangles)
        for (int corner = 0; corner < 3; ++corner)
            expect(triangle[corner] >= 0 && triangle[corner] < count, "triangles index positions");
    expect(mesh.corner_uv.empty() || mesh.corner_uv.size() == 3 * mesh.triangles.size(), "three uvs a triangle");
    expect_all_finite(mesh.corner_uv, "uvs are finite");
    if (mesh.alpha) expect_sound(*mesh.alpha);
}

void expect_sound(const Hair& hair) {
    expect_offsets(hair.strand_begin, hair.points.size(), "strands index points");
    expect(hair.radii.size() == hair.points.size(), "one radius a point");
    expect_all_finite(hair.points, "points are finite");
    expect_in(hair.radii, 0.0f, static_cast<float>(max_coordinate), "radii are at least 0");
}

void expect_sound(const Spheres& spheres) {
    expect(spheres.radii.size() == spheres.centres.size(), "one radius a sphere");
    expect_all_finite(spheres.centres, "centres are finite");
    expect_finite(spheres.radii, "radii are finite");
    for (const float radius : spheres.radii) expect(radius > 0.0f, "radii are above 0");
}

void expect_sound(const Particles& particles) {
    expect_sound(Spheres{particles.centres, particles.radii});
    expect(particles.density.size() == particles.centres.size(), "one density a particle");
    for (const float density : particles.density)
        expect(density >= 0.0f && std::isfinite(density), "density is at least 0");
}

void expect_sound(const AlphaTexture& texture) {
    expect(texture.width > 0 && texture.height > 0, "a texture has texels");
    expect(texture.alpha.size() == static_cast<std::size_t>(texture.width) * texture.height, "one alpha a texel");
    expect_in(texture.alpha, 0.0f, 1.0f, "alpha is in [0, 1]");
}

void expect_sound(const GridVolume& volume) {
    expect(volume.size.x > 0 && volume.size.y > 0 && volume.size.z > 0, "a volume has voxels");
    const std::size_t slice = static_cast<std::size_t>(volume.size.x) * volume.size.y;
    expect(volume.density.size() == slice * volume.size.z, "one density a voxel");
    expect_in(volume.density, 0.0f, static_cast<float>(max_coordinate), "density is at least 0");
}

void expect_box(const GridVolume& volume) {
    for (int axis = 0; axis < 3; ++axis)
        expect(volume.lower[axis] < volume.upper[axis] && std::isfinite(volume.lower[axis]) &&
                   std::isfinite(volume.upper[axis]),
               "a volume's box has a size");
    expect(volume.step > 0.0 && std::isfinite(volume.step), "a volume's step is above 0");
    const Box3d box = world_box(volume);
    expect(is_finite(box.min) && is_finite(box.max), "a volume's place in the world is finite");
    for (int row = 0; volume.frame && row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            expect(std::isfinite(volume.frame->to_grid[row][column]), "a volume's frame is finite");
}

void expect_sound(const DeepImage& image) {
    expect(image.width > 0 && image.height > 0, "a deep image has pixels");
    const std::size_t pixels = static_cast<std::size_t>(image.width) * image.height, samples = image.z_front.size();
    expect(image.begin.size() == pixels + 1, "an offset a pixel, and one more");
    expect_offsets(image.begin, samples, "pixels index samples");
    expect(image.channels == 1 || image.channels == 3, "one channel or three");
    expect(image.z_back.size() == samples &&
               image.transmittance.size() == samples * static_cast<std::size_t>(image.channels),
           "one z_back and one transmittance a channel for each sample");
    constexpr float infinity = std::numeric_limits<float>::infinity();
    expect_in(image.z_front, -static_cast<float>(max_coordinate), infinity, "a front is above the least coordinate");
    expect_in(image.transmittance, 0.0f, 1.0f, "transmittance is in [0, 1]");
    for (std::size_t i = 0; i < samples; ++i) expect(image.z_front[i] <= image.z_back[i], "a sample ends behind");
    for (std::size_t p = 0; p < pixels; ++p)
        expect(std::is_sorted(image.z_front.begin() + static_cast<std::ptrdiff_t>(image.begin[p]),
                              image.z_front.begin() + static_cast<std::ptrdiff_t>(image.begin[p + 1])),
               "samples are sorted by depth");
}

void expect_sound(const Scenario& scenario) {
    expect(!scenario.lights.empty(), "there is a light");
    for (const Light& light : scenario.lights) expect_sound(light);
    for (const Object& object : scenario.scene.objects) expect_sound(object);
    if (scenario.scene.deep_image) expect_sound(*scenario.scene.deep_image);
    if (scenario.scene.deep_image) return;
    const Box3d box = bounds(scenario.scene, true);
    expect(!box.isEmpty() && is_finite(box.min) && is_finite(box.max), "what casts shadows has finite bounds");
}

}  // namespace shadowbench::fuzz
