// Maps of given depths instead of a scene's.
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/random.h"
#include "rays/light_view.h"
#include "techniques/store/depth_store.h"

namespace shadowbench::techniques::testing {

// A map of one ray per pixel that meets one opaque surface at this depth, or nothing (no_depth).
struct DepthsMap {
    rays::MapLayout layout;
    rays::LightView view;
    std::unique_ptr<Map> map;

    float lookup(float x, float y, float z, float width = 1.0f) const {
        const Query q{x, y, z, width};
        float v = -1.0f;
        map->lookup({&q, 1}, {&v, 1});
        return v;
    }
};

inline DepthsMap map_of(const char* technique, const nlohmann::json& parameters, int width, int height,
                        const std::vector<float>& depths) {
    DepthsMap result;
    result.layout.width = result.layout.tile_width = width;
    result.layout.height = result.layout.tile_height = height;
    rays::LightRays tile;
    tile.width = width;
    tile.height = height;
    tile.begin.push_back(0);
    for (const float z : depths) {
        if (z != no_depth) {
            tile.z_front.push_back(z);
            tile.transmittance.push_back(0.0f);
        }
        tile.begin.push_back(static_cast<std::uint32_t>(tile.z_front.size()));
    }
    const Technique& row = find(technique, "");
    result.map = row.create(read_parameters(row.parameters, parameters, ""));
    result.map->begin({result.layout, result.view, nullptr});
    result.map->add(tile);
    result.map->finish();
    return result;
}

// Depths in [1, 2) of a few discs over nothing, and a band of noise: cells of every kind beside each other.
inline std::vector<float> patchy_depths(int width, int height, std::uint64_t seed) {
    base::Random random(seed);
    std::vector<float> depths(static_cast<std::size_t>(width) * height, no_depth);
    for (int disc = 0; disc < 5; ++disc) {
        const double cx = random.uniform(0, width), cy = random.uniform(0, height), r = random.uniform(3, 0.2 * width);
        const float z = static_cast<float>(random.uniform(1, 2));
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                if ((x - cx) * (x - cx) + (y - cy) * (y - cy) < r * r) {
                    float& depth = depths[static_cast<std::size_t>(y) * width + x];
                    depth = std::min(depth, z);
                }
    }
    for (int y = height / 2; y < height / 2 + 3; ++y)
        for (int x = 0; x < width; ++x)
            depths[static_cast<std::size_t>(y) * width + x] = static_cast<float>(random.uniform(1, 2));
    return depths;
}

}  // namespace shadowbench::techniques::testing
