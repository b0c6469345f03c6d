#include "rays/march.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "rays/medium_floats.h"
#include "scene/scene.h"

namespace shadowbench::rays {
namespace {

using base::Vec3d;
using base::Vec3i;

// Clips [t_min, t_max] to the box; returns false if nothing is left.
bool clip(const Vec3d& origin, const Vec3d& direction, const Vec3d& lower, const Vec3d& upper, double& t_min,
          double& t_max) {
    for (int a = 0; a < 3; ++a) {
        if (direction[a] == 0.0) {
            if (origin[a] < lower[a] || origin[a] > upper[a]) return false;
            continue;
        }
        const double t0 = (lower[a] - origin[a]) / direction[a], t1 = (upper[a] - origin[a]) / direction[a];
        t_min = std::max(t_min, std::min(t0, t1));
        t_max = std::min(t_max, std::max(t0, t1));
    }
    return t_min < t_max;
}

// Joins segments until their ends are different floats: a segment whose ends are one float joins the next longer one;
// before a gap, the last ones are extended to one float of length.
class Joiner {
public:
    Joiner(double t_min, std::vector<MediumSegment>& out) : t_min_(t_min), out_(out) {}

    void add(double from, double to, double depth) {
        add(static_cast<float>(t_min_ + from), static_cast<float>(t_min_ + to), depth);
    }
    void gap(double from) {
        const float front = static_cast<float>(t_min_ + from);
        if (joined_ > 0.0) add(front, next_depth(front), 0.0);
    }

private:
    void add(float front, float back, double depth) {
        joined_ += depth;
        if (joined_ <= 0.0 || front == back) return;
        out_.push_back({front, back, joined_});
        joined_ = 0.0;
    }

