// Renders a scenario document: pictures of what its camera sees, lit through the map of every technique and through the
// reference, and the differences between them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "bench/progress.h"
#include "bench/run.h"
#include "render/light_map.h"
#include "render/picture_size.h"
#include "render/shading_points.h"
#include "results/result.h"

namespace shadowbench::render {

struct RenderOptions {
    bench::RunOptions run;
    std::optional<base::Vec2i> size;  // pixels; absent: as in the scenario
    bool enlarge = false;             // without a size, to usual_width pixels if the scenario's picture is narrower
    int rays_per_side = 1;            // 1 to 8; its square is the number of view rays a pixel
    bool joined = false;              // view rays of a pixel that see one place share a lookup: see join_points()
    bool fine_hair = false;           // hair that is narrower than a view ray is filtered: see rays::ViewedHair
    int media_lookups = 128;          // 1 to 256, for a view ray through all media: see ViewSettings
};

// The options of pictures for the eye: enlarged, antialiased, with joined lookups.
RenderOptions usual_options(const bench::RunOptions& run);

// Errors over all pixels and channels, in linear values; FLIP is computed on the pictures as a display shows them
// without exposure.
struct PictureErrors {
    double max = 0.0, rms = 0.0;
    double flip_mean = 0.0, flip_weighted_median = 0.0, flip_max = 0.0;
};

struct TechniquePictures {
    results::Cell cell;  // of the last light; status and reason of the first light that failed
    Picture picture;     // empty if it failed
    PictureErrors shaded, shadow;
};

struct Rendering {
    std::string name;
    std::string hash;                         // of the scenario document as rendered
    std::vector<document::Setting> settings;  // the first values of the sweeps
    std::vector<std::string> notes;           // of the file readers: see scene::read_notes
    scene::Camera camera;
    bool default_camera = false;
    base::Vec2i size{0, 0};
    int rays_per_side = 1;
    bool joined = false;
    std::size_t points = 0;   // number of points at which each technique looks up each light
    std::vector<float> seen;  // share of each pixel that shows something, mean of the channels
    Picture reference;
    int reference_samples = 0;              // rays a map pixel
    double reference_standard_error = 0.0;  // RMS over the points; the largest of the lights
    double heat_top = 1.0;                  // top of the heat maps' legend, equal for all techniques
    std::vector<LightMap> lights;           // of each light
    std::vector<TechniquePictures> techniques;
};

// Renders the first variant of a document with sweeps. Throws what bench::run throws, and Error{bad_input} for a deep
// image, which has no world for a camera.
Rendering render(const nlohmann::json& document, const RenderOptions& options, const bench::ProgressCallback& progress);

// |shaded - reference| * 4 of every pixel and channel.
Image difference_times_four(const Image& image, const Image& reference);

// The mean over the channels of |image - reference| of every pixel.
std::vector<float> pixel_errors(const Image& image, const Image& reference);

PictureErrors compare(const Image& image, const Image& reference);

}  // namespace shadowbench::render
