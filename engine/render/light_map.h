// Shows what a light's map holds: the ends of its visibility functions.
#pragma once

#include <string>

#include "base/vec.h"
#include "render/image.h"

namespace shadowbench::bench {
class RaySource;
}
namespace shadowbench::rays {
struct MapLayout;
}

namespace shadowbench::render {

inline constexpr int longest_light_map = 1024;  // pixels of a picture

struct LightMap {
    std::string light;
    base::Vec2i map{0, 0};  // pixels
    Image through;          // as the light sees it: the map's last row is at the top
};

// The share of the light that passes everything that the rays of a map pixel cross. If the longer side of the map has
// more than longest_light_map pixels, each pixel of the picture is the mean of the map pixels in it.
Image light_map(const bench::RaySource& source, const rays::MapLayout& layout);

}  // namespace shadowbench::render
