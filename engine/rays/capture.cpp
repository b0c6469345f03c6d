#include "rays/capture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "rays/hits.h"
#include "rays/prepared.h"
#include "rays/tile_projection.h"
#include "scene/scene.h"

namespace shadowbench::rays {
namespace {

// The rows of a deep image are the map's rows: one ray for each pixel, with its samples submitted in the image's order.
void copy_deep_image(const scene::DeepImage& image, bool submission, LightRays& rays) {
    const auto channels = static_cast<std::size_t>(image.channels);
    rays.begin.assign(1, 0);
    for (int y = rays.y0; y < rays.y0 + rays.height; ++y)
        for (int x = rays.x0; x < rays.x0 + rays.width; ++x) {
            const std::size_t pixel = static_cast<std::size_t>(y) * image.width + x;
            for (std::size_t s = image.begin[pixel]; s < image.begin[pixel + 1]; ++s) {
                const auto through = std::span(image.transmittance).subspan(s * channels, channels);
                const bool clear = std::all_of(through.begin(), through.end(), [](float t) { return t == 1.0f; });
                if (clear || scene::behind_everything(image, s)) continue;
                rays.z_front.push_back(image.z_front[s]);
                rays.z_back.push_back(image.z_back[s]);
                rays.transmittance.insert(rays.transmittance.end(), through.begin(), through.end());
            }
            rays.begin.push_back(static_cast<std::uint32_t>(rays.z_front.size()));
        }
    if (rays.z_back == rays.z_front) rays.z_back.clear();
    rays.submission.resize(submission ? rays.segments() : 0);
    std::iota(rays.submission.begin(), rays.submission.end(), 0u);
}

float outward(double z, float direction) {
    return std::nextafter(static_cast<float>(z), direction);
}

}  // namespace

MapLayout make_layout(const scene::Scene& scene, const LightView& view, const scene::RaySettings& settings) {
    MapLayout layout;
    layout.width = view.resolution.x;
    layout.height = view.resolution.y;
    layout.jittered = settings.pattern == scene::Pattern::jittered;
    layout.seed = settings.seed;
    constexpr float infinity = std::numeric_limits<float>::infinity();
    // Light-space positions are floats: what a sphere or a hair reaches from its rounded centre may lie slightly
    // outside.
    const double rounding = scene.deep_image ? 0.0 : 0x1p-23 * std::max(std::abs(view.z_min), std::abs(view.z_max));
    layout.z_min = outward(std::max(view.z_min - rounding, std::min(view.z_min, view.z_near)), -infinity);
    layout.z_max = outward(view.z_max + rounding, infinity);
    layout.channels = scene::channels(scene);
    layout.media = scene::has_media(scene);
    if (scene.deep_image) {
        layout.jittered = false;
    } else {
        layout.moving = scene::has_motion(scene);
        layout.cells = settings.media == scene::Media::cells;
        set_samples(layout, settings.samples_per_pixel);
    }
    int size = 64;
    while (size > 1 && size * size * layout.samples() > 16384) size /= 2;
    layout.tile_width = std::min(size, layout.width);
    layout.tile_height = std::min(size, layout.height);
    return layout;
}

struct Capture::State {
    const scene::Scene& scene;
    const LightView view;
    const MapLayout layout;
    std::shared_ptr<const std::vector<Prepared>> objects;

    template <class Sink>
    void project(LightRays& rays) const {
        const bool moving = std::any_of(objects->begin(), objects->end(), [&](const Prepared& p) {
            return p.moving && (p.marcher || !p.bins.of(rays.tile).empty());
        });
        const TileGrid grid = make_tile_grid(view, layout, rays, moving);
        thread_local Sink sink;  // keeps its memory from tile to tile
        sink.hits.clear();
        if (view.perspective)
            TileProjection<true, Sink>(view, layout, grid, rays, sink).project(*objects);
        else
            TileProjection<false, Sink>(view, layout, grid, rays, sink).project(*objects);
        sort_hits(sink, static_cast<std::size_t>(grid.nx) * grid.ny, layout.submission, rays);
    }
};

Capture::Capture(const scene::Scene& scene, const LightView& view, const MapLayout& layout, Grids grids) {
    auto objects = std::make_shared<std::vector<Prepared>>();
    for (const scene::Object& object : scene.objects) {
        const bool left_out = grids == Grids::left_out && std::holds_alternative<scene::GridVolume>(object.shape);
        if (object.casts_shadow && !left_out) objects->push_back(prepare(object, view, layout));
    }
    state_ = std::make_unique<State>(State{scene, view, layout, std::move(objects)});
}

Capture::Capture(const Capture& prepared, std::uint64_t seed) {
    MapLayout layout = prepared.state_->layout;
    layout.seed = seed;
    state_ =
        std::make_unique<State>(State{prepared.state_->scene, prepared.state_->view, layout, prepared.state_->objects});
}

Capture::~Capture() = default;

LightRays Capture::tile(int index, int apron) const {
    const MapLayout& layout = state_->layout;
    LightRays rays;
    rays.tile = index;
    const TileCore core = core_of(layout, index);
    rays.x0 = std::max(core.x0 - apron, 0);
    rays.y0 = std::max(core.y0 - apron, 0);
    rays.width = std::min(core.x0 + core.width + apron, layout.width) - rays.x0;
    rays.height = std::min(core.y0 + core.height + apron, layout.height) - rays.y0;
    rays.samples = layout.samples();
    rays.channels = layout.channels;
    if (state_->scene.deep_image)
        copy_deep_image(*state_->scene.deep_image, layout.submission, rays);
    else if (layout.media || layout.channels > 1)
        state_->project<SegmentHits>(rays);
    else
        state_->project<SurfaceHits>(rays);
    return rays;
}

std::size_t Capture::bytes() const {
    std::size_t sum = 0;
    for (const Prepared& p : *state_->objects) sum += p.bytes();
    return sum;
}

}  // namespace shadowbench::rays
