// The points that a camera sees, at which light is looked up. They are found once per picture; the picture of each
// technique is then a sum over them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "base/vec.h"
#include "rays/tracer.h"
#include "render/image.h"
#include "scene/scene.h"

namespace shadowbench::render {

struct ShadingPoints {
    base::Vec2i size{0, 0};
    std::vector<std::uint32_t> begin;  // pixels + 1 offsets into the points; pixels in image order
    std::vector<base::Vec3d> place;    // world; for each view ray first media, then surfaces, each from front to back
    std::vector<base::Vec3f> across;   // edges of a view ray's footprint at its point, as in bench::CameraPoint; of
                                       // the pixel's at a joined point
    std::vector<base::Vec3f> down;
    std::vector<base::Vec3f> normal;    // as in bench::CameraPoint
    std::vector<base::Vec3f> coverage;  // share of the pixel that shows the point; a pixel's sum is at most 1
    std::vector<base::Vec3f> radiance;  // light after light: what light l adds to the pixel when nothing shadows it,
                                        // at [l * points + i]

    double lamps = 0.0;  // the number of lights; the six faces of a point light are one

    std::size_t points() const { return place.size(); }
    std::size_t lights() const { return points() ? radiance.size() / points() : 0; }
};

struct ViewSettings {
    scene::Camera camera;
    base::Vec2i size{256, 256};
    // Number of steps of a view ray through all of the scene's media. Rays that miss parts of the media have fewer;
    // gaps between media add at most as many again (at most 512 in all).
    int media_lookups = 128;
    int rays_per_side =
        1;  // its square is the number of view rays a pixel, on a regular grid; more rays smooth edges and hair
    bool joined = false;  // the view rays of a pixel that see one place share a point: see join_points()
    std::size_t memory_limit = std::size_t{8} << 30;  // bytes
};

using ViewWatch = std::function<void(std::size_t rows, std::size_t total)>;

// Finds, for each view ray, the steps through media and all surfaces, composited in order of depth until less than 1e-4
// of the light is left in every channel. `tracer` sees all objects. Throws Error{bad_input} at /receivers/resolution if
// the points would exceed the memory limit. The result does not depend on the number of threads.
ShadingPoints find_shading_points(const scene::Scene& scene, std::span<const scene::Light> lights,
                                  const ViewSettings& settings, const rays::Tracer& tracer, const ViewWatch& watch);

// Share of each pixel that shows something: the mean of the channels of its coverage.
std::vector<float> seen_shares(const ShadingPoints& points);

// The pictures of one technique, summed light after light.
struct Picture {
    Image shaded;  // background black
    Image shadow;  // average visibility: 1 minus the light that shadows take; the background is lit
};
Picture start_picture(const ShadingPoints& points);

// visibility[c * points + i] is that of point i in channel c; a single channel is used for all three.
void add_light(const ShadingPoints& points, std::size_t light, std::span<const float> visibility, Picture& picture);

}  // namespace shadowbench::render
