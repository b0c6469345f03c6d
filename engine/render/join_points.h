// Joins the points that the view rays of a pixel see, so that an antialiased picture costs about one lookup a pixel.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/vec.h"

namespace shadowbench::render {

// What one view ray adds to its pixel at one place: see ShadingPoints.
struct SeenPoint {
    enum class Kind : std::uint8_t { medium, surface, hair };
    Kind kind = Kind::surface;
    double t = 0.0;  // distance from the eye
    base::Vec3d place{0, 0, 0};
    base::Vec3f across{0.0f}, down{0.0f}, normal{0.0f}, coverage{0.0f};
};

// The points of a pixel. radiance: one value for each light, point after point.
struct PixelPoints {
    std::vector<SeenPoint> points;
    std::vector<base::Vec3f> radiance;

    void clear() {
        points.clear();
        radiance.clear();
    }
};

struct JoinSettings {
    std::size_t lights = 0;
    int rays_per_side = 1;
    double pixel = 0.0;  // width of the pixel at distance 1
    double step = 0.0;   // of media
};

// Replaces points that are one place to the pixel by one point: on the same plane, at most a pixel apart; of hair, at
// depths at most a pixel apart; in media, at depths at most half a step apart. The joined point has the sums of
// coverage and radiance, the mean of the places by coverage, and the edges of the whole pixel. Points that different
// lights reach are not joined. The result does not depend on the order of the view rays beyond rounding.
void join_points(const JoinSettings& settings, PixelPoints& pixel);

}  // namespace shadowbench::render
