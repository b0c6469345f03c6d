// The renderer of the paper on deep shadow maps from volumetric data (its section "Implementation", figure 3), of one
// grid volume and one light. A first pass accumulates the volume's own colour along each view ray. A second pass steps
// along the same ray through the volume's box, looks up the shadow map at each step, and averages the opacities that
// it finds. The average darkens the colour of the first pass: all places of a ray count alike, also those that the eye
// hardly sees. An exact second pass stands beside it.
//
// The paper looks up the length of the way to the light inside the box. Planar depth along a directional light differs
// from it by a constant for each light ray, also in the map, so that the answers are the same.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/vec.h"
#include "bench/maps.h"
#include "rays/light_view.h"
#include "render/image.h"
#include "scene/scene.h"

namespace shadowbench::render {

// A ray inside the volume's box: at t in [front, back] it is at origin + t * direction. A ray that misses the box has
// back = front = 0.
struct BoxRay {
    base::Vec3d origin, direction;
    double front = 0.0, back = 0.0;

    bool meets() const { return back > front; }
    base::Vec3d at(double t) const { return origin + direction * t; }
};

// Cuts a ray to the box of a volume that stands still, from t = `from` on.
BoxRay cut_to_box(const base::Vec3d& origin, const base::Vec3d& direction, double from,
                  const scene::GridVolume& volume);

// A ray of unit length for each pixel, in image order: through its middle or, with a seed, through a random place in
// it.
std::vector<BoxRay> box_rays(const scene::Camera& camera, base::Vec2i size, const scene::GridVolume& volume,
                             std::optional<std::uint64_t> seed = {});

// The colour that a view ray gathers on a stretch [front, back].
struct ColourStep {
    double front, back;
    double colour;
};

// The first pass for one ray: at most `steps` steps across the diagonal of the box, from front to back. A sample of the
// volume gives a step its opacity and its colour, both, as in the paper. The sum of the steps is the ray's colour.
class ColourPass {
public:
    // The object is a grid volume, and its extinction is grey. Throws Error{bad_input} otherwise. Keeps a copy.
    ColourPass(const scene::Object& object, int steps);
    ~ColourPass();

    // Replaces `out`. Thread-safe.
    void trace(const BoxRay& ray, std::vector<ColourStep>& out) const;
    // The colours of all rays, on all threads.
    std::vector<double> colours(std::span<const BoxRay> rays) const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

// The second pass: the average of the opacities that the map answers at the middles of `samples` equal steps through
// the box; 0 for a ray that misses it. On all threads.
std::vector<double> mean_opacities(std::span<const BoxRay> rays, int samples, const rays::LightView& view,
                                   const bench::Maps& maps);

// What the second pass stands for: the share of the light that does not reach the places of a ray, each with the weight
// of its colour in the first pass. From the exact transmittance towards the light, at the middle of the colour of each
// of `samples` equal steps. 0 for a ray without colour. On all threads.
std::vector<double> exact_opacities(std::span<const BoxRay> rays, int samples, const scene::Scene& scene,
                                    const rays::LightView& view, const ColourPass& pass);

// A grey picture of one value a pixel.
Image grey_picture(std::span<const double> values, base::Vec2i size);

// colour * (1 - opacity), pixel by pixel.
std::vector<double> darkened(std::span<const double> colours, std::span<const double> opacities);

}  // namespace shadowbench::render
