// Deep shadow maps from volumetric data: figure 2, the channels of the maps.
#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "claims/volume.h"
#include "claims/volume_map.h"
#include "render/two_pass.h"

namespace shadowbench::claims::volume {
namespace {

constexpr float rounding = 1e-6f;  // of a stored opacity

// The depth that a light ray has passed inside the box when it reaches z.
double passed(const VolumeMap& map, int x, int y, double z) {
    const rays::LightLine line = rays::light_line(map.view, x + 0.5, y + 0.5);
    const render::BoxRay ray =
        render::cut_to_box(line.origin, line.direction, -std::numeric_limits<double>::infinity(), map.grid);
    return std::max(z - ray.front, 0.0);
}

// The map as one coloured picture, then its four channels. Depths are divided by the largest of all.
std::vector<render::Image> pictures_of(const VolumeMap& map) {
    const base::Vec2i size = map.view.resolution;
    std::vector<render::Image> pictures(5, render::Image(size, base::Vec3f(0.0f)));
    float deepest = 0.0f;
    curves::Curve function;
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            bench::stored(map.maps, x, y, 0, {}, function);
            const Channels channels = channels_of(function);
            if (channels.most == 0.0f) continue;
            for (int c = 0; c < 3; ++c) {
                const auto depth = static_cast<float>(passed(map, x, y, channels.depth[static_cast<std::size_t>(c)]));
                pictures[0].at(x, y)[c] = depth;
                pictures[static_cast<std::size_t>(1 + c)].at(x, y) = base::Vec3f(depth);
                deepest = std::max(deepest, depth);
            }
            pictures[4].at(x, y) = base::Vec3f(channels.most);
        }
    for (std::size_t i = 0; i < 4 && deepest > 0.0f; ++i)
        for (base::Vec3f& pixel : pictures[i].pixels) pixel /= deepest;
    return pictures;
}

}  // namespace

Channels channels_of(curves::CurveView function) {
    Channels channels;
    if (function.empty()) return channels;
    channels.most = 1.0f - function.back().value;
    for (std::size_t i = 0; i < levels.size(); ++i) {
        const float lost = std::min(levels[i], channels.most) - rounding;
        const auto vertex = std::find_if(function.begin(), function.end(),
                                         [&](const curves::Vertex& v) { return 1.0f - v.value >= lost; });
        channels.depth[i] = vertex->z;
    }
    return channels;
}

void channel_pictures(const Context& context) {
    std::vector<render::Image> pictures;
    for (const DataSet& set : data_sets)
        with_map(context, set.scenario, context.quick ? 128 : 256, [&](const VolumeMap& map) {
            for (render::Image& picture : pictures_of(map)) pictures.push_back(std::move(picture));
        });
    context.report->sheets.push_back(sheet_of(
        "volume_figure2",
        "Figure 2, each row a data set: box, bucky, rods, clouds. From left to right: the map (red, green and blue are "
        "the next three); the depth inside the box at 10, 50 and 90 % opacity; the maximum opacity. Brighter is deeper "
        "or more opaque. Where a level is never reached, the depth is where the ray leaves the volume",
        pictures, 5));
}

}  // namespace shadowbench::claims::volume
