#include "rays/march.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "rays/medium_floats.h"
#include "scene/scene.h"

namespace shadowbench::rays {
namespace {

constexpr int block_size = 8;

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

VolumeMarcher::VolumeMarcher(const scene::GridVolume& volume) : volume_(volume) {
    // Block b holds the interpolation cells whose lower corner index + 1 lies in [8 b, 8 b + 8); indices run from -1 to
    // size - 1.
    blocks_ = {volume.size.x / block_size + 1, volume.size.y / block_size + 1, volume.size.z / block_size + 1};
    occupied_.assign(static_cast<std::size_t>(blocks_.x) * blocks_.y * blocks_.z, 0);
    std::size_t v = 0;
    for (int z = 0; z < volume.size.z; ++z)
        for (int y = 0; y < volume.size.y; ++y)
            for (int x = 0; x < volume.size.x; ++x, ++v) {
                if (volume.density[v] <= 0.0f) continue;
                // A voxel is a corner of the cells at its own index and at the index below, in each axis.
                for (int bz = z / block_size; bz <= (z + 1) / block_size; ++bz)
                    for (int by = y / block_size; by <= (y + 1) / block_size; ++by)
                        for (int bx = x / block_size; bx <= (x + 1) / block_size; ++bx)
                            occupied_[(static_cast<std::size_t>(bz) * blocks_.y + by) * blocks_.x + bx] = 1;
            }
}

// Trilinear at `index` = voxel coordinates (voxel centres at whole numbers) inside the box. The box ends half a voxel
// outside the outermost centres, where the outermost value holds.
double VolumeMarcher::density(const Vec3d& index) const {
    const Vec3i size = volume_.size;
    const auto cell = [](double place, int count) {  // floor, for positions >= -1
        return std::min(static_cast<int>(place + 1.0), count) - 1;
    };
    const int x = cell(index.x, size.x), y = cell(index.y, size.y), z = cell(index.z, size.z);
    const int x0 = std::max(x, 0), x1 = std::min(x + 1, size.x - 1);
    const int y0 = std::max(y, 0), y1 = std::min(y + 1, size.y - 1);
    const int z0 = std::max(z, 0), z1 = std::min(z + 1, size.z - 1);
    const double fx = index.x - x, fy = index.y - y, fz = index.z - z;
    const float* d = volume_.density.data();
    const auto row = [&](int yy, int zz) {
        const float* r = d + (static_cast<std::size_t>(zz) * size.y + yy) * size.x;
        return r[x0] + fx * (static_cast<double>(r[x1]) - r[x0]);
    };
    const double r00 = row(y0, z0), r01 = row(y0, z1);
    const double a = r00 + fy * (row(y1, z0) - r00), b = r01 + fy * (row(y1, z1) - r01);
    return std::max(a + fz * (b - a), 0.0);
}

// If the block around `index` is empty, the step of t to where the ray leaves it; otherwise 0.
double VolumeMarcher::empty_ahead(const Vec3d& index, const Vec3d& slope) const {
    std::size_t block = 0;
    double ahead = std::numeric_limits<double>::infinity();
    for (int a = 2; a >= 0; --a) {
        const int b = std::clamp(static_cast<int>(index[a] + 1.0) / block_size, 0, blocks_[a] - 1);
        block = block * blocks_[a] + b;
        if (slope[a] != 0.0) {
            const double wall = (slope[a] > 0.0 ? b + 1 : b) * block_size - 1;
            ahead = std::min(ahead, (wall - index[a]) / slope[a]);
        }
    }
    return occupied_[block] ? 0.0 : ahead;
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
    const auto place = [&](std::int64_t i) { return i >= steps ? way.length : static_cast<double>(i) * step; };

    Joiner joiner(way.t_min, out);
    double before = -1.0;  // density at the step's start; below 0: not known
    for (std::int64_t i = 0; i < steps; ++i) {
        const double s = place(i);
        if (before <= 0.0) {
            const Vec3d index = way.start + way.slope * s;
            if (const double ahead = empty_ahead(index, way.slope); ahead > 0.0) {  // skip whole steps in the block
                joiner.gap(s);
                i = std::max(i, static_cast<std::int64_t>((s + ahead) / step) - 1);
                before = -1.0;
                continue;
            }
            if (before < 0.0) before = density(index);
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
            const double end = middle + empty_ahead(way.start + way.slope * middle, way.slope);
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
