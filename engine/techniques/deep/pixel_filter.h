// The filter that makes a pixel's function from the light rays around its centre: Lokovic and Veach 2000, equation (1).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "curves/weighted_ray.h"
#include "rays/light_rays.h"

namespace shadowbench::techniques {

enum class FilterShape { box, tent, gaussian };

// The weight of a ray at (dx, dy) pixels from a pixel's centre is f(dx) f(dy), where f is 0 outside [-radius, radius).
//   box: 1;  tent: 1 - |d| / radius;  gaussian: exp(-2 (d / radius)^2), as RenderMan's filter of that name.
struct PixelFilter {
    FilterShape shape = FilterShape::box;
    double radius = 0.5;  // pixels, at least 0.5: a pixel always includes its own rays

    // Whether the filter covers exactly the pixel.
    bool is_pixel() const { return shape == FilterShape::box && radius == 0.5; }
    // The number of pixels around a pixel that it reaches into.
    int apron() const;
};

// The position of a ray in its pixel, [0, 1) each way.
struct RayOffset {
    float x, y;
};

RayOffset ray_offset(const rays::MapLayout& layout, const rays::LightRays& tile, std::size_t ray);

// The rays that pixel (x, y) represents, with weights above 0 that sum to 1; `out` is replaced. At the map's edges only
// the rays that exist count. The tile must cover all of the map that the filter reaches. `offset(ray)` is
// ray_offset(ray), or a stored result of it.
template <class Offset>
void filter_rays(const PixelFilter& filter, const rays::LightRays& tile, const Offset& offset, int x, int y,
                 std::vector<curves::WeightedRay>& out);

// Whether any ray within the filter's reach of pixel (x, y) crosses anything.
bool any_segment(const PixelFilter& filter, const rays::LightRays& tile, int x, int y);

// The pixels of the tile that the filter of pixel (x, y) reaches.
struct FilterWindow {
    int x0, x1, y0, y1;
};
FilterWindow filter_window(const PixelFilter& filter, const rays::LightRays& tile, int x, int y);

inline std::size_t first_ray(const rays::LightRays& tile, int x, int y) {
    return (static_cast<std::size_t>(y - tile.y0) * tile.width + (x - tile.x0)) * tile.samples;
}

template <class Offset>
void filter_rays(const PixelFilter& filter, const rays::LightRays& tile, const Offset& offset, int x, int y,
                 std::vector<curves::WeightedRay>& out) {
    out.clear();
    double total = 0.0;
    const double r = filter.radius;
    const auto gather = [&](const auto& shape) {
        const auto f = [&](double d) { return d >= -r && d < r ? shape(d / r) : 0.0; };
        const FilterWindow window = filter_window(filter, tile, x, y);
        for (int py = window.y0; py < window.y1; ++py)
            for (int px = window.x0; px < window.x1; ++px) {
                const std::size_t first = first_ray(tile, px, py);
                for (std::size_t ray = first; ray < first + static_cast<std::size_t>(tile.samples); ++ray) {
                    const RayOffset at = offset(ray);
                    const double weight = f(px - x + (at.x - 0.5)) * f(py - y + (at.y - 0.5));
                    if (!(weight > 0.0)) continue;
                    out.push_back({ray, weight});
                    total += weight;
                }
            }
    };
    switch (filter.shape) {
        case FilterShape::box:
            gather([](double) { return 1.0; });
            break;
        case FilterShape::tent:
            gather([](double u) { return 1.0 - std::abs(u); });
            break;
        case FilterShape::gaussian:
            gather([](double u) { return std::exp(-2.0 * u * u); });
            break;
    }
    if (out.empty()) {  // all rays are where a tent is 0
        const std::size_t first = first_ray(tile, x, y);
        for (std::size_t s = 0; s < static_cast<std::size_t>(tile.samples); ++s) out.push_back({first + s, 1.0});
        total = tile.samples;
    }
    for (curves::WeightedRay& ray : out) ray.weight /= total;
}

}  // namespace shadowbench::techniques
