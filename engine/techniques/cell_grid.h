// Where the stored functions of a map lie in it.
#pragma once

#include <cstddef>

#include "rays/light_rays.h"
#include "techniques/technique.h"

namespace shadowbench::techniques {

// A map's cells: one for each sample of the layout, or one for each pixel.
struct CellGrid {
    int width = 0, height = 0;
    float per_pixel_x = 1, per_pixel_y = 1;

    std::size_t count() const { return static_cast<std::size_t>(width) * height; }
    std::size_t index(int x, int y) const { return static_cast<std::size_t>(y) * width + x; }
    // Finds the cell of a map position in pixels; returns false outside the map.
    bool find(float px, float py, int& x, int& y) const {
        const float fx = px * per_pixel_x, fy = py * per_pixel_y;
        if (!(fx >= 0.0f && fy >= 0.0f && fx < static_cast<float>(width) && fy < static_cast<float>(height)))
            return false;
        x = static_cast<int>(fx);
        y = static_cast<int>(fy);
        return true;
    }
};

inline CellGrid make_cells(const rays::MapLayout& layout, Cells cells) {
    if (cells == Cells::sample)
        return {layout.width * layout.samples_x, layout.height * layout.samples_y, static_cast<float>(layout.samples_x),
                static_cast<float>(layout.samples_y)};
    return {layout.width, layout.height, 1.0f, 1.0f};
}

}  // namespace shadowbench::techniques
