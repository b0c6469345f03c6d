// A map of one ray whose segments are given by hand.
#pragma once

#include <nlohmann/json.hpp>

#include "techniques/hand_rays.h"

namespace shadowbench::techniques::testing {

inline rays::LightRays ray_of(const Segments& segments) {
    return light_rays({1, 1, 1, {segments}});
}

struct OneRay {
    rays::LightRays rays;
    HandMap built;
    Map* map;

    OneRay(const char* technique, const char* parameters, const Segments& segments, float z_min, float z_max)
        : rays(ray_of(segments)) {
        const Technique& row = find(technique, "");
        rays::MapLayout layout;
        layout.z_min = z_min;
        layout.z_max = z_max;
        layout.media = true;
        built = make_map(row, read_parameters(row.parameters, nlohmann::json::parse(parameters), ""), rays, layout);
        map = built.map.get();
    }

    float operator()(float z) const { return built({0.5f, 0.5f, z, 1.0f}); }
    double exact(double z) const { return rays::transmittance(rays, 0, 0, z); }
};

}  // namespace shadowbench::techniques::testing
