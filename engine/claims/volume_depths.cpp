#include "claims/volume_depths.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "base/parallel.h"
#include "bench/queries.h"
#include "rays/grid_media.h"

namespace shadowbench::claims::volume {
namespace {

constexpr std::size_t most_texels = 2048;
constexpr std::size_t parts = 32;  // of each pass of a search
constexpr int passes = 4;          // to a millionth of the map's depth range

// The depth at which a light ray has gathered this optical depth, which it reaches.
double depth_of(double optical_depth, const rays::GridMedia& media, const rays::LightView& view,
                const rays::SamplePosition& place) {
    std::array<double, parts + 1> z{};
    std::array<base::Vec3d, parts + 1> gathered;
    double low = view.z_min, high = view.z_max;
    for (int pass = 0; pass < passes; ++pass) {
        const double part = (high - low) / static_cast<double>(parts);
        for (std::size_t k = 0; k < z.size(); ++k) z[k] = low + static_cast<double>(k) * part;
        media.optical_depths(view, place.x, place.y, scene::mid_shutter, z, gathered);
        std::size_t k = 1;
        while (k < parts && gathered[k].x < optical_depth) ++k;
        low = z[k - 1];
        high = z[k];
    }
    return 0.5 * (low + high);
}

Channels exact_channels(const rays::GridMedia& media, const rays::LightView& view, const rays::SamplePosition& place) {
    base::Vec3d all;
    media.optical_depths(view, place.x, place.y, scene::mid_shutter, std::span(&view.z_max, 1), std::span(&all, 1));
    Channels exact;
    exact.most = static_cast<float>(-std::expm1(-all.x));
    for (std::size_t i = 0; i < levels.size(); ++i)
        if (exact.most >= levels[i])
            exact.depth[i] =
                static_cast<float>(depth_of(-std::log1p(-static_cast<double>(levels[i])), media, view, place));
    return exact;
}

}  // namespace

std::vector<TexelRay> texel_rays(const scene::Scene& scene, const rays::LightView& view,
                                 const rays::MapLayout& layout) {
    const rays::GridMedia media(scene, true);
    const auto width = static_cast<std::size_t>(layout.width), height = static_cast<std::size_t>(layout.height);
    const std::vector<std::size_t> chosen = bench::choose_judged(width * height, most_texels, layout.seed);
    std::vector<TexelRay> texels(chosen.size());
    base::parallel_for(texels.size(), [&](std::size_t i) {
        TexelRay& texel = texels[i];
        texel.x = static_cast<int>(chosen[i] % width);
        texel.y = static_cast<int>(chosen[i] / width);
        texel.exact = exact_channels(media, view, rays::sample_position(layout, texel.x, texel.y));
    });
    return texels;
}

double depth_error(const bench::Maps& maps, std::span<const TexelRay> texels, int steps) {
    const double step = (static_cast<double>(maps.layout->z_max) - maps.layout->z_min) / steps;
    curves::Curve function;
    double distances = 0.0, count = 0.0;
    for (const TexelRay& texel : texels) {
        bench::stored(maps, texel.x, texel.y, 0, {}, function);
        const Channels channels = channels_of(function);
        for (std::size_t i = 0; i < levels.size(); ++i) {
            if (std::min(channels.most, texel.exact.most) < levels[i]) continue;
            distances += std::abs(static_cast<double>(channels.depth[i]) - texel.exact.depth[i]) / step;
            count += 1.0;
        }
    }
    return distances / count;
}

}  // namespace shadowbench::claims::volume
