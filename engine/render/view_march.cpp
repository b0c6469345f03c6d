#include "render/view_march.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace shadowbench::render {
namespace {

using base::Vec3d;

constexpr double opaque = 1e-4;         // transmittance below which nothing more is looked up
constexpr double least_light = 1e-300;  // of a segment: keeps its extinction finite

// A depth at which extinction changes: a segment starts or ends.
struct Change {
    double t;
    Vec3d extinction;
    int media;  // 1: a segment starts; -1: one ends
};

// Optical depth from the eye up to t; linear in between.
struct Knot {
    double t;
    Vec3d depth;
    bool in_media;  // up to the next knot
};

std::vector<Change> changes(std::span<const rays::TracedSegment> segments) {
    std::vector<Change> result;
    for (const rays::TracedSegment& s : segments) {
        if (!(s.front < s.back)) continue;
        Vec3d extinction;
        for (int c = 0; c < 3; ++c)
            extinction[c] = -std::log(std::max(s.transmittance[c], least_light)) / (s.back - s.front);
        result.push_back({s.front, extinction, 1});
        result.push_back({s.back, -extinction, -1});
    }
    std::stable_sort(result.begin(), result.end(), [](const Change& a, const Change& b) { return a.t < b.t; });
    return result;
}

std::vector<Knot> optical_depth(std::span<const rays::TracedSegment> segments) {
    std::vector<Knot> knots;
    Vec3d extinction(0.0), depth(0.0);
    int media = 0;
    for (const Change& change : changes(segments)) {
        if (!knots.empty()) depth += extinction * (change.t - knots.back().t);
        media += change.media;
        extinction += change.extinction;
        if (media == 0) extinction = Vec3d(0.0);  // removes what rounding left over
        if (!knots.empty() && knots.back().t == change.t)
            knots.back().in_media = media > 0;
        else
            knots.push_back({change.t, depth, media > 0});
    }
    return knots;
}

struct Stretch {
    double front, back;
};

std::vector<Stretch> stretches(const std::vector<Knot>& knots, double longest_gap) {
    std::vector<Stretch> result;
    for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
        if (!knots[k].in_media) continue;
        if (!result.empty() && knots[k].t - result.back().back <= longest_gap)
            result.back().back = knots[k + 1].t;
        else
            result.push_back({knots[k].t, knots[k + 1].t});
    }
    return result;
}

// Transmittance at growing t.
class Walk {
public:
    explicit Walk(const std::vector<Knot>& knots) : knots_(knots) {}
    Vec3d transmittance(double t) {
        if (knots_.size() < 2) return Vec3d(1.0);
        while (at_ + 2 < knots_.size() && knots_[at_ + 1].t <= t) ++at_;
        const Knot &a = knots_[at_], &b = knots_[at_ + 1];
        const double u = std::clamp((t - a.t) / (b.t - a.t), 0.0, 1.0);
        const Vec3d depth = a.depth + (b.depth - a.depth) * u;
        const double red = std::exp(-depth.x);
        if (depth.y == depth.x && depth.z == depth.x) return Vec3d(red);
        return {red, std::exp(-depth.y), std::exp(-depth.z)};
    }

private:
    const std::vector<Knot>& knots_;
    std::size_t at_ = 0;
};

// The light towards the eye, followed from front to back through media and surfaces.
class Compositor {
public:
    Compositor(Walk& media, std::span<const rays::SurfaceHit> surfaces, ViewMarch& out)
        : media_(media), surfaces_(surfaces), out_(out) {}

    // The light that media scatter to the eye from the last t to this one; surfaces in between are added. Stops where
    // no light is left.
    Vec3d on_to(double t) {
        Vec3d share(0.0);
        for (; next_ < surfaces_.size() && surfaces_[next_].t < t && light_is_left(); ++next_) {
            share += through_media(surfaces_[next_].t);
            const Vec3d& opacity = surfaces_[next_].opacity;
            out_.surfaces.push_back(left() * opacity);
            past_surfaces_ *= Vec3d(1.0) - opacity;
        }
        if (light_is_left()) share += through_media(t);
        return share;
    }
    Vec3d left() const { return past_media_ * past_surfaces_; }
    bool light_is_left() const { return std::max({left().x, left().y, left().z}) >= opaque; }

private:
    Vec3d through_media(double t) {
        const Vec3d before = past_media_;
        past_media_ = media_.transmittance(t);
        return past_surfaces_ * (before - past_media_);
    }

    Walk& media_;
    std::span<const rays::SurfaceHit> surfaces_;
    ViewMarch& out_;
    std::size_t next_ = 0;
    Vec3d past_media_{1, 1, 1}, past_surfaces_{1, 1, 1};
};

}  // namespace

void march_view_ray(std::span<const rays::TracedSegment> segments, std::span<const rays::SurfaceHit> surfaces,
                    double step, ViewMarch& out) {
    out.steps.clear();
    out.surfaces.clear();
    const std::vector<Knot> knots = optical_depth(segments);
    Walk walk(knots);
    Compositor light(walk, surfaces, out);
    for (const Stretch& stretch : stretches(knots, step)) {
        const double length = stretch.back - stretch.front;
        const int steps = static_cast<int>(std::max(1.0, std::ceil(length / step)));
        for (int i = 0; i < steps && light.light_is_left(); ++i) {
            const double back = i + 1 == steps ? stretch.back : stretch.front + length * (i + 1) / steps;
            const Vec3d share = light.on_to(back);
            if (share != Vec3d(0.0)) out.steps.push_back({stretch.front + length * (i + 0.5) / steps, share});
        }
    }
    light.on_to(std::numeric_limits<double>::infinity());
    out.transmittance = light.left();
}

}  // namespace shadowbench::render
