// Light rays whose segments are given by hand, in maps of any size.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <tuple>
#include <vector>

#include "base/random.h"
#include "rays/light_view.h"
#include "techniques/technique.h"

namespace shadowbench::techniques::testing {

struct Segment {
    float front, back, through;
};
using Segments = std::vector<Segment>;

// The segments of every ray, pixel after pixel, in a pixel sample after sample.
struct HandRays {
    int width = 1, height = 1, samples = 1;
    std::vector<Segments> rays;
    bool coloured = false;  // the given values, their squares and 1 are those of the three channels
};

// Sorted, in one tile that is the whole map. The order of submission is the given order.
inline rays::LightRays light_rays(const HandRays& given) {
    rays::LightRays result;
    result.width = given.width;
    result.height = given.height;
    result.samples = given.samples;
    result.channels = given.coloured ? 3 : 1;
    result.begin.push_back(0);
    bool media = false;
    std::vector<std::uint32_t> order;
    for (const Segments& segments : given.rays) {
        const std::uint32_t first = result.begin.back();
        order.resize(segments.size());
        std::iota(order.begin(), order.end(), 0u);
        std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
            return std::tie(segments[a].front, segments[a].back) < std::tie(segments[b].front, segments[b].back);
        });
        result.submission.resize(first + segments.size());
        for (std::uint32_t i = 0; i < order.size(); ++i) {
            const Segment& s = segments[order[i]];
            result.submission[first + order[i]] = first + i;
            result.z_front.push_back(s.front);
            result.z_back.push_back(s.back);
            media = media || s.front < s.back;
            result.transmittance.push_back(s.through);
            if (!given.coloured) continue;
            result.transmittance.push_back(s.through * s.through);
            result.transmittance.push_back(1.0f);
        }
        result.begin.push_back(static_cast<std::uint32_t>(result.z_front.size()));
    }
    if (!media) result.z_back.clear();
    return result;
}

// With the smallest bounds of depth that hold all segments; 0 and 1 if there are none.
inline rays::MapLayout layout_of(const HandRays& given) {
    rays::MapLayout layout;
    layout.width = layout.tile_width = given.width;
    layout.height = layout.tile_height = given.height;
    rays::set_samples(layout, given.samples);
    layout.channels = given.coloured ? 3 : 1;
    float low = std::numeric_limits<float>::infinity(), high = -low;
    for (const Segments& segments : given.rays)
        for (const Segment& s : segments) {
            low = std::min(low, s.front);
            high = std::max(high, s.back);
            layout.media = layout.media || s.front < s.back;
        }
    if (low <= high) {
        layout.z_min = low;
        layout.z_max = high;
    }
    return layout;
}

// One float further out on both sides, as the bounds of captured maps are.
inline rays::MapLayout outward(rays::MapLayout layout) {
    layout.z_min = std::nextafter(layout.z_min, -std::numeric_limits<float>::infinity());
    layout.z_max = std::nextafter(layout.z_max, std::numeric_limits<float>::infinity());
    return layout;
}

struct HandMap {
    rays::MapLayout layout;
    rays::LightView view;
    std::unique_ptr<Map> map;

    // Channel after channel.
    std::vector<float> lookup(std::span<const Query> queries) const {
        std::vector<float> visibility(queries.size() * static_cast<std::size_t>(map->channels()), -1.0f);
        map->lookup(queries, visibility);
        return visibility;
    }
    float operator()(const Query& query) const { return lookup({&query, 1})[0]; }
};

// Rows that are not `coloured` see only the first channel.
inline HandMap make_map(const Technique& row, const ParameterValues& values, const rays::LightRays& given,
                        const rays::MapLayout& layout, const rays::Tracer* tracer = nullptr) {
    HandMap built{layout, {}, row.create(values)};
    built.view.resolution = {layout.width, layout.height};
    built.layout.apron = built.map->needs().apron;  // the tile is the whole map
    if (!row.coloured) built.layout.channels = 1;
    built.map->begin({built.layout, built.view, tracer, 0});
    built.map->add(row.coloured ? given : rays::channel(given, 0));
    built.map->finish();
    return built;
}

inline HandMap make_map(const Technique& row, const ParameterValues& values, const HandRays& given) {
    return make_map(row, values, light_rays(given), layout_of(given));
}

// Overlapping media and surfaces between two depths.
inline Segments random_segments(std::uint64_t seed, int count, double low, double high) {
    base::Random random(seed);
    Segments segments;
    for (int i = 0; i < count; ++i) {
        const auto front = static_cast<float>(random.uniform(low, high));
        const auto back = random.uniform() < 0.4 ? front : static_cast<float>(random.uniform(front, high));
        segments.push_back({front, back, static_cast<float>(random.uniform(0.5, 1.0))});
    }
    return segments;
}

}  // namespace shadowbench::techniques::testing
