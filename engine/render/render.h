// A scenario document -> pictures: what its camera sees, lit through the map of every technique and through the
// reference, and how far the former are from the latter.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "bench/progress.h"
#include "bench/run.h"
#include "render/light_map.h"
#include "render/shading_points.h"
#include "results/result.h"

namespace shadowbench::render {

struct RenderOptions {
    bench::RunOptions run;
    std::optional<base::Vec2i> size;  // pixels; absent: the scenario's own
    int rays_per_side = 1;            // squared: view rays a pixel, 1 to 8
    int media_lookups = 128;          // of a view ray through all media, 1 to 256: see ViewSettings
};

// Over all pixels and channels, in linear values; FLIP of the pictures as a display shows them.
struct PictureErrors {
    double max = 0.0, rms = 0.0;
    double flip_mean = 0.0, flip_weighted_median = 0.0, flip_max = 0.0;
};

struct TechniquePictures {
    results::Cell cell;  // of the last light; status and reason of the first that failed
    Picture picture;     // empty when it failed
    PictureErrors shaded, shadow;
};

struct Rendering {
    std::string name;
    std::string hash;                         // of the scenario document as rendered
    std::vector<document::Setting> settings;  // what the first values of the sweeps set
    scene::Camera camera;
    bool default_camera = false;
    base::Vec2i size{0, 0};
    int rays_per_side = 1;
    std::size_t points = 0;  // at which light was looked up, per light and technique
    Picture reference;
    int reference_samples = 0;              // rays a map pixel
    double reference_standard_error = 0.0;  // RMS over the points; the largest of the lights
    double heat_top = 1.0;                  // of the heat maps' legend, the same for all techniques
    std::vector<LightMap> lights;           // of each light
    std::vector<TechniquePictures> techniques;
};

// Looks from (3, 2.5, 4) at the middle of what casts shadows, from so far that all of it is seen.
scene::Camera default_camera(const scene::Scene& scene);

// Renders the first variant of a document with sweeps. Throws Error: what bench::run throws, and bad_input for a deep
// image, which has no world that a camera could see.
Rendering render(const nlohmann::json& document, const RenderOptions& options, const bench::ProgressCallback& progress);

// |shaded - reference| * 4 of every pixel and channel.
Image difference_times_four(const Image& image, const Image& reference);

// The mean over the channels of |image - reference| of every pixel.
std::vector<float> pixel_errors(const Image& image, const Image& reference);

PictureErrors compare(const Image& image, const Image& reference);

}  // namespace shadowbench::render