    const double t_min_;
    std::vector<MediumSegment>& out_;
    double joined_ = 0.0;
};

}  // namespace

VolumeMarcher::VolumeMarcher(const scene::GridVolume& volume)
    : volume_(volume), voxels_{volume.density.data(), volume.size.x, volume.size.y, volume.size.z}, blocks_(volume) {}

double VolumeMarcher::density(const Vec3d& index) const {
    return density_at(voxels_, index.x, index.y, index.z);
}

bool VolumeMarcher::enter(const Vec3d& world_origin, const Vec3d& world_direction, double t_min, double t_max,
                          Way& way) const {
    Vec3d origin = world_origin, direction = world_direction;
    if (volume_.frame) {
        origin = base::map_point(volume_.frame->to_grid, origin);
        direction = base::map_direction(volume_.frame->to_grid, direction);
    }
    if (!clip(origin, direction, volume_.lower, volume_.upper, t_min, t_max)) return false;
    const Vec3d extent = volume_.upper - volume_.lower;
    way.t_min = t_min;
    way.length = t_max - t_min;
    for (int a = 0; a < 3; ++a) {
        const double per_length = volume_.size[a] / extent[a];
        way.slope[a] = direction[a] * per_length;
        way.start[a] = (origin[a] - volume_.lower[a]) * per_length - 0.5 + way.slope[a] * t_min;
    }
    // Seen from so far away that positions along the ray cannot resolve voxels, the volume is not seen.
    constexpr double slack = 0.25;
    for (int a = 0; a < 3; ++a) {
        const double end = way.start[a] + way.slope[a] * way.length;
        if (!(std::min(way.start[a], end) >= -0.5 - slack &&
              std::max(way.start[a], end) <= volume_.size[a] - 0.5 + slack))
            return false;
    }
    return true;
}

void VolumeMarcher::march(const Vec3d& origin, const Vec3d& direction, double scale, double t_min, double t_max,
                          std::vector<MediumSegment>& out) const {
    Way way;
    if (!enter(origin, direction, t_min, t_max, way)) return;
    const double step = volume_.step / scale;
    const auto steps = static_cast<std::int64_t>(std::max(1.0, std::ceil(way.length / step)));
    const auto place = [&](std::int64_t i) { return std::min(static_cast<double>(i) * step, way.length); };

    Joiner joiner(way.t_min, out);
    double before = -1.0;  // density at the step's start; below 0: not known
    for (std::int64_t i = 0; i < steps; ++i) {
        double s = place(i);
        if (before <= 0.0) {
            const Vec3d index = way.start + way.slope * s;
            if (const double ahead = blocks_.empty_ahead(index, way.slope); ahead > 0.0) {
                joiner.gap(s);
                const double last = std::floor((s + ahead) / step);  // of the steps that start in empty blocks
                if (last >= static_cast<double>(steps)) break;
                i = std::max(i, static_cast<std::int64_t>(last));
                s = place(i);
                before = -1.0;
            }
            if (before < 0.0) before = density(way.start + way.slope * s);
        }
        const double next = place(i + 1);
        const double behind = density(way.start + way.slope * next);
        joiner.add(s, next, 0.5 * (before + behind) * (next - s) * scale);
        before = behind;
    }
    joiner.gap(way.length);
}

// Exact inside one cell.
double VolumeMarcher::integral(const Way& way, double from, double to) const {
    constexpr double node = 0.57735026918962576451;  // 1 / sqrt(3)
    const double half = 0.5 * (to - from);
    const Vec3d middle = way.start + way.slope * (from + half), off = way.slope * (half * node);
    return half * (density(middle - off) + density(middle + off));
}

// Calls visit(from, to) for the cells that the ray crosses, in order, except those of empty blocks.
template <class Visit>
void VolumeMarcher::for_each_cell(const Way& way, const Visit& visit) const {
    constexpr double never = std::numeric_limits<double>::infinity();
    double wall[3], reach[3];  // the next wall between cells along each axis, and where the ray meets it
    double inverse[3], sign[3];
    for (int a = 0; a < 3; ++a) {
        inverse[a] = way.slope[a] != 0.0 ? 1.0 / way.slope[a] : never;
        sign[a] = way.slope[a] > 0.0 ? 1.0 : -1.0;
    }
    const auto meet = [&](int a) { reach[a] = inverse[a] == never ? never : (wall[a] - way.start[a]) * inverse[a]; };
    const auto pass = [&](int a, double s) {  // passes the walls up to s
        while (reach[a] <= s) {
            wall[a] += sign[a];
            meet(a);
        }
    };
    const auto stand = [&](double s) {
        for (int a = 0; a < 3; ++a) {
            const double place = way.start[a] + way.slope[a] * s;
            wall[a] = sign[a] > 0.0 ? std::floor(place) + 1.0 : std::ceil(place) - 1.0;
            meet(a);
            pass(a, s);
        }
    };
    stand(0.0);
    bool empty = true;
    for (double s = 0.0; s < way.length;) {
        const double next = std::min({way.length, reach[0], reach[1], reach[2]});
        if (empty) {
            const double middle = 0.5 * (s + next);
            const double end = middle + blocks_.empty_ahead(way.start + way.slope * middle, way.slope);
            if (end > next) {
                s = end;
                stand(s);
                continue;
            }
        }
        empty = !visit(s, next);
        for (int a = 0; a < 3; ++a) pass(a, next);
        s = next;
    }
}

void VolumeMarcher::march_cells(const Vec3d& origin, const Vec3d& direction, double scale, double t_min, double t_max,
                                std::vector<MediumSegment>& out) const {
    Way way;
    if (!enter(origin, direction, t_min, t_max, way)) return;
    Joiner joiner(way.t_min, out);
    double end = 0.0;
    for_each_cell(way, [&](double from, double to) {
        if (from > end) joiner.gap(end);
        end = to;
        const double depth = integral(way, from, to);
        joiner.add(from, to, depth * scale);
        return depth > 0.0;
    });
    joiner.gap(end);
}

void VolumeMarcher::optical_depths(const Vec3d& origin, const Vec3d& direction, double scale, double t_min,
                                   std::span<const double> t, std::span<double> depth) const {
    std::fill(depth.begin(), depth.end(), 0.0);
    Way way;
    if (t.empty() || !enter(origin, direction, t_min, t.back(), way)) return;
    double sum = 0.0;
    std::size_t i = 0;
    for_each_cell(way, [&](double from, double to) {
        for (; i < t.size() && t[i] - way.t_min < to; ++i)
            depth[i] = (sum + (t[i] - way.t_min > from ? integral(way, from, t[i] - way.t_min) : 0.0)) * scale;
        const double cell = integral(way, from, to);
        sum += cell;
        return cell > 0.0;
    });
    for (; i < t.size(); ++i) depth[i] = sum * scale;
}

bool sphere_stretch(const Vec3d& origin, const Vec3d& direction, const Vec3d& centre, double radius, double& front,
                    double& back) {
    // Moves to the closest approach first: the distance then comes from a small difference, which keeps its digits far
    // from the origin.
    const double length2 = direction.dot(direction);
    const Vec3d to_centre = centre - origin;
    const double middle = to_centre.dot(direction) / length2;
    const Vec3d miss = to_centre - direction * middle;
    const double inside = radius * radius - miss.dot(miss);
    if (!(inside > 0.0)) return false;
    const double half = std::sqrt(inside / length2);
    front = middle - half;
    back = middle + half;
    return true;
}

}  // namespace shadowbench::rays
