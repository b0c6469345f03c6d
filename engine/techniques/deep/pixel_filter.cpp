#include "techniques/deep/pixel_filter.h"

namespace shadowbench::techniques {

int PixelFilter::apron() const {
    return std::max(static_cast<int>(std::ceil(radius - 0.5)), 0);
}

RayOffset ray_offset(const rays::MapLayout& layout, const rays::LightRays& tile, std::size_t ray) {
    const int pixel = static_cast<int>(ray) / tile.samples, sample = static_cast<int>(ray) % tile.samples;
    const int x = tile.x0 + pixel % tile.width, y = tile.y0 + pixel / tile.width;
    const rays::SamplePosition p = rays::sample_position(layout, x * layout.samples_x + sample % layout.samples_x,
                                                         y * layout.samples_y + sample / layout.samples_x);
    return {static_cast<float>(p.x - x), static_cast<float>(p.y - y)};
}

FilterWindow filter_window(const PixelFilter& filter, const rays::LightRays& tile, int x, int y) {
    const int apron = filter.apron();
    return {std::max(x - apron, tile.x0), std::min(x + apron + 1, tile.x0 + tile.width), std::max(y - apron, tile.y0),
            std::min(y + apron + 1, tile.y0 + tile.height)};
}

bool any_segment(const PixelFilter& filter, const rays::LightRays& tile, int x, int y) {
    const FilterWindow window = filter_window(filter, tile, x, y);
    for (int py = window.y0; py < window.y1; ++py)  // the rays of a row's pixels lie side by side
        if (tile.begin[first_ray(tile, window.x0, py)] !=
            tile.begin[first_ray(tile, window.x1 - 1, py) + static_cast<std::size_t>(tile.samples)])
            return true;
    return false;
}

}  // namespace shadowbench::techniques
