// What a light's map holds, to look at: where its visibility functions end.
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
    Image through;          // the map's last row is at the top: as the light sees it
};

// The share of the light that gets through all that the rays of a map pixel cross. Of a map whose longer side has more
// pixels than longest_light_map, each pixel of the picture is the mean of the map pixels that lie in it.
Image light_map(const bench::RaySource& source, const rays::MapLayout& layout);

}  // namespace shadowbench::render
