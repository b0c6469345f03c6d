// Random light rays of small maps: everyday ones and nasty ones, which shrink to few and simple segments.
#pragma once

#include <rapidcheck.h>

#include "techniques/hand_rays.h"

namespace shadowbench::techniques::testing {

// The kinds of segments that rays may have.
struct SegmentKind {
    bool media = true;    // else only surfaces
    bool hostile = true;  // neighbouring floats, denormals, 1e30; transmittances of 0, denormals, nearly 1
    float depth_scale = 1.0f;
};

// A segment is four small numbers: ray, depth, length, transmittance.
using Draw = std::tuple<int, int, int, int>;

inline Segment segment_of(const Draw& draw, const SegmentKind& kind) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    constexpr float denormal = std::numeric_limits<float>::denorm_min();
    const float depths[] = {1.0f,
                            2.0f,
                            1.5f,
                            2.3f,
                            3.7f,
                            4.0f,
                            1.1f,
                            10.0f,
                            2.9f,
                            700.3f,
                            std::nextafter(1.0f, 2.0f),
                            std::nextafter(2.0f, 0.0f),
                            0.0f,
                            denormal,
                            1e-39f,
                            1e-3f,
                            1e6f,
                            1e30f};
    const float throughs[] = {0.5f,
                              0.9f,
                              0.0f,
                              0.99f,
                              0.31f,
                              1.0f,
                              0.07f,
                              0.75f,
                              1e-4f,
                              1e-20f,
                              1e-40f,
                              denormal,
                              std::nextafter(1.0f, 0.0f)};
    const auto& [ray, depth, length, through] = draw;
    Segment s{depths[depth % (kind.hostile ? 18 : 10)] * kind.depth_scale, 0,
              throughs[through % (kind.hostile ? 13 : 8)]};
    const float lengths[] = {0.0f, 0.5f, 1.0f, 0.1f, 30.0f};
    s.back = s.front + lengths[length % 5] * kind.depth_scale;
    if (kind.hostile && length == 5) s.back = std::nextafter(s.front, infinity);
    if (!kind.media) s.back = s.front;
    return s;
}

inline HandRays rays_of(int width, int height, int samples, const std::vector<Draw>& draws, const SegmentKind& kind) {
    HandRays given{width, height, samples, {}};
    given.rays.resize(static_cast<std::size_t>(width) * height * samples);
    for (const Draw& draw : draws)
        given.rays[static_cast<std::size_t>(std::get<0>(draw)) % given.rays.size()].push_back(segment_of(draw, kind));
    return given;
}

// Few at first, up to 40 in the end.
inline rc::Gen<std::vector<Draw>> any_draws() {
    const auto draw = rc::gen::tuple(rc::gen::inRange(0, 64), rc::gen::inRange(0, 18), rc::gen::inRange(0, 6),
                                     rc::gen::inRange(0, 13));
    return rc::gen::scale(0.4, rc::gen::container<std::vector<Draw>>(draw));
}

// Maps of 1 x 1 to 4 x 4 pixels of 1 to 4 rays.
inline rc::Gen<HandRays> any_rays(const SegmentKind& kind = {}) {
    return rc::gen::map(
        rc::gen::tuple(rc::gen::inRange(1, 5), rc::gen::inRange(1, 5), rc::gen::element(1, 2, 4), any_draws()),
        [kind](const std::tuple<int, int, int, std::vector<Draw>>& t) {
            return rays_of(std::get<0>(t), std::get<1>(t), std::get<2>(t), std::get<3>(t), kind);
        });
}

// One ray.
inline rc::Gen<Segments> any_segments(const SegmentKind& kind = {}) {
    return rc::gen::map(any_draws(), [kind](const std::vector<Draw>& draws) {
        Segments segments;
        for (const Draw& draw : draws) segments.push_back(segment_of(draw, kind));
        return segments;
    });
}

// For the reports of failures.
inline std::ostream& operator<<(std::ostream& stream, const Segment& s) {
    return stream << '{' << s.front << ", " << s.back << ", " << s.through << '}';
}
inline std::ostream& operator<<(std::ostream& stream, const HandRays& given) {
    stream << given.width << " x " << given.height << " pixels of " << given.samples << ':';
    for (const Segments& ray : given.rays) {
        stream << " [";
        for (const Segment& s : ray) stream << s;
        stream << ']';
    }
    return stream;
}

// Fronts and backs, each with the next float, sorted; and depths before, between and behind.
inline std::vector<float> telling_depths(const HandRays& given) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    std::vector<float> depths = {-1.0f, 1.75f, 1e31f};
    for (const Segments& ray : given.rays)
        for (const Segment& s : ray)
            for (const float z : {s.front, s.back, 0.5f * s.front + 0.5f * s.back})
                depths.insert(depths.end(), {z, std::nextafter(z, infinity)});
    std::sort(depths.begin(), depths.end());
    depths.erase(std::unique(depths.begin(), depths.end()), depths.end());
    return depths;
}

}  // namespace shadowbench::techniques::testing
