// A map of one ray whose segments are given by hand.
#pragma once

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <tuple>
#include <vector>

#include "base/random.h"
#include "rays/light_view.h"
#include "techniques/technique.h"

namespace shadowbench::techniques::testing {

struct Segment {
    float front, back, through;
};

inline rays::LightRays ray_of(std::vector<Segment> segments) {
    std::sort(segments.begin(), segments.end(),
              [](const Segment& a, const Segment& b) { return std::tie(a.front, a.back) < std::tie(b.front, b.back); });
    rays::LightRays rays;
    rays.width = rays.height = 1;
    rays.begin = {0, static_cast<std::uint32_t>(segments.size())};
    for (const Segment& s : segments) {
        rays.z_front.push_back(s.front);
        rays.z_back.push_back(s.back);
        rays.transmittance.push_back(s.through);
    }
    return rays;
}

struct OneRay {
    rays::MapLayout layout;
    rays::LightView view;
    rays::LightRays rays;
    std::unique_ptr<Map> map;

    OneRay(const char* technique, const char* parameters, std::vector<Segment> segments, float z_min, float z_max)
        : rays(ray_of(std::move(segments))) {
        const Technique& row = find(technique, "");
        layout.z_min = z_min;
        layout.z_max = z_max;
        layout.media = true;
        map = row.create(read_parameters(row.parameters, nlohmann::json::parse(parameters), ""));
        map->begin({layout, view, nullptr, 0});
        map->add(rays);
        map->finish();
    }

    float operator()(float z) const {
        const Query q{0.5f, 0.5f, z, 1.0f};
        float v = -1.0f;
        map->lookup({&q, 1}, {&v, 1});
        return v;
    }
    double exact(double z) const { return rays::transmittance(rays, 0, 0, z); }
};

// Overlapping media and surfaces between two depths.
inline std::vector<Segment> random_segments(std::uint64_t seed, int count, double low, double high) {
    base::Random random(seed);
    std::vector<Segment> segments;
    for (int i = 0; i < count; ++i) {
        const auto front = static_cast<float>(random.uniform(low, high));
        const auto back = random.uniform() < 0.4 ? front : static_cast<float>(random.uniform(front, high));
        segments.push_back({front, back, static_cast<float>(random.uniform(0.5, 1.0))});
    }
    return segments;
}

}  // namespace shadowbench::techniques::testing
